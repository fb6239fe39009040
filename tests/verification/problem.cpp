#include "problem.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

namespace gcpdda::testing {

namespace {

void print(const std::string &line) {
  std::cout << "    " << line << std::endl;
}

} // namespace

void run_until(Simulation &simulation, double time) {
  advance(simulation, time);
  ASSERT_FALSE(simulation.fault().has_value()) << "numerical fault at t = " << simulation.time();
}

void run(Simulation &simulation) {
  run_until(simulation, simulation.plan().duration);
}

void expect_value(const std::string &problem, double expected, double got, double tolerance) {
  const double error = std::abs(got - expected) / std::abs(expected);
  print(fmt::format("{}: expected {:.10g}, got {:.10g}, error {:.2e} (<= {:.0e})", problem, expected, got,
                    error, tolerance));
  EXPECT_LE(error, tolerance) << problem;
}

void expect_below(const std::string &problem, double limit, double got) {
  print(fmt::format("{}: expected <= {:.4g}, got {:.4g}", problem, limit, got));
  EXPECT_LE(got, limit) << problem;
}

void expect_above(const std::string &problem, double limit, double got) {
  print(fmt::format("{}: expected >= {:.4g}, got {:.4g}", problem, limit, got));
  EXPECT_GE(got, limit) << problem;
}

} // namespace gcpdda::testing
