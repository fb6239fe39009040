// Factors of the coarse matrix against a dense factorisation.

#include "statics/coarse_factors.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

namespace gcpdda::testing::coarse_factors_test {
namespace {

/// Cells of a grid, each tied to the eight around it and to the ground by random springs.
struct Grid {
  std::size_t num_cells;
  std::vector<statics::CoarseFactors::Place> places;
  Eigen::MatrixXd matrix;
  std::vector<double> blocks;
  statics::CoarseFactors factors;

  Grid(int lines, int columns, unsigned seed)
      : num_cells(static_cast<std::size_t>(lines * columns)),
        matrix(Eigen::MatrixXd::Zero(3 * lines * columns, 3 * lines * columns)) {
    std::mt19937 random(seed);
    const auto spring = [&] {
      Eigen::Matrix<double, 3, 6> stretch;
      std::uniform_real_distribution<double> number(-1.0, 1.0);
      for (double &value : stretch.reshaped()) {
        value = number(random);
      }
      return stretch;
    };
    for (int a = 0; a < lines * columns; ++a) {
      for (int b = 0; b < a; ++b) {
        const bool are_near =
            std::abs(a / columns - b / columns) <= 1 && std::abs(a % columns - b % columns) <= 1;
        if (are_near) {
          const Eigen::Matrix<double, 3, 6> stretch = spring();
          const Eigen::Matrix<double, 6, 6> stiffness = stretch.transpose() * stretch;
          matrix.block<3, 3>(3 * a, 3 * a) += stiffness.topLeftCorner<3, 3>();
          matrix.block<3, 3>(3 * b, 3 * b) += stiffness.bottomRightCorner<3, 3>();
          matrix.block<3, 3>(3 * a, 3 * b) += stiffness.topRightCorner<3, 3>();
          matrix.block<3, 3>(3 * b, 3 * a) += stiffness.bottomLeftCorner<3, 3>();
          places.push_back({a, b});
        }
      }
      matrix.block<3, 3>(3 * a, 3 * a) += 0.1 * Eigen::Matrix3d::Identity();
      places.push_back({a, a});
    }
    take_blocks();
    factors.analyse(num_cells, places);
  }

  void take_blocks() {
    blocks.clear();
    for (const statics::CoarseFactors::Place &place : places) {
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          blocks.push_back(matrix(3 * place.higher + i, 3 * place.lower + j));
        }
      }
    }
  }

  Eigen::VectorXd random_forces(unsigned seed) const {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    Eigen::VectorXd forces(matrix.rows());
    for (double &value : forces) {
      value = number(random);
    }
    return forces;
  }

  Eigen::VectorXd solve(const Eigen::VectorXd &forces) {
    std::vector<float> motions(3 * num_cells);
    last_product = factors.solve({forces.data(), motions.size()}, motions);
    return Eigen::Map<const Eigen::VectorXf>(motions.data(), forces.size()).cast<double>();
  }
  double last_product = 0.0;

  /// Of the matrix.
  double condition() const {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
    return solver.eigenvalues().maxCoeff() / solver.eigenvalues().minCoeff();
  }
};

TEST(CoarseFactors, SolveAsADenseFactorisationDoes) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    Grid grid(6, 9, seed);
    grid.factors.factorise(grid.blocks);
    const Eigen::VectorXd forces = grid.random_forces(seed + 10);
    const Eigen::VectorXd exact = grid.matrix.ldlt().solve(forces);
    const double round_off = 1e-14 * grid.condition();
    ASSERT_LT(round_off, 1e-9);
    EXPECT_LT((grid.solve(forces) - exact).norm(), 0x1p-23 * exact.norm()); // motions of single precision
    EXPECT_NEAR(grid.last_product, forces.dot(exact), round_off * forces.dot(exact));
  }
}

// Conjugate gradients ask for one matrix for all right sides: the parallelogram law holds to the round-off of
// double precision.
TEST(CoarseFactors, AreOneMatrixForAllRightSides) {
  Grid grid(8, 8, 4);
  grid.factors.factorise(grid.blocks);
  const auto square = [&](const Eigen::VectorXd &forces) {
    grid.solve(forces);
    return grid.last_product;
  };
  const Eigen::VectorXd a = grid.random_forces(5);
  const Eigen::VectorXd b = 1e-3 * grid.random_forces(6);
  const double round_off = 1e-12; // 192 unknowns, condition of some hundred
  EXPECT_NEAR(square(a + b) + square(a - b), 2.0 * (square(a) + square(b)), round_off * square(a));
}

// One whose springs are lost in the units of far stiffer ones has no stiffness left.
TEST(CoarseFactors, LetCellsWithoutStiffnessRest) {
  Grid grid(3, 3, 7);
  constexpr int middle = 4;
  grid.matrix.middleRows<3>(3 * middle).setZero();
  grid.matrix.middleCols<3>(3 * middle).setZero();
  grid.take_blocks();
  grid.factors.factorise(grid.blocks);
  const Eigen::VectorXd forces = grid.random_forces(8);
  const Eigen::VectorXd motions = grid.solve(forces);
  EXPECT_TRUE(motions.allFinite());
  EXPECT_EQ(motions.segment<3>(3 * middle).norm(), 0.0);
  EXPECT_GT(motions.norm(), 0.0);
}

TEST(CoarseFactors, TakeAnotherPattern) {
  Grid grid(5, 4, 9);
  const Grid other(2, 7, 10);
  grid.factors.factorise(grid.blocks);
  grid.factors.analyse(other.num_cells, other.places);
  grid.factors.factorise(other.blocks);
  const Eigen::VectorXd forces = other.random_forces(11);
  std::vector<float> motions(3 * other.num_cells);
  const double product = grid.factors.solve({forces.data(), motions.size()}, motions);
  EXPECT_NEAR(product, forces.dot(other.matrix.ldlt().solve(forces)), 1e-14 * other.condition() * product);
}

} // namespace
} // namespace gcpdda::testing::coarse_factors_test
