#include "closed_paths.hpp"

#include "contact/block_view.hpp"
#include "contact/contact_forces.hpp"
#include "model/block_system.hpp"
#include "support/setting.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <iostream>

namespace gcpdda::study {

namespace {

using namespace testing;

/// Place of the moving block: x = x_0 + u + F X.
struct Pose {
  Vec2 u;
  Mat2 gradient = Mat2::identity();
};

enum class Distance { reference, current };

/// A block that is led around another one.
struct Loop {
  std::string name;
  std::vector<Vec2> moving;
  std::vector<Vec2> still;
  bool deforms = false;
  std::function<Pose(double)> pose; ///< of the phase, 0 to 2 pi
};

struct Work {
  double net = 0.0;
  double total = 0.0;
};

/// A pair of blocks of which the first is moved by hand, and the force on its centroid and on F.
class Pair {
public:
  Pair(const Loop &loop, PotentialKind potential, Distance distance) : potential_(potential) {
    const Material rock{"rock", rock_density, 1.0, 0.0};
    SceneBlock moving;
    moving.vertices = loop.moving;
    SceneBlock still;
    still.vertices = loop.still;
    still.fixed = true;
    append_block(system_, BlockId{0}, moving, rock, BlockKind::deformable);
    append_block(system_, BlockId{1}, still, rock);
    system_.num_owned = 1;
    system_.num_fixed = 1;
    is_seen_deformed_ = loop.deforms && distance == Distance::reference;
    pose(system_, 0, 2);
  }

  struct Force {
    Vec2 centre;
    Mat2 gradient;
  };

  Force force_at(const Pose &at) {
    system_.trial[0].u = at.u;
    system_.deformation_of(0).trial = at.gradient;
    pose(system_, 0, 1);
    BlockView moving = view_of(system_, 0, outlines_[0]);
    if (!is_seen_deformed_) {
      moving.frame.reset();
    }
    Force force;
    if (!overlap_.find(moving, view_of(system_, 1, outlines_[1]), potential_)) {
      return force;
    }
    for (const Region &region : overlap_.regions()) {
      const RegionIntegrals sum = overlap_.integrate(region);
      const Mat2 dyad = Mat2{sum.dyad[0], sum.dyad[1], sum.dyad[2], sum.dyad[3]} +
                        outer(sum.origin - system_.motion[0].centroid, sum.force);
      force.centre += sum.force;
      force.gradient += transposed(inverse(at.gradient) * dyad);
    }
    return force;
  }

private:
  BlockSystem system_;
  Overlap overlap_;
  std::array<TrialOutline, 2> outlines_;
  PotentialKind potential_;
  bool is_seen_deformed_ = false;
};

/// Trapezoid in the force.
Work work_on(const Loop &loop, PotentialKind potential, Distance distance, int steps) {
  Pair pair(loop, potential, distance);
  Work work;
  Pose last = loop.pose(0.0);
  Pair::Force before = pair.force_at(last);
  for (int k = 1; k <= steps; ++k) {
    const Pose now = loop.pose(2.0 * std::numbers::pi * k / steps);
    const Pair::Force after = pair.force_at(now);
    const double increment = 0.5 * (dot(before.centre + after.centre, now.u - last.u) +
                                    contract(before.gradient + after.gradient, now.gradient - last.gradient));
    work.net += increment;
    work.total += std::abs(increment);
    last = now;
    before = after;
  }
  return work;
}

Mat2 turned(double angle) {
  const Rotation turn = Rotation::of(angle);
  return {turn.c, -turn.s, turn.s, turn.c};
}

/// The tip of a kite circles about the tip of another one and swings by 25 degrees.
Loop tip_on_tip() {
  return {"tip on tip",
          {{0.0, 0.0}, {0.9, 1.0}, {0.0, 1.8}, {-0.9, 1.0}},
          {{0.0, 0.1}, {-0.9, -1.0}, {0.0, -1.9}, {0.9, -1.0}},
          false,
          [](double phase) {
            const double angle = 25.0 * degree * std::sin(2.0 * phase + 0.7);
            const Vec2 centroid{0.0, 14.0 / 15.0};
            const Vec2 tip = 0.05 * Vec2{std::cos(phase), std::sin(phase)};
            return Pose{tip + Rotation::of(angle)(centroid) - centroid, turned(angle)};
          }};
}

/// A square that is stretched and sheared by 3 % while it circles and swings in another block.
Loop deforming(std::string name, std::vector<Vec2> still) {
  return {std::move(name), rectangle({-0.5, -0.5}, {0.5, 0.5}), std::move(still), true, [](double phase) {
            constexpr double strain = 0.03;
            const Mat2 stretch{1.0 + strain * std::sin(phase), strain * std::sin(2.0 * phase + 0.8),
                               0.5 * strain * std::cos(phase), 1.0 + strain * std::sin(phase + 2.0)};
            return Pose{Vec2{0.0, 0.4} + 0.05 * Vec2{std::cos(phase), std::sin(phase)},
                        turned(20.0 * degree * std::sin(2.0 * phase + 1.0)) * stretch};
          }};
}

} // namespace

void closed_paths(const Options &options) {
  Table table(options.folder / "closed_paths.csv", {"path", "variant", "steps", "net_over_total"});
  const std::vector<int> counts =
      options.quick ? std::vector{200, 2000} : std::vector{200, 500, 1000, 2000, 5000, 10000, 20000};
  const auto add = [&](const Loop &loop, const std::string &variant, PotentialKind potential,
                       Distance distance) {
    double share = 0.0;
    for (const int steps : counts) {
      const Work work = work_on(loop, potential, distance, steps);
      share = std::abs(work.net) / work.total;
      table.add({loop.name, variant, std::int64_t{steps}, share});
    }
    std::cout << fmt::format("closed path, {}, {}: net work over total {:.2e} with {} steps\n", loop.name,
                             variant, share, counts.back());
  };
  const Loop tips = tip_on_tip();
  add(tips, "potential exact", PotentialKind::exact, Distance::reference);
  add(tips, "potential linear", PotentialKind::linear, Distance::reference);
  for (const Loop &loop :
       {deforming("flat face", rectangle({-3.0, -2.0}, {3.0, 0.0})),
        deforming("corner",
                  {{-3.0, -2.0}, {3.0, -2.0}, {3.0, 0.0}, {-0.4, -0.05}, {-0.5, 2.0}, {-3.0, 2.0}})}) {
    add(loop, "reference distance", PotentialKind::exact, Distance::reference);
    add(loop, "current distance", PotentialKind::exact, Distance::current);
  }
}

} // namespace gcpdda::study
