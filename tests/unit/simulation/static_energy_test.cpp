// Energies of settle stages with the static solver in which blocks go far.

#include "simulation/energy_ledger.hpp"
#include "support/incline.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace gcpdda::testing::static_energy_test {
namespace {

// A slab tips over the edge of a pier, falls 3 m and comes to rest on the ground. It turns by up to a
// twentieth of its width in an evaluation. What is left of the weight's work is the trapezoid of contact
// forces over the steps in which it lands, 3 % for a rigid slab as well. A turn that stretched the slab would
// leave a strain of half its square: 3 times the work of the weight in the stiffest.
TEST(StaticEnergy, ADeformableSlabThatTurnsAsItFallsGainsNone) {
  const auto settle_slab = [](const std::string &modulus) {
    const std::string toml =
        fmt::format("[run]\n[material.rock]\ndensity = 2600.0\npoissons_ratio = 0.2\nyoungs_modulus = {}\n"
                    "[joint.default]\nnormal_stiffness = 1e9\nfriction_angle_deg = 30.0\n"
                    "[output]\ninterval = 0.05\n",
                    modulus) +
        block_toml("ground", rectangle({-6.0, -1.0}, {8.0, 0.0}), "fixed = true") +
        block_toml("pier", rectangle({-2.0, 0.0}, {0.0, 3.0}), "fixed = true") +
        block_toml("slab", rectangle({-0.9, 3.0}, {1.1, 3.5})) +
        "[[stage]]\nkind = \"settle\"\nlimit = 20.0\nfailure_motion = 100.0\nsolver = \"static\"\n";
    Simulation simulation(Communicator::self(), scene_of(toml));
    const EnergyLedger ledger(simulation.state());
    run_stages(simulation);
    EXPECT_EQ(simulation.stage_results().back().verdict, Verdict::settled) << modulus;
    const EnergyRow row = ledger.row(simulation.state());
    EXPECT_LT(row.gravity, -2.0 * rock_density * earth_gravity)
        << modulus; // 1 m2 has gone down by 2 m or more
    EXPECT_LT(std::abs(row.residual), 0.06 * -row.gravity) << modulus;
  };
  for (const char *modulus : {"1e8", "1e9", "2e11"}) {
    settle_slab(modulus);
  }
}

} // namespace
} // namespace gcpdda::testing::static_energy_test
