#include "simulation/strain_watch.hpp"

#include "io/results/id_slabs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace gcpdda {

// The stretches are the sum and the difference of the sizes of the parts of F that turn alike and opposite.
double strain_of(const Mat2 &gradient) {
  const double mean = 0.5 * std::hypot(gradient.xx + gradient.yy, gradient.yx - gradient.xy);
  const double radius = 0.5 * std::hypot(gradient.xx - gradient.yy, gradient.yx + gradient.xy);
  return std::max(std::abs(mean + radius - 1.0), std::abs(mean - radius - 1.0));
}

LargestStrain largest_strain(const Communicator &communicator, const BlockSystem &blocks) {
  LargestStrain largest;
  const auto see = [&](const LargestStrain &other) {
    const bool is_first = other.strain == largest.strain && other.block < largest.block;
    largest = other.block >= 0 && (largest.block < 0 || other.strain > largest.strain || is_first) ? other
                                                                                                   : largest;
  };
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    const double strain = blocks.is_deformable(row) ? strain_of(blocks.deformation_of(row).gradient) : 0.0;
    if (blocks.is_deformable(row) && std::isfinite(strain)) {
      see({strain, blocks.properties[row].id.value, blocks.properties[row].material});
    }
  }
  for (const auto &theirs : communicator.all_gather(std::vector<LargestStrain>{largest})) {
    see(theirs[0]);
  }
  return largest;
}

std::optional<Diagnostic> StrainWatch::look(const RunState &run) {
  if (has_told_ || run.fidelity.num_deformable == 0) {
    return std::nullopt;
  }
  const LargestStrain largest = largest_strain(run.communicator, run.blocks);
  if (largest.strain <= large_strain) {
    return std::nullopt;
  }
  has_told_ = true;
  const std::string &material = run.scene.materials[static_cast<std::size_t>(largest.material)].name;
  return Diagnostic{Severity::warning,
                    {},
                    fmt::format("block '{}' is strained by {:.2g} at t = {:.6g} s",
                                block_name(run.scene, largest.block), largest.strain, run.clock.time()),
                    fmt::format("linear elasticity is meant for small strains, below {:g}", large_strain),
                    fmt::format("use a larger material.{}.youngs_modulus, or check its unit, Pa", material)};
}

} // namespace gcpdda
