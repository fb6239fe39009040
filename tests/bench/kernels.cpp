// What the parts of a step cost, on a settling pyramid of unit squares, one rank. Counters: seconds a
// candidate pair or a block.

#include "support/scenes.hpp"

#include "contact/block_view.hpp"
#include "contact/find_pairs.hpp"
#include "contact/geometry/overlap.hpp"
#include "contact/geometry/overlap_energy.hpp"
#include "dynamics/integrate.hpp"
#include "simulation/simulation.hpp"

#include <benchmark/benchmark.h>

namespace gcpdda::testing {
namespace {

/// A pyramid whose joints have closed.
class Pile {
public:
  explicit Pile(std::int64_t rows, const std::string &fidelity = "rigid")
      : simulation(Communicator::self(), scene_of(settling_pyramid_toml(rows, 1.0, fidelity))),
        blocks(simulation.blocks()), history(simulation.history()) {
    for (int k = 0; k < 200; ++k) {
      simulation.step();
    }
    blocks = simulation.blocks();
    history = simulation.history();
    candidates = simulation.candidates();
  }

  Simulation simulation;
  BlockSystem blocks; // a copy that benchmarks may change
  ContactHistory history;
  Candidates candidates;
};

void per(benchmark::State &state, std::size_t items) {
  using benchmark::Counter;
  state.counters["s_each"] =
      Counter(static_cast<double>(items), Counter::kIsIterationInvariantRate | Counter::kInvert);
}

void forces(benchmark::State &state, Instructions instructions, const std::string &fidelity) {
  Pile pile(state.range(0), fidelity);
  ContactForces contacts(pile.simulation.contacts().parameters(), instructions);
  for ([[maybe_unused]] const auto _ : state) {
    benchmark::DoNotOptimize(contacts.evaluate(pile.blocks, pile.candidates, pile.history));
  }
  per(state, pile.candidates.pairs.size());
}

void general_pairs(benchmark::State &state) {
  Pile pile(state.range(0));
  pile.candidates.plain.clear();
  pile.candidates.groups = {PairGroup{.is_last = true}};
  pile.candidates.num_interior_plain = 0;
  pile.candidates.general.resize(pile.candidates.pairs.size());
  for (std::uint32_t k = 0; k < pile.candidates.general.size(); ++k) {
    pile.candidates.general[k] = k;
  }
  pile.candidates.num_interior_general = pile.candidates.general.size();
  ContactForces contacts(pile.simulation.contacts().parameters());
  for ([[maybe_unused]] const auto _ : state) {
    benchmark::DoNotOptimize(contacts.evaluate(pile.blocks, pile.candidates, pile.history));
  }
  per(state, pile.candidates.pairs.size());
}

void sums(benchmark::State &state) {
  Pile pile(state.range(0));
  ContactForces contacts(pile.simulation.contacts().parameters());
  contacts.evaluate(pile.blocks, pile.candidates, pile.history);
  for ([[maybe_unused]] const auto _ : state) {
    benchmark::DoNotOptimize(contacts.finish_sums(pile.blocks, pile.candidates));
  }
  per(state, pile.candidates.pairs.size());
}

void energies(benchmark::State &state) {
  Pile pile(state.range(0));
  std::array<TrialOutline, 2> outlines;
  double sum = 0.0;
  for ([[maybe_unused]] const auto _ : state) {
    for (const CandidatePair &pair : pile.candidates.pairs) {
      sum += overlap_energy(view_of(pile.blocks, pair.lower.value, outlines[0]),
                            view_of(pile.blocks, pair.higher.value, outlines[1]));
    }
  }
  benchmark::DoNotOptimize(sum);
  per(state, pile.candidates.pairs.size());
}

void neighbourhood(benchmark::State &state) {
  Pile pile(state.range(0));
  const double skin = 0.05;
  for ([[maybe_unused]] const auto _ : state) {
    ContactHistory history;
    benchmark::DoNotOptimize(make_candidates(pile.blocks,
                                             find_pairs(pile.blocks, reach_boxes(pile.blocks, skin)),
                                             pile.simulation.contacts().parameters(), {}, history, skin));
  }
  per(state, pile.blocks.num_owned);
}

void prediction(benchmark::State &state) {
  Pile pile(state.range(0));
  for ([[maybe_unused]] const auto _ : state) {
    predict(pile.blocks, pile.simulation.scheme(), 0.0);
  }
  per(state, pile.blocks.num_owned);
}

void steps(benchmark::State &state) {
  Pile pile(state.range(0));
  for ([[maybe_unused]] const auto _ : state) {
    pile.simulation.step();
  }
  per(state, pile.blocks.num_owned);
}

BENCHMARK_CAPTURE(forces, widest, Instructions::widest, "rigid")->Arg(20)->Arg(100);
BENCHMARK_CAPTURE(forces, avx2, Instructions::avx2, "rigid")->Arg(20)->Arg(100);
BENCHMARK_CAPTURE(forces, portable, Instructions::portable, "rigid")->Arg(20)->Arg(100);
BENCHMARK_CAPTURE(forces, deformable, Instructions::widest, "deformable")->Arg(20)->Arg(100);
BENCHMARK(general_pairs)->Arg(20)->Arg(100);
BENCHMARK(sums)->Arg(20)->Arg(100);
BENCHMARK(energies)->Arg(20)->Arg(100);
BENCHMARK(neighbourhood)->Arg(20)->Arg(100);
BENCHMARK(prediction)->Arg(20)->Arg(100);
BENCHMARK(steps)->Arg(20)->Arg(100);

} // namespace
} // namespace gcpdda::testing

// MPI lives as long as the main function, as in every program of this project.
int main(int argc, char **argv) {
  const gcpdda::MpiScope mpi(argc, argv);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
