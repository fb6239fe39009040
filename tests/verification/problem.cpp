#include "problem.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>

namespace gcpdda::testing {

namespace {

double cpu_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// What the current test has cost so far.
struct Cost {
  double start = cpu_seconds();
  std::int64_t steps = 0;
};

class CostOfTest : public ::testing::EmptyTestEventListener {
public:
  static Cost &now() {
    static Cost cost;
    return cost;
  }
  void OnTestStart(const ::testing::TestInfo &) override { now() = {}; }
};

[[maybe_unused]] const bool listening = [] {
  ::testing::UnitTest::GetInstance()->listeners().Append(new CostOfTest); // owned by the list
  return true;
}();

std::optional<std::filesystem::path> table() {
  const char *path = std::getenv("GCPDDA_VERIFICATION_TABLE");
  return path == nullptr ? std::nullopt : std::optional<std::filesystem::path>(path);
}

std::string quoted(const std::string &text) {
  std::string out = "\"";
  for (const char c : text) {
    out += c == '"' ? std::string("\"\"") : std::string{c};
  }
  return out + "\"";
}

/// @param error  with its tolerance, as two cells; both empty where the check is a limit
void add_row(const std::string &problem, const char *relation, double expected, double got,
             const std::string &error = ",") {
  const auto path = table();
  if (!path) {
    return;
  }
  const bool is_new = !std::filesystem::exists(*path);
  std::ofstream file(*path, std::ios::app);
  if (is_new) {
    file << "problem,relation,expected,got,error,tolerance,cpu_s,steps\n";
  }
  file << fmt::format("{},{},{},{},{},{:.3f},{}\n", quoted(problem), relation, expected, got, error,
                      cpu_seconds() - CostOfTest::now().start, CostOfTest::now().steps);
  EXPECT_TRUE(file.flush()) << "cannot write " << *path;
}

void print(const std::string &line) {
  std::cout << "    " << line << std::endl;
}

} // namespace

void step(Simulation &simulation) {
  simulation.step();
  ++CostOfTest::now().steps;
}

void run_until(Simulation &simulation, double time) {
  const std::int64_t before = simulation.step_count();
  advance(simulation, time);
  CostOfTest::now().steps += simulation.step_count() - before;
  ASSERT_FALSE(simulation.fault().has_value()) << "numerical fault at t = " << simulation.time();
}

void run(Simulation &simulation) {
  run_until(simulation, simulation.plan().duration);
}

void expect_value(const std::string &problem, double expected, double got, double tolerance) {
  const double error = std::abs(got - expected) / std::abs(expected);
  print(fmt::format("{}: expected {:.10g}, got {:.10g}, error {:.2e} (<= {:.0e})", problem, expected, got,
                    error, tolerance));
  add_row(problem, "=", expected, got, fmt::format("{},{}", error, tolerance));
  EXPECT_LE(error, tolerance) << problem;
}

void expect_below(const std::string &problem, double limit, double got) {
  print(fmt::format("{}: expected <= {:.4g}, got {:.4g}", problem, limit, got));
  add_row(problem, "<=", limit, got);
  EXPECT_LE(got, limit) << problem;
}

void expect_above(const std::string &problem, double limit, double got) {
  print(fmt::format("{}: expected >= {:.4g}, got {:.4g}", problem, limit, got));
  add_row(problem, ">=", limit, got);
  EXPECT_GE(got, limit) << problem;
}

bool full_size() {
  return std::getenv("GCPDDA_VERIFICATION_FULL") != nullptr;
}

std::optional<std::filesystem::path> table_folder() {
  const auto path = table();
  return path ? std::optional(path->parent_path()) : std::nullopt;
}

} // namespace gcpdda::testing
