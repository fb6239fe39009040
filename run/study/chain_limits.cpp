#include "chain_limits.hpp"

#include "amplification_matrix.hpp"
#include "support/eigenvalues.hpp"
#include "support/setting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

namespace gcpdda::study {

namespace {

using namespace testing;

constexpr int num_blocks_in_chain = 10;
constexpr double k_n = 1e9;
constexpr double overlap = 1e-5; ///< m, closes the joints
/// Growth per step from which a chain counts as unstable: elasticity taken implicitly lets some grow slowly.
constexpr double noticed = 1e-3;
const double omega_joint = std::sqrt(k_n / rock_density);

struct Chain {
  std::string kind;
  std::string elasticity; ///< "none" for rigid blocks
  double softness = 0.0;  ///< k_n L/E
  double time_step = 0.0; ///< s
  int num_steps = 1;

  [[nodiscard]] bool is_rigid() const { return kind == "rigid"; }
};

/// Unit squares in a row between two fixed ones, every joint closed by the same overlap; a row moves only
/// along itself as its blocks are kicked that way. Loads that pull on the faces of a deformable block hold
/// its joints' pressure in balance without strain.
Scene scene_of_chain(const Chain &chain) {
  constexpr double kick = 1e-3 * overlap;
  std::string toml =
      head({.duration = chain.num_steps * chain.time_step,
            .time_step = chain.time_step,
            .gravity = {},
            .normal_stiffness = k_n,
            .damping = 0.0,
            .run_keys = chain.is_rigid() ? "" : fmt::format("elasticity = \"{}\"", chain.elasticity),
            .fidelity = chain.kind,
            .youngs_modulus = chain.is_rigid() ? 0.0 : k_n / chain.softness});
  std::mt19937 engine(1);
  for (int i = 0; i <= num_blocks_in_chain + 1; ++i) {
    const double x = i * (1.0 - overlap);
    const bool is_wall = i == 0 || i == num_blocks_in_chain + 1;
    const double velocity = kick * omega_joint * (static_cast<double>(engine()) / 2147483648.0 - 1.0);
    std::string extra = is_wall ? "fixed = true" : fmt::format("velocity = [{:.17g}, 0.0, 0.0]", velocity);
    if (!is_wall && !chain.is_rigid()) {
      const double force = k_n * overlap * (1.0 - overlap);
      for (const double side : {-1.0, 1.0}) {
        extra += fmt::format("\n[[block.load]]\npoint = [{:.17g}, 0.0]\nforce = [{:.17g}, 0.0]",
                             x + 0.5 * side, side * force);
      }
    }
    toml += block_toml(fmt::format("b{}", i), rectangle({x - 0.5, -0.5}, {x + 0.5, 0.5}), extra);
  }
  return scene_of(toml);
}

bool explodes(Chain chain, double time_step) {
  chain.time_step = time_step;
  chain.num_steps = chain.elasticity == "implicit" ? 6000 : 600;
  Simulation simulation(Communicator::self(), scene_of_chain(chain));
  const auto fastest = [&] {
    double speed = 0.0;
    for (std::size_t row = 0; row < simulation.blocks().num_owned; ++row) {
      speed = std::max(speed, norm(simulation.blocks().velocity[row].u));
    }
    return speed;
  };
  const double at_start = fastest();
  while (!simulation.finished() && fastest() < 300.0 * at_start) {
    simulation.step();
  }
  return !(fastest() < 300.0 * at_start);
}

/// The limit of dt for which `unstable` changes, by bisection.
template <class Unstable> double limit_of(double low, double high, double accuracy, Unstable &&unstable) {
  while (high / low > 1.0 + accuracy) {
    const double middle = std::sqrt(low * high);
    (unstable(middle) ? high : low) = middle;
  }
  return std::sqrt(low * high);
}

/// M^-1 K of the chain along itself: unknowns u, then strains.
LinearSystem linear_chain(const Chain &chain, double time_step) {
  constexpr Eigen::Index n = num_blocks_in_chain;
  const Eigen::Index size = chain.is_rigid() ? n : 2 * n;
  Eigen::MatrixXd gaps = Eigen::MatrixXd::Zero(n + 1, size);
  Eigen::MatrixXd elastic = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd inverse_mass = Eigen::VectorXd::Constant(size, 1.0 / rock_density);
  for (Eigen::Index i = 0; i < n; ++i) {
    gaps(i, i) = 1.0;
    gaps(i + 1, i) = -1.0;
    if (!chain.is_rigid()) {
      gaps(i, n + i) = -0.5;
      gaps(i + 1, n + i) = -0.5;
      elastic(n + i, n + i) = k_n / chain.softness;
      inverse_mass(n + i) *= 12.0;
    }
  }
  const auto in_steps = [&](const Eigen::MatrixXd &stiffness) -> Eigen::MatrixXd {
    return time_step * time_step * inverse_mass.asDiagonal() * stiffness;
  };
  return {in_steps(k_n * gaps.transpose() * gaps), Eigen::MatrixXd::Zero(size, size), in_steps(elastic)};
}

double bound_of(Chain chain) {
  chain.time_step = 1e-6;
  return Simulation(Communicator::self(), scene_of_chain(chain)).bound().omega_max;
}

} // namespace

void chain_limits(const Options &options) {
  Table table(options.folder / "chain_limits.csv",
              {"kind", "elasticity", "k_n L/E", "omega_max_measured", "omega_max_theory",
               "product_bound_omega", "omega_joint"});
  std::vector<Chain> chains{{.kind = "rigid", .elasticity = "none"}};
  for (const char *elasticity : {"implicit", "explicit"}) {
    for (int power = -3; power <= 3; ++power) {
      chains.push_back({.kind = "deformable", .elasticity = elasticity, .softness = std::pow(10.0, power)});
    }
  }
  for (const Chain &chain : chains) {
    const Elastic elastic = chain.elasticity == "explicit" ? Elastic::at_trial : Elastic::implicit;
    const double low = 1e-3 / omega_joint;
    const double high = 10.0 / omega_joint;
    const double theory =
        2.0 / limit_of(low, high, 1e-5, [&](double dt) {
          return spectral_radius(amplification_matrix({}, linear_chain(chain, dt), elastic)) > 1.0 + noticed;
        });
    const double measured = 2.0 / limit_of(low, high, 1e-3, [&](double dt) { return explodes(chain, dt); });
    const double bound = bound_of(chain);
    table.add({chain.kind, chain.elasticity, chain.softness, measured, theory, bound, omega_joint});
    const auto share = [](double w) { return w * w / (omega_joint * omega_joint); };
    std::cout << fmt::format(
        "chain, {}, elasticity {}, k_n L/E = {:g}: omega^2 m/k_n measured {:.3f}, theory "
        "{:.3f}, bound {:.3f}\n",
        chain.kind, chain.elasticity, chain.softness, share(measured), share(theory), share(bound));
  }
}

} // namespace gcpdda::study
