#include "accuracy_problems.hpp"

#include "contact/geometry/overlap.hpp"
#include "support/incline.hpp"
#include "support/jointed_bar.hpp"
#include "support/setting.hpp"
#include "support/shapes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace gcpdda::study {

using namespace testing;

namespace {

/// The head of a rigid or fitting scene with the stiffness of the rule.
Setting setting_of(const Choice &choice, double height, double block_size, double duration) {
  Setting setting;
  setting.duration = duration;
  setting.interval = duration;
  setting.normal_stiffness = stiffness(height, block_size, choice.allowed_overlap);
  setting.fidelity = choice.fidelity == "fitting" ? "rigid" : choice.fidelity;
  setting.run_keys = run_keys(choice);
  return setting;
}

/// Run to the end and measure what is left.
template <class Error> Measured compute(const std::string &toml, Error &&error) {
  Simulation simulation(Communicator::self(), scene_of(toml));
  Measured outcome;
  outcome.cost = advance(simulation, simulation.plan().duration);
  outcome.error = simulation.fault() ? std::numeric_limits<double>::infinity() : error(simulation);
  outcome.normal_stiffness = simulation.contacts().parameters().joints.laws.front().normal_stiffness;
  outcome.time_step = simulation.plan().time_step;
  return outcome;
}

Measured slide(const Choice &choice, bool from_solved_start) {
  constexpr double duration = 2.0;
  Incline incline;
  incline.normal_stiffness = stiffness(1.0, 1.0, choice.allowed_overlap);
  const Setting setting = setting_of(choice, 1.0, 1.0, duration);
  const std::vector<Vec2> square =
      from_solved_start ? incline.sliding_square() : incline.flat_square(incline.static_depth());
  return compute(incline.toml(square, setting), [&](const Simulation &simulation) {
    const double exact = 0.5 * incline.acceleration() * duration * duration;
    return std::abs(dot(displacement_of(simulation, 1).u, incline.downhill()) / exact - 1.0);
  });
}

double kinetic_energy(const Simulation &simulation, int block) {
  const BlockProperties &properties = simulation.blocks().properties[row_of(simulation, block)];
  const RigidDof &v = velocity_of(simulation, block);
  return 0.5 * (properties.mass * dot(v.u, v.u) + properties.inertia * v.r * v.r);
}

/// Root mean square over gaps before the impact: where in the step it falls changes the error of a single
/// one.
Measured collide(const Choice &choice, int phases) {
  Measured mean;
  for (int phase = 0; phase < phases; ++phase) {
    Setting setting = setting_of(choice, 1.0, 1.0, 0.4);
    setting.gravity = {};
    setting.damping = 0.0;
    const double gap = 0.05 + 1e-3 * phase / phases;
    const std::string toml =
        head(setting) + block_toml("left", rectangle({-1.0, 0.0}, {0.0, 1.0}), "velocity = [1.0, 0.2, 0.0]") +
        block_toml("right", rectangle({gap, 0.5}, {1.0 + gap, 1.5}), "velocity = [-1.0, 0.0, 0.0]");
    const Measured one = compute(toml, [](const Simulation &simulation) {
      const double before = 0.5 * rock_density * (1.0 + 0.04 + 1.0);
      return (kinetic_energy(simulation, 0) + kinetic_energy(simulation, 1)) / before - 1.0;
    });
    mean.error += one.error * one.error;
    mean.cost.cpu += one.cost.cpu / phases;
    mean.cost.evaluations += one.cost.evaluations / phases;
    mean.cost.contact_steps += one.cost.contact_steps / phases;
    mean.cost.steps = one.cost.steps;
    mean.normal_stiffness = one.normal_stiffness;
    mean.time_step = one.time_step;
  }
  mean.error = std::sqrt(mean.error / phases);
  return mean;
}

/// Depth at which a corner of the turned block carries its weight, or the deepest a scene may start with.
double depth_of_corner(const std::vector<Vec2> &block, double width, const std::vector<Vec2> &ground,
                       double weight, double normal_stiffness) {
  const Shape floor = shape_of(ground);
  double low = 0.0;
  double high = 0.049 * width;
  for (int k = 0; k < 60; ++k) {
    const double depth = 0.5 * (low + high);
    const Shape sunk = shape_of(placed(block, 0.0, {0.0, -depth}));
    Overlap overlap;
    const bool touches = overlap.find(sunk.view(), floor.view(), PotentialKind::exact);
    const double force =
        touches ? 0.5 * normal_stiffness * overlap.integrate(overlap.regions().front()).force.y : 0.0;
    (force < weight ? low : high) = depth;
  }
  return low;
}

Measured topple(const Choice &choice) {
  constexpr double width = 0.5;
  constexpr double height = 1.0;
  constexpr double start = 5.0 * degree;
  constexpr double duration = 0.8;
  Setting setting = setting_of(choice, height, std::sqrt(width * height), duration);
  setting.friction_deg = 60.0;
  const std::vector<Vec2> ground = rectangle({-5.0, -2.0}, {5.0, 0.0});
  // The right lower corner is the origin; the line from it to the centroid leans to the right by `start`.
  const double turn = -(std::atan2(width, height) + start);
  std::vector<Vec2> block = placed(rectangle({-width, 0.0}, {0.0, height}), turn, {});
  const double depth = depth_of_corner(block, width, ground, rock_density * width * height * earth_gravity,
                                       setting.normal_stiffness);
  block = placed(block, 0.0, {0.0, -depth});
  const std::string toml =
      head(setting) + block_toml("ground", ground, "fixed = true") + block_toml("block", block);
  return compute(toml, [&](const Simulation &simulation) {
    const double exact = toppling_angle(width, height, start, duration) - start;
    return std::abs(-displacement_of(simulation, 1).r / exact - 1.0);
  });
}

/// A bar of unit squares; its k_n and E are part of the problem.
constexpr int bar_blocks = 8;
constexpr double bar_stiffness = 1e9;

Setting bar_setting(const Choice &choice, double youngs_modulus, double duration, double damping,
                    const std::string &keys) {
  Setting setting = setting_of(choice, 1.0, 1.0, duration);
  setting.gravity = {};
  setting.normal_stiffness = bar_stiffness;
  setting.damping = damping;
  setting.fidelity = choice.fidelity == "fitting" ? "deformable" : choice.fidelity;
  setting.youngs_modulus = youngs_modulus;
  setting.run_keys += "plane = \"stress\"\n" + keys;
  return setting;
}

std::string abutment(double left, double right) {
  return block_toml(fmt::format("abutment{:.0f}", left), rectangle({left, -1.0}, {right, 2.0}),
                    "fixed = true");
}

Measured compress(const Choice &choice) {
  constexpr double load = 1e-6 * bar_stiffness;
  std::string toml =
      head(bar_setting(choice, bar_stiffness, 1.5, 0.1, "local_damping = 0.4\n")) + abutment(-2.0, 0.0);
  for (int i = 0; i < bar_blocks; ++i) {
    std::string extra;
    for (const double y : {0.25, 0.75}) {
      extra += i + 1 < bar_blocks ? ""
                                  : fmt::format("[[block.load]]\npoint = [{}, {}]\nforce = [{:.17g}, 0.0]\n",
                                                bar_blocks, y, -0.5 * load);
    }
    toml += block_toml(fmt::format("bar{}", i), rectangle({1.0 * i, 0.0}, {i + 1.0, 1.0}), extra);
  }
  return compute(toml, [](const Simulation &simulation) {
    const BlockSystem &blocks = simulation.blocks();
    const std::size_t last = row_of(simulation, bar_blocks);
    double end = displacement_of(simulation, bar_blocks).u.x;
    if (blocks.is_deformable(last)) {
      end += 0.5 * (blocks.deformation_of(last).gradient.xx - 1.0);
    }
    const double exact = 2.0 * load * bar_blocks / bar_stiffness;
    return std::abs(-end / exact - 1.0);
  });
}

/// The half wave of the compressed bar, from its motion after five half periods: in that time a frequency
/// that is off by a share e shifts the phase by 5 pi e.
Measured ring(const Choice &choice) {
  constexpr double squeeze = 1e-5; // keeps every joint closed
  constexpr double speed = 1e-4;
  const double shape = std::numbers::pi / (bar_blocks + 1);
  constexpr double youngs_modulus = 10.0 * bar_stiffness;
  constexpr double half_periods = 5.0;
  const double exact = jointed_bar_frequency(bar_blocks, youngs_modulus, bar_stiffness);
  std::string toml =
      head(bar_setting(choice, youngs_modulus, half_periods * std::numbers::pi / exact, 0.0, ""));
  for (int i = 0; i < bar_blocks; ++i) {
    toml += block_toml(fmt::format("bar{}", i),
                       rectangle({i * (1.0 - squeeze), 0.0}, {i * (1.0 - squeeze) + 1.0, 1.0}),
                       fmt::format("velocity = [{:.17g}, 0.0, 0.0]", speed * std::sin(shape * (i + 1))));
  }
  const double end = bar_blocks * (1.0 - squeeze);
  toml += abutment(-2.0, squeeze) + abutment(end, end + 2.0);
  return compute(toml, [&](const Simulation &simulation) {
    double u = 0.0;
    double v = 0.0;
    for (int i = 0; i < bar_blocks; ++i) {
      u += displacement_of(simulation, i).u.x * std::sin(shape * (i + 1));
      v += velocity_of(simulation, i).u.x * std::sin(shape * (i + 1));
    }
    // After an odd number of half periods u is back at zero and v turned round.
    return std::abs(std::atan2(exact * u, -v)) / (half_periods * std::numbers::pi);
  });
}

/// How far the top of a pile has sunk or moved, as a share of its height: rigid bodies would stay.
Measured pile(const Choice &choice, const std::string &bricks, int top, double height, double block_size) {
  Setting setting = setting_of(choice, height, block_size, 2.0);
  setting.friction_deg = std::atan(0.6) / degree;
  const std::string toml =
      head(setting) + block_toml("ground", rectangle({-20.0, -2.0}, {40.0, 0.0}), "fixed = true") + bricks;
  return compute(
      toml, [&](const Simulation &simulation) { return norm(displacement_of(simulation, top).u) / height; });
}

} // namespace

std::string run_keys(const Choice &choice) {
  return (choice.safety > 0.0 ? fmt::format("safety = {:.17g}\n", choice.safety) : "") + choice.run_keys;
}

double toppling_angle(double width, double height, double start, double time) {
  const double rate =
      earth_gravity * 0.5 * std::hypot(width, height) * 3.0 / (width * width + height * height);
  const int steps = static_cast<int>(std::lround(time / 1e-5));
  const double dt = time / steps;
  double angle = start;
  double omega = 0.0;
  for (int k = 0; k < steps; ++k) {
    const double a1 = rate * std::sin(angle);
    const double w2 = omega + 0.5 * dt * a1;
    const double a2 = rate * std::sin(angle + 0.5 * dt * omega);
    const double w3 = omega + 0.5 * dt * a2;
    const double a3 = rate * std::sin(angle + 0.5 * dt * w2);
    const double w4 = omega + dt * a3;
    const double a4 = rate * std::sin(angle + dt * w3);
    angle += dt / 6.0 * (omega + 2.0 * w2 + 2.0 * w3 + w4);
    omega += dt / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
  }
  return angle;
}

PileSizes pile_sizes(bool quick) {
  return quick ? PileSizes{4, 3, 6} : PileSizes{12, 6, 10};
}

std::vector<Problem> accuracy_problems(bool quick) {
  const std::vector<double> usual =
      quick ? std::vector{1.0, 0.25} : std::vector{1.0, 0.7, 0.5, 0.25, 0.125, 0.0625};
  std::vector<double> impact = usual;
  for (double safety = 1.0 / 64; safety > (quick ? 1.0 / 64 : 1.0 / 20000); safety /= 4.0) {
    impact.push_back(safety);
  }
  const PileSizes sizes = pile_sizes(quick);
  const std::string wall = fmt::format(
      "[[wall]]\nname = \"wall\"\nmaterial = \"rock\"\norigin = [0.0, 0.0]\nrows = {}\ncolumns = {}\n"
      "block_size = [1.0, 0.5]\n",
      sizes.wall_rows, sizes.wall_columns);
  const std::string pyramid = fmt::format("[[pyramid]]\nname = \"pyramid\"\nmaterial = \"rock\"\n"
                                          "origin = [0.0, 0.0]\nrows = {}\nblock_size = [1.0, 1.0]\n",
                                          sizes.pyramid_rows);
  return {
      {"incline", "path of 2 s on 30/15 degrees, flat start, against a t^2/2", true, false, 1e-12, usual,
       [](const Choice &c) { return slide(c, false); }},
      {"incline_solved", "the same from depth and tilt of steady sliding", true, false, 1e-12, usual,
       [](const Choice &c) { return slide(c, true); }},
      {"oblique_impact", "kinetic energy after an elastic impact, rms of 4 phases", true, false, 1e-12,
       impact, [](const Choice &c) { return collide(c, 4); }},
      {"toppling_block", "angle after 0.8 s against a rigid corner", true, false, 1e-12, usual, topple},
      {"bar_compressed", "shortening against blocks and joints in a row", false, true, 1e-5, usual, compress},
      {"bar_wave", "frequency against the eigenvalue", false, true, 1e-6, usual, ring},
      {"wall", "share of its height that the top has moved, 2 s after sudden gravity", true, false, 1e-12,
       usual,
       [=](const Choice &c) {
         return pile(c, wall, sizes.top_of_wall(), 0.5 * sizes.wall_rows, std::sqrt(0.5));
       }},
      {"pyramid", "the same of a pyramid", true, false, 1e-12, usual,
       [=](const Choice &c) { return pile(c, pyramid, sizes.top_of_pyramid(), sizes.pyramid_rows, 1.0); }},
  };
}

} // namespace gcpdda::study
