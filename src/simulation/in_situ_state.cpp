#include "simulation/in_situ_state.hpp"

#include "contact/in_situ.hpp"
#include "dynamics/deformable.hpp"
#include "io/results/id_slabs.hpp"
#include "model/find_row.hpp"

#include <fmt/format.h>
#include <limits>

namespace gcpdda {

namespace {

/// The vertices of a block that follow move.
struct Swollen {
  std::int64_t block = 0;
  std::int64_t num_vertices = 0;
};

// Strains of deformable blocks; all blocks lie where the stress is compression.
void stress_rows(RunState &run) {
  const InSituStress &stress = run.scene.in_situ;
  double least = std::numeric_limits<double>::infinity();
  std::int64_t at = -1;
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    const BlockProperties &block = run.blocks.properties[row];
    for (const Vec2 x : run.blocks.of_row(run.blocks.reference_vertex, row)) {
      const PrincipalValues values = principal_values(stress.compression_at(block.centroid + x));
      constexpr double rounding = 1e-9;
      const double lowest = values.least < -rounding * values.largest ? values.least : 0.0;
      if (lowest < least) {
        least = lowest;
        at = block.id.value;
      }
    }
    if (run.blocks.is_deformable(row)) {
      Deformation &d = run.blocks.deformation_of(row);
      d.initial_strain = strain_under(d, -block.area * stress.compression_at(block.centroid));
    }
  }
  struct Lowest {
    double value;
    std::int64_t block;
  };
  Lowest lowest{0.0, -1};
  for (const auto &theirs : run.communicator.all_gather(std::vector<Lowest>{{least, at}})) {
    lowest = theirs[0].value < lowest.value ? theirs[0] : lowest;
  }
  if (lowest.block >= 0) {
    run.notes.push_back({Severity::error, stress.where,
                         fmt::format("the in-situ stress would pull at block '{}' with {:.3g} Pa",
                                     block_name(run.scene, lowest.block), -lowest.value),
                         "contacts only push", "raise 'level', or give the load that lies on it"});
    throw SceneError(run.notes);
  }
}

void tell_of_swelling(RunState &run, const SwellReport &mine) {
  struct Unheld {
    double traction;
    std::int64_t block;
  };
  Unheld unheld{0.0, -1};
  for (const auto &theirs : run.communicator.all_gather(std::vector<Unheld>{{mine.unheld, mine.at}})) {
    unheld = theirs[0].traction > unheld.traction ? theirs[0] : unheld;
  }
  std::array<double, 3> largest{mine.widest, mine.spread, mine.largest};
  run.communicator.max(largest);
  run.in_situ_overlap = largest[0];
  const auto tell = [&](std::string what, std::string why, std::string hint) {
    run.notes.push_back(
        {Severity::info, run.scene.in_situ.where, std::move(what), std::move(why), std::move(hint)});
  };
  constexpr double noticeable = 1e-3;
  if (largest[1] > noticeable) {
    tell(fmt::format("edges meet several joint laws or lie partly on fixed blocks: what they ask for differs "
                     "by up to {:.2g} of its mean",
                     largest[1]),
         "an edge moves as a whole, so its contacts begin out of balance by as much",
         "let a stage of kind settle come first");
  }
  constexpr double rounding = 1e-6; // at a surface the stress is 0 up to that
  if (unheld.traction > rounding * largest[2]) {
    tell(fmt::format("an edge of block '{}' that touches nothing would have to bear {:.3g} Pa",
                     block_name(run.scene, unheld.block), unheld.traction),
         "the in-situ stress is not in equilibrium there", "hold that side, or put the load on it");
  }
}

} // namespace

void apply_in_situ_stress(RunState &run) {
  stress_rows(run);
  SwellReport report;
  const auto num_ranks = static_cast<std::size_t>(run.communicator.size());
  std::vector<std::vector<Swollen>> heads(num_ranks);
  std::vector<std::vector<Vec2>> moves(num_ranks);
  {
    const auto [placed, pairs] = run.neighbours.place(run.blocks);
    const std::vector<Vec2> by = find_swelling(placed, pairs, run.scene.joints, run.scene.in_situ, report);
    for (std::size_t row = 0; row < placed.num_owned; ++row) {
      const std::int64_t id = placed.properties[row].id.value;
      const auto owner =
          static_cast<std::size_t>(slab_owner(num_blocks(run.scene), run.communicator.size(), id));
      const std::span<const Vec2> own = placed.of_row(by, row);
      heads[owner].push_back({id, static_cast<std::int64_t>(own.size())});
      moves[owner].insert(moves[owner].end(), own.begin(), own.end());
    }
  }
  const auto all_heads = run.communicator.all_to_all(heads);
  const auto all_moves = run.communicator.all_to_all(moves);
  for (std::size_t rank = 0; rank < num_ranks; ++rank) {
    std::span<const Vec2> rest = all_moves[rank];
    for (const Swollen &head : all_heads[rank]) {
      swell(run.blocks, find_owned_row(run.blocks, head.block).value(),
            rest.first(static_cast<std::size_t>(head.num_vertices)));
      rest = rest.subspan(static_cast<std::size_t>(head.num_vertices));
    }
  }
  tell_of_swelling(run, report);
}

void put_initial_shear(RunState &run) {
  double cut = put_in_situ_shear(run.blocks, run.neighbours.candidates, run.scene.in_situ, run.contacts,
                                 run.neighbours.history);
  run.communicator.max(std::span(&cut, 1));
  if (cut > 0.0) {
    run.notes.push_back({Severity::info, run.scene.in_situ.where,
                         fmt::format("joints are too weak for the in-situ shear by up to {:.2g} of it", cut),
                         "it starts at their strength, and they slip",
                         "another k0 or a higher friction angle would be in equilibrium"});
  }
}

} // namespace gcpdda
