#pragma once

namespace gcpdda::testing {

/// Lowest frequency (rad/s) of a row of unit squares of the test rock between two abutments, all joints
/// closed: each has a displacement and a uniform strain, each joint the stiffness k_n. Without Poisson's
/// effect.
double jointed_bar_frequency(int num_blocks, double youngs_modulus, double joint_stiffness);

} // namespace gcpdda::testing
