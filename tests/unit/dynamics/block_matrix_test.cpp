// The block's own system: its factorisation against known solutions, its entries against integrals over the
// block.

#include "dynamics/block_matrix.hpp"

#include "dynamics/deformable.hpp"

#include <Eigen/Core>
#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace gcpdda::block_matrix_test {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

using Matrix6 = Eigen::Matrix<double, 6, 6>;

double next(std::mt19937 &engine) {
  return -1.0 + 2.0 * static_cast<double>(engine()) / 4294967296.0;
}

/// Of a solution chosen at random, in the size that the rows of the matrix give its unknowns.
template <std::size_t N> double worst_error(double spread, unsigned seed) {
  constexpr auto n = static_cast<int>(N);
  using Matrix = Eigen::Matrix<double, n, n>;
  using Vector = Eigen::Matrix<double, n, 1>;
  std::mt19937 engine(seed);
  double worst = 0.0;
  for (int trial = 0; trial < 100; ++trial) {
    Matrix root;
    for (double &entry : root.reshaped()) {
      entry = next(engine);
    }
    // Rows of very different size: the mass of a small block beside the stiffness of a stiff one.
    for (int i = 0; i < n; ++i) {
      root.row(i) *= std::pow(spread, static_cast<double>(i) / n);
    }
    const Matrix matrix = root * root.transpose() + 0.1 * Matrix(root.rowwise().squaredNorm().asDiagonal());
    std::array<double, 21> lower{};
    std::array<double, N> rhs{};
    const Vector exact =
        Vector::NullaryExpr([&](Eigen::Index i) { return next(engine) / root.row(i).norm(); });
    const Vector b = matrix * exact;
    for (std::size_t i = 0; i < N; ++i) {
      rhs[i] = b[static_cast<int>(i)];
      for (std::size_t j = 0; j <= i; ++j) {
        lower[packed(i, j)] = matrix(static_cast<int>(i), static_cast<int>(j));
      }
    }
    const std::array<double, N> x = solve<N>(factorise<N>(lower), rhs);
    for (std::size_t i = 0; i < N; ++i) {
      const auto k = static_cast<int>(i);
      worst = std::max(worst, std::abs(x[i] - exact[k]) * root.row(k).norm());
    }
  }
  return worst;
}

// Scaled condition about n/0.1; some tens of roundings.
TEST(BlockMatrix, FindsKnownSolutions) {
  for (const double spread : {1.0, 1e3, 1e6}) {
    EXPECT_LE(worst_error<3>(spread, 1), 1e4 * epsilon) << spread;
    EXPECT_LE(worst_error<6>(spread, 2), 1e4 * epsilon) << spread;
  }
}

/// Columns of T X: u, v, r, eps_x, eps_y, gamma_xy.
Eigen::Matrix<double, 2, 6> columns_at(Vec2 x) {
  Eigen::Matrix<double, 2, 6> t;
  t << 1.0, 0.0, -x.y, x.x, 0.0, 0.5 * x.y, //
      0.0, 1.0, x.x, 0.0, x.y, 0.5 * x.x;
  return t;
}

/// rho int T^T T dA over the triangles between the centroid and each edge: the three middles of a triangle's
/// sides integrate a quadratic exactly.
Matrix6 integrated_mass(std::span<const Vec2> vertices, double density) {
  Matrix6 mass = Matrix6::Zero();
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const Vec2 a = vertices[k];
    const Vec2 b = vertices[(k + 1) % vertices.size()];
    for (const Vec2 middle : {0.5 * a, 0.5 * b, 0.5 * (a + b)}) {
      mass += density * 0.5 * cross(a, b) / 3.0 * columns_at(middle).transpose() * columns_at(middle);
    }
  }
  return mass;
}

Matrix6 multiplied_out(const BlockMatrix &factors, Eigen::Index n) {
  Matrix6 lower = Matrix6::Identity();
  Matrix6 diagonal = Matrix6::Zero();
  for (Eigen::Index i = 0; i < n; ++i) {
    diagonal(i, i) = 1.0 / factors.factor[packed(static_cast<std::size_t>(i), static_cast<std::size_t>(i))];
    for (Eigen::Index j = 0; j < i; ++j) {
      lower(i, j) = factors.factor[packed(static_cast<std::size_t>(i), static_cast<std::size_t>(j))];
    }
  }
  return lower * diagonal * lower.transpose();
}

// A lopsided quadrangle with an anchor off its axes: no entry of M, K or the anchor's matrix vanishes.
TEST(BlockMatrix, HoldsMassElasticityAndAnchors) {
  constexpr double density = 2600.0;
  constexpr double modulus = 3e8;
  constexpr double ratio = 0.3;
  constexpr double time_step = 2e-3;
  constexpr double normal_stiffness = 1e9;
  const Scheme scheme = make_scheme(SchemeKind::generalized_alpha, 0.8, ContactTime::leapfrog);
  for (const bool deformable : {false, true}) {
    for (const Elasticity elasticity : {Elasticity::implicit, Elasticity::explicit_}) {
      SceneBlock block;
      block.vertices = {{0.0, 0.0}, {3.0, 0.5}, {2.0, 2.0}, {-0.5, 1.0}};
      block.fixed_points = {{1.7, 0.4}};
      BlockSystem system;
      append_block(system, BlockId{0}, block, {"rock", density, modulus, ratio},
                   deformable ? BlockKind::deformable : BlockKind::rigid, false);
      make_block_matrices(system, scheme, time_step, elasticity, normal_stiffness);
      ASSERT_TRUE(system.has_matrix(0));

      const double area = system.properties[0].area;
      Eigen::Matrix3d plane_stress;
      plane_stress << 1.0, ratio, 0.0, ratio, 1.0, 0.0, 0.0, 0.0, 0.5 * (1.0 - ratio);
      plane_stress *= modulus / (1.0 - ratio * ratio);
      const double coming = (1.0 - scheme.alpha_f) * scheme.beta * time_step * time_step;
      const double anchor =
          100.0 * std::max(normal_stiffness * std::sqrt(area), deformable ? plane_stress(0, 0) : 0.0);
      EXPECT_NEAR(system.anchor[0].stiffness, anchor, 1e-14 * anchor);
      Matrix6 expected =
          (1.0 - scheme.alpha_m) * integrated_mass(system.of_row(system.reference_vertex, 0), density);
      if (elasticity == Elasticity::implicit) {
        expected.bottomRightCorner<3, 3>() += coming * area * plane_stress;
      }
      const auto at = columns_at(system.anchor[0].point);
      expected += coming * anchor * at.transpose() * at;
      const Eigen::Index n = deformable ? 6 : 3;
      const Matrix6 found = multiplied_out(system.matrix[0], n);
      for (Eigen::Index i = 0; i < n; ++i) {
        for (Eigen::Index j = 0; j < n; ++j) {
          const double size = std::sqrt(expected(i, i) * expected(j, j));
          EXPECT_NEAR(found(i, j), expected(i, j), 64.0 * epsilon * size) << i << " " << j;
        }
      }
    }
  }
}

// Who needs none has none.
TEST(BlockMatrix, IsForBlocksThatAreHeld) {
  BlockSystem system;
  SceneBlock block;
  block.vertices = {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}};
  const Material rock{"rock", 2000.0, 1e9, 0.2};
  append_block(system, BlockId{0}, block, rock, BlockKind::rigid);
  append_block(system, BlockId{1}, block, rock, BlockKind::deformable);
  block.fixed_points = {{0.1, 0.1}};
  append_block(system, BlockId{2}, block, rock, BlockKind::rigid);
  block.driven = true;
  append_block(system, BlockId{3}, block, rock, BlockKind::rigid);
  block.driven = false;
  append_block(system, BlockId{4}, block, rock, BlockKind::deformable);
  block.fixed = true;
  append_block(system, BlockId{5}, block, rock, BlockKind::fixed);
  const Scheme scheme = make_scheme(SchemeKind::generalized_alpha, 0.8, ContactTime::leapfrog);
  for (int again = 0; again < 2; ++again) {
    make_block_matrices(system, scheme, 1e-3, Elasticity::implicit, 1e9);
    const std::vector<std::uint32_t> begin{0, 0, 0, 1, 1, 2, 2};
    for (std::size_t row = 0; row < begin.size(); ++row) {
      EXPECT_EQ(system.matrix_begin[row], begin[row]);
    }
    EXPECT_EQ(system.matrix.size(), 2U);
  }
}

} // namespace
} // namespace gcpdda::block_matrix_test
