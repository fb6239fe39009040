// The preconditioned solver against a dense factorisation of the same matrix.

#include "base/exact_sum.hpp"
#include "statics/stiffness_solver.hpp"
#include "support/blocks.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace gcpdda::testing::stiffness_solver_test {
namespace {

constexpr double k_n = 1e9;

/// A wall in running bond on a fixed floor, its joints closed by 1e-4 m.
BlockSystem wall(int rows, int columns, bool (*deforms)(std::size_t)) {
  constexpr double closed = 1e-4;
  std::vector<std::vector<Vec2>> bricks;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Vec2 low{column + 0.5 * (row % 2), 0.5 * row};
      const Vec2 high{low.x + 1.0 + closed, low.y + 0.5 + closed};
      bricks.push_back({low, {high.x, low.y}, high, {low.x, high.y}});
    }
  }
  return system_of(bricks, {{{-2.0, -1.0}, {columns + 3.0, -1.0}, {columns + 3.0, closed}, {-2.0, closed}}},
                   2600.0, deforms);
}

struct Problem {
  ContactBench bench;
  statics::ContactSprings springs;
  statics::StiffnessSolver solver{Communicator::self()};
  std::size_t width;

  Problem(BlockSystem system, double rho)
      : bench(std::move(system), one_law(k_n, 0.6)), width(bench.system.deformation.empty() ? 3 : 6) {
    bench.forces.keep_details(true);
    bench.evaluate();
    bench.evaluate();
    springs.update(bench.system, bench.candidates, bench.history, bench.forces, {});
    statics::BlockMatrices mass(bench.system.num_owned, width);
    for (std::size_t row = 0; row < bench.system.num_owned; ++row) {
      statics::add_boundary(bench.system, row, {k_n, 0.5 * k_n}, mass.of(row), width);
    }
    solver.lay(bench.system, statics::moving_rows(bench.system), std::move(mass), {});
    solver.set(bench.system, springs, rho, true);
  }

  /// K + rho D, freedom by freedom of the field: places that a rigid row leaves out get a one.
  Eigen::MatrixXd dense() {
    const std::size_t size = bench.system.num_owned * width;
    Eigen::MatrixXd matrix(size, size);
    for (std::size_t j = 0; j < size; ++j) {
      statics::LeanField p(bench.system.num_rows(), statics::lean_width(width));
      statics::LeanField y = p;
      p.of(j / width)[j % width] = 1.0F;
      solver.multiply(bench.system, springs, p, y);
      const bool is_place = j % width < statics::num_freedoms(bench.system, j / width);
      for (std::size_t i = 0; i < size; ++i) {
        matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
            is_place ? static_cast<double>(y.of(i / width)[i % width]) : 0.0;
      }
      if (!is_place) {
        matrix(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(j)) = 1.0;
      }
    }
    return matrix;
  }
};

void expect_solution_of_dense(Problem &problem) {
  const BlockSystem &system = problem.bench.system;
  const Eigen::MatrixXd matrix = problem.dense();
  EXPECT_LT((matrix - matrix.transpose()).norm(), 1e-6 * matrix.norm()); // in single precision
  EXPECT_EQ(matrix.llt().info(), Eigen::Success);
  std::mt19937 engine(3);
  statics::Field force(system.num_rows(), problem.width);
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    for (std::size_t i = 0; i < statics::num_freedoms(system, row); ++i) {
      force.of(row)[i] = uniform(engine, -1.0, 1.0);
    }
  }
  const Eigen::Map<const Eigen::VectorXd> right(force.values().data(), matrix.rows());
  const Eigen::VectorXd exact = matrix.ldlt().solve(right);
  problem.solver.accuracy = 1e-4;
  statics::Field found(system.num_rows(), problem.width);
  const std::int64_t products = problem.solver.solve(system, problem.springs, force, found);
  EXPECT_LT(products, 120);
  const Eigen::Map<const Eigen::VectorXd> solution(found.values().data(), matrix.rows());
  EXPECT_LT((solution - exact).norm(), 1e-2 * exact.norm()); // the condition is about 1e4
}

TEST(StiffnessSolver, AgreesWithADenseFactorisation) {
  Problem problem(wall(6, 8, [](std::size_t) { return false; }), 1e-3);
  expect_solution_of_dense(problem);
}

TEST(StiffnessSolver, AgreesWithADenseFactorisationOfDeformableBlocks) {
  Problem problem(wall(4, 5, [](std::size_t row) { return row % 3 != 0; }), 1e-3);
  expect_solution_of_dense(problem);
}

// In a wall whose joints stick, what damps strains is the whole of K and nothing of rho D, by the share of
// the motion that is none.
TEST(StiffnessSolver, DampsStrainsByTheirStiffnessAlone) {
  constexpr double gamma = 0.7;
  constexpr double rho = 0.1;
  for (const auto deforms :
       {+[](std::size_t) { return false; }, +[](std::size_t row) { return row % 3 != 0; }}) {
    Problem light(wall(4, 5, deforms), 0.0);
    Problem problem(wall(4, 5, deforms), rho);
    BlockSystem &system = problem.bench.system;
    std::mt19937 engine(5);
    statics::LeanField velocity(system.num_rows(), statics::lean_width(problem.width));
    for (std::size_t row = 0; row < system.num_owned; ++row) {
      for (std::size_t i = 0; i < statics::num_freedoms(system, row); ++i) {
        velocity.of(row)[i] = static_cast<float>(uniform(engine, -1.0, 1.0));
        pseudo_rows(system)[row].velocity[i] = velocity.of(row)[i];
      }
    }
    statics::LeanField product(system.num_rows(), velocity.width());
    light.solver.multiply(light.bench.system, light.springs, velocity, product);
    double strained = 0.0;
    double largest = 0.0;
    for (std::size_t i = 0; i < system.num_owned * product.width(); ++i) {
      strained += static_cast<double>(product.values()[i]) * static_cast<double>(velocity.values()[i]);
      largest = std::max(largest, std::abs(static_cast<double>(product.values()[i])));
    }
    for (const double share : {0.0, 0.25, 0.97, 1.5}) {
      statics::Field force(system.num_rows(), problem.width);
      const double momentum = share > 0.0 ? strained / share : 1e300;
      problem.solver.damp_strains(system, problem.springs, gamma, momentum, force);
      const double expected = gamma * std::max(0.0, 1.0 - share);
      for (std::size_t row = 0; row < system.num_owned; ++row) {
        for (std::size_t i = 0; i < problem.width; ++i) {
          const double of_product = product.of(row)[i];
          EXPECT_NEAR(force.of(row)[i], -expected * of_product, 1e-6 * largest); // in single precision
        }
      }
    }
  }
}

// Each number is rounded to 2^-45 of the size at most. Sums of parts are the sum of all, as on several ranks.
TEST(SumInUnits, IsTheSumToTheLastBitButForItsRounding) {
  constexpr std::size_t num_rows = 1000;
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> numbers(-1.0, 1.0);
  std::vector<double> products(num_rows);
  ExactSum exactly;
  for (double &product : products) {
    product = 1e12 * numbers(engine) * numbers(engine) + 1e6;
    exactly.add(product);
  }
  const double exact = exactly.value();
  for (const double size : {std::abs(exact), 0.3 * std::abs(exact), 1e3 * std::abs(exact)}) {
    statics::SumInUnits all(size);
    statics::SumInUnits first(size);
    statics::SumInUnits others(size);
    for (std::size_t k = 0; k < num_rows; ++k) {
      all.add(products[k]);
      (k < 137 ? first : others).add(products[k]);
    }
    EXPECT_NEAR(all.value(all.units()), exact, num_rows * std::ldexp(size, -45)) << size;
    EXPECT_EQ(first.units() + others.units(), all.units());
  }
}

// The coarse level carries what spans the pile: without its cells the number of products grows with the
// height of a column, and with them hardly.
TEST(StiffnessSolver, ProductsHardlyGrowWithTheHeight) {
  const auto products_of = [](int height) {
    Problem problem(wall(height, 4, [](std::size_t) { return false; }), 1e-3);
    const BlockSystem &system = problem.bench.system;
    statics::Field force(system.num_rows(), 3);
    for (std::size_t row = 0; row < system.num_owned; ++row) {
      force.of(row)[1] = -1.0;
    }
    statics::Field found(system.num_rows(), 3);
    return problem.solver.solve(system, problem.springs, force, found);
  };
  EXPECT_LE(products_of(80), 3 * products_of(10));
}

} // namespace
} // namespace gcpdda::testing::stiffness_solver_test
