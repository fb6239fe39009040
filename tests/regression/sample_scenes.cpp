#include "sample_scenes.hpp"

#include "support/scenes.hpp"

#include <fmt/format.h>

namespace gcpdda::testing {

std::string small_scene() {
  return head_scene(1e8, 1e-3, 0.1) + "[[monitor]]\nblock = \"slider\"\n[[monitor]]\nblock = \"floor\"\n" +
         block_toml("slider", rectangle({0.0, 0.0}, {1.0, 1.0}), "velocity = [1.5, 0, 0]") +
         block_toml("tower", rectangle({3.0, 0.0}, {4.0, 2.0}));
}

std::string head_scene(double normal_stiffness, double time_step, double duration) {
  return fmt::format("[run]\nduration = {}\ntime_step = {}\nfidelity = \"rigid\"\n[material.rock]\n"
                     "density = 2600\n[joint.default]\nnormal_stiffness = {}\n[output]\ninterval = {}\n"
                     "history_interval = {}\n",
                     duration, time_step, normal_stiffness, duration / 4, duration / 8) +
         block_toml("floor", rectangle({-20.0, -2.0}, {20.0, 0.0}), "fixed = true");
}

} // namespace gcpdda::testing
