// The tangent stiffness of contacts that stick, by differences through the program's own force function.
//
// What it must be. Friction of a sticking region acts at a point x of the overlap, along the region's t; n is
// its normal, phi their angle, A the lower block. With w the way of the material point of A that lies at x
// relative to that of B, and L = dF F^-1 of each block, L_nt = n . L t,
//     b_t = (t, t (x) X_A; -t, -t (x) X_B),      dw_t = b_t . dq,      b_n the same with n.
// The force on q is -F_t b_t with dF_t = k_t b_t . dq, so that K = k_t b_t b_t^T + F_t db_t/dq. The first
// term is symmetric because elongation and force belong to the same point. In the second one t turns, dt =
// -n dphi, and x moves through both blocks. Along t it is a point of A (the grip; between two rigid blocks
// that does not matter, as t (x) t does no work on them); along n it lies in the overlap and leaves the point
// of A by da. It leaves the point of B by n (da + dw_n) + t dw_t. Hence
//     db_t/dq = -b_n dphi^T + (L_tn^A - L_tn^B) da^T - L_tn^B b_n^T - L_tt^B b_t^T.                     (R)
// The point of action that was rejected, the centre of pressure, has one more term, t (x) F^-1 t times its
// way along t: l^2/(12 d) a radian on a joint of length l and depth d, which makes it T/N k_n l^3/12.
//
// How large it is. b_n and b_t are of order 1, L of order 1/L for motions of blocks of size L. Of a joint
// that is closed along l, n_r turns with the blocks' faces, dphi = 1/L, and da = -dw_n/2: K has the norm k_t
// l, so the remainder is F_t/(k_t l L) of it, the elongation of the stick spring over the size of a block. At
// a corner n_r follows the shape of a small overlap, dphi and da/l are 1/l, and the size is the extent l of
// the contact. So let e = F_t/(k_t l^2) be the strain of the spring: the skew part is at most about e of K.
// (For two rigid blocks with equal faces the terms of (R) pair off, b_n dphi^T + dphi b_n^T, and it is
// symmetric.)
//
// Why it is harmless. (1) In unknowns with the unit mass matrix an eigenvalue lambda = w^2 with unit vector v
// has the imaginary part v^H (K - K^T) v/2i. So nothing grows faster than |K - K^T|/(4 w), about e w/2,
// whatever the sign of F_t, and e is 1e-6 to 1e-3 where T/N stood before. (2) Even that takes two modes whose
// w^2 are closer to each other than e w^2: other pairs only shift. (3) A dashpot of ratio xi takes xi w from
// modes that move the joint, and xi is hundreds of times e. (4) Over any path the work of friction on the
// blocks is -F_t dw_t = -d(F_t^2/2 k_t): nothing is made, motion can only take what the springs hold.

#include "support/base_state.hpp"
#include "support/blocks.hpp"
#include "support/touching_pairs.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace gcpdda::testing::tangent_test {
namespace {

constexpr double k_n = 1e10;
constexpr double tangential_ratio = 0.7;
constexpr double friction = 2.0;

struct Kernel {
  const char *name;
  PairPath path;
  Instructions instructions;
};
constexpr std::array<Kernel, 4> kernels{{{"one by one", PairPath::general, Instructions::widest},
                                         {"portable", PairPath::plain, Instructions::portable},
                                         {"avx2", PairPath::plain, Instructions::avx2},
                                         {"widest", PairPath::plain, Instructions::widest}}};

struct Sample {
  Touch touch;
  bool lower_deforms;
  bool higher_deforms;
  unsigned seed;
  double depth;  ///< m
  double strain; ///< of the stick spring over the extent of the contact, at most

  [[nodiscard]] std::string name() const {
    return fmt::format("touch {}, {}-{}, seed {}", static_cast<int>(touch),
                       lower_deforms ? "deformable" : "rigid", higher_deforms ? "deformable" : "rigid", seed);
  }
};

/// A contact that has been deeper and longer before and sticks under a shear of random sign: not on the edge
/// of the rules by which friction remembers.
struct Stuck {
  BaseState state;
  double strain = 0.0; ///< of the stick spring, largest of the regions

  Stuck(const Sample &sample, const Kernel &kernel) : Stuck(sample, kernel, std::mt19937(sample.seed)) {}

private:
  Stuck(const Sample &sample, const Kernel &kernel, std::mt19937 engine)
      : Stuck(sample, kernel, touching_pair(engine, sample.touch, sample.depth), engine) {}
  Stuck(const Sample &sample, const Kernel &kernel, const TouchingPair &pair, std::mt19937 &engine)
      : state(strained_blocks(engine, {pair.lower, pair.higher},
                              {sample.lower_deforms, sample.higher_deforms}, 1e9),
              {one_law(k_n, friction, 0.0, tangential_ratio), 0.0, PotentialKind::exact, 0.0}, kernel.path,
              kernel.instructions) {
    const std::vector<RegionForce> regions = state.regions();
    EXPECT_EQ(regions.size(), static_cast<std::size_t>(pair.num_regions)) << sample.name();
    Vec2 deeper;
    for (const RegionForce &region : regions) {
      deeper += region.normal;
    }
    state.visit(0.3 * sample.depth * (state.motion_of(1, deeper) + 0.1 * state.motion_of(0, -1.0 * deeper)));
    state.visit_base();
    state.change_memory([&](const RegionForce &region, RegionState &memory) {
      memory.longest *= 1.01;
      const double stiffness = tangential_ratio * k_n * memory.longest;
      const double extent = region.extent_end - region.extent_begin;
      const double most = std::min(sample.strain * stiffness * extent, 0.9 * friction * region.normal_force);
      memory.shear = (engine() % 2 == 0 ? 1.0 : -1.0) * uniform(engine, 0.7, 1.0) * most;
      strain = std::max(strain, std::abs(memory.shear) / (stiffness * extent));
    });
    state.visit_base();
  }
};

/// visit(sample, name) for all kinds of contacts.
template <class Visit> void for_samples(double depth, double strain, unsigned num_seeds, Visit &&visit) {
  for (const Touch touch : {Touch::face_on_face, Touch::corner_in_face, Touch::corner_on_corner,
                            Touch::teeth_on_face, Touch::teeth_on_teeth, Touch::in_a_notch}) {
    for (unsigned seed = 1; seed <= num_seeds; ++seed) {
      for (const unsigned kinds : {0U, 1U, 2U, 3U}) {
        visit(Sample{touch, (kinds & 1U) != 0, (kinds & 2U) != 0, 100 * static_cast<unsigned>(touch) + seed,
                     depth, strain});
      }
    }
  }
}

// What is left is the error of differences (base_state.hpp).
TEST(Tangent, OfAStickingContactIsSymmetric) {
  double worst = 0.0;
  for_samples(1e-5, 1e-7, 6, [&](const Sample &sample) {
    for (const Kernel &kernel : kernels) {
      Stuck stuck(sample, kernel);
      const double skew = skewness(stuck.state.contact_stiffness(3e-3 * sample.depth));
      EXPECT_LE(skew, 1e-6) << sample.name() << ", " << kernel.name;
      worst = std::max(worst, skew);
    }
  });
  RecordProperty("largest_skew", fmt::format("{:.2e}", worst));
}

// (R): no more than the strain of the spring, times a number of order 1 that blocks of these shapes have.
TEST(Tangent, IsSkewByTheStrainOfTheStickSpring) {
  std::array<double, 6> worst{};
  for (const double strain : {1e-3, 1e-4, 1e-5}) {
    for_samples(strain, strain, 3, [&](const Sample &sample) {
      for (const Kernel &kernel : kernels) {
        Stuck stuck(sample, kernel);
        const double skew = skewness(stuck.state.contact_stiffness(3e-3 * sample.depth));
        EXPECT_LE(skew, 2.0 * stuck.strain + 1e-6)
            << sample.name() << ", " << kernel.name << ", strain " << stuck.strain;
        double &most = worst[static_cast<std::size_t>(sample.touch)];
        most = std::max(most, skew / stuck.strain);
      }
    });
  }
  for (std::size_t k = 0; k < worst.size(); ++k) {
    RecordProperty(fmt::format("skew_over_strain_{}", k), fmt::format("{:.3f}", worst[k]));
  }
}

/// Of a number that depends on the unknowns.
template <class Value> Eigen::VectorXd gradient_by_differences(BaseState &state, double step, Value &&value) {
  Eigen::VectorXd gradient(state.num_unknowns());
  for (Eigen::Index k = 0; k < gradient.size(); ++k) {
    const Eigen::VectorXd by = step * Eigen::VectorXd::Unit(gradient.size(), k);
    gradient(k) = (value(by) - value(-by)) / (2.0 * step);
  }
  return gradient;
}

/// F_t times (R), of the only region.
Eigen::MatrixXd remainder(BaseState &state, double step) {
  const RegionForce base = state.regions().front();
  double shear = 0.0;
  state.change_memory([&](const RegionForce &, const RegionState &memory) { shear = memory.shear; });
  const Vec2 n = base.normal;
  const Vec2 t = perp(n);
  const Vec2 x = base.point + 0.5 * (base.extent_begin + base.extent_end) * t; // the grip, but for its slip
  const auto motion_at_grip = [&](std::size_t row, Vec2 along) { return state.motion_at(row, x, along); };
  const Eigen::VectorXd b_t = motion_at_grip(0, t) - motion_at_grip(1, t);
  const Eigen::VectorXd b_n = motion_at_grip(0, n) - motion_at_grip(1, n);
  const Eigen::VectorXd turning = gradient_by_differences(
      state, step, [&](const Eigen::VectorXd &by) { return cross(n, state.regions_at(by).front().normal); });
  const Eigen::VectorXd across = gradient_by_differences(state, step, [&](const Eigen::VectorXd &by) {
    const RegionForce region = state.regions_at(by).front();
    const Vec2 grip = x + Vec2{motion_at_grip(0, {1.0, 0.0}).dot(by), motion_at_grip(0, {0.0, 1.0}).dot(by)};
    return dot(region.point - grip, region.normal);
  });
  const Eigen::VectorXd lean = state.gradient_of(1, t, n);
  return shear * ((state.gradient_of(0, t, n) - lean) * across.transpose() - b_n * turning.transpose() -
                  lean * b_n.transpose() - state.gradient_of(1, t, t) * b_t.transpose());
}

// The skew part is that of (R). At a corner it is 1e-8 of K, where differences end.
TEST(Tangent, SkewPartIsTheOneDerived) {
  for (const Touch touch : {Touch::face_on_face, Touch::corner_in_face}) {
    for (unsigned seed = 1; seed <= 6; ++seed) {
      for (const unsigned kinds : {0U, 1U, 2U, 3U}) {
        const Sample sample{touch, (kinds & 1U) != 0, (kinds & 2U) != 0, seed, 1e-4, 1e-4};
        Stuck stuck(sample, kernels[0]);
        const Eigen::MatrixXd k = stuck.state.contact_stiffness(3e-3 * sample.depth);
        const Eigen::MatrixXd part = remainder(stuck.state, 0.1 * sample.depth);
        const Eigen::MatrixXd derived = part - part.transpose();
        const double off = (k - k.transpose() - derived).norm() / derived.norm();
        EXPECT_LE(off, 0.05) << sample.name();
      }
    }
  }
}

/// Work of the contacts on one lap of a path about the base state, the second one, over the work in all.
double net_work(BaseState &state, double size, unsigned seed) {
  constexpr int num_steps = 400;
  std::mt19937 engine(seed);
  std::array<Eigen::VectorXd, 4> shapes;
  for (Eigen::VectorXd &shape : shapes) {
    shape.resize(state.num_unknowns());
    for (Eigen::Index k = 0; k < shape.size(); ++k) {
      shape(k) = size * uniform(engine, -1.0, 1.0);
    }
  }
  const auto at = [&](int step) -> Eigen::VectorXd {
    const double angle = 2.0 * std::numbers::pi * step / num_steps;
    return std::sin(angle) * shapes[0] + (1.0 - std::cos(angle)) * shapes[1] +
           0.5 * std::sin(2.0 * angle) * shapes[2] + 0.5 * (1.0 - std::cos(2.0 * angle)) * shapes[3];
  };
  Eigen::VectorXd force;
  for (int step = 0; step <= num_steps; ++step) {
    force = state.visit(at(step));
  }
  double net = 0.0;
  double total = 0.0;
  for (int step = 1; step <= num_steps; ++step) {
    const Eigen::VectorXd next = state.visit(at(step));
    const double work = 0.5 * (force + next).dot(at(step) - at(step - 1));
    net += work;
    total += std::abs(work);
    force = next;
  }
  return std::abs(net) / total;
}

// Where friction does not reach its cap what goes in comes out again, but for the skew part of K.
TEST(Tangent, ClosedPathsDoNoNetWork) {
  std::array<double, 6> worst{};
  for_samples(1e-4, 1e-4, 3, [&](const Sample &sample) {
    for (const Kernel &kernel : kernels) {
      Stuck stuck(sample, kernel);
      // Corners that slide past each other by their depth do not stick.
      const bool is_corner = sample.touch == Touch::corner_on_corner || sample.touch == Touch::corner_in_face;
      const double size = is_corner ? 0.15 : 2.0;
      const double net = net_work(stuck.state, size * sample.depth, sample.seed);
      stuck.state.change_memory([&](const RegionForce &, const RegionState &memory) {
        EXPECT_EQ(memory.slip, 0.0) << sample.name() << ", " << kernel.name;
      });
      EXPECT_LE(net, 2.0 * stuck.strain)
          << sample.name() << ", " << kernel.name << ", strain " << stuck.strain;
      double &most = worst[static_cast<std::size_t>(sample.touch)];
      most = std::max(most, net / stuck.strain);
    }
  });
  for (std::size_t k = 0; k < worst.size(); ++k) {
    RecordProperty(fmt::format("net_over_strain_{}", k), fmt::format("{:.3f}", worst[k]));
  }
}

} // namespace
} // namespace gcpdda::testing::tangent_test
