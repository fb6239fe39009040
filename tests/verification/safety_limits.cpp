#include "safety_limits.hpp"

#include "driver/safety_search.hpp"
#include "support/temporary_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>

namespace gcpdda::testing {

SafetyOutcome search_quietly(const Scene &scene, bool only_bound) {
  const TemporaryFolder folder;
  SafetyOptions options;
  options.directory = folder.path() / "fos";
  options.quiet = true;
  options.only_bound = only_bound;
  return search_safety_factor(Communicator::self(), scene, options);
}

namespace {

Scene with_solver(Scene scene, Solver solver) {
  scene = with_settle_stage(std::move(scene));
  for (Stage &stage : scene.stages) {
    if (stage.kind == StageKind::settle) {
      stage.solver = solver;
    }
  }
  return scene;
}

void add_row(const KnownLimit &limit, const char *solver, const SafetyOutcome &found) {
  const auto folder = table_folder();
  if (!folder) {
    return;
  }
  const std::vector<StrengthTrial> &trials = found.report.trials;
  const auto decided_by = [&](const char *means) {
    return std::count_if(trials.begin(), trials.end(),
                         [&](const StrengthTrial &trial) { return trial.decided_by == means; });
  };
  const auto evaluations =
      std::accumulate(trials.begin(), trials.end(), std::int64_t{0},
                      [](std::int64_t sum, const StrengthTrial &trial) { return sum + trial.evaluations; });
  const std::filesystem::path path = *folder / "safety_limits.csv";
  const bool is_new = !std::filesystem::exists(path);
  std::ofstream file(path, std::ios::app);
  if (is_new) {
    file << "problem,half,solver,known,holds,fails,error,exit_code,trials,evaluations,by_static_and_step,"
            "by_step,by_undamped_step,undecided\n";
  }
  const double holds = found.report.holds.value_or(0.0);
  const double fails = found.report.fails.value_or(0.0);
  file << fmt::format("\"{}\",{},{},{},{},{},{},{},{},{},{},{},{},{}\n", limit.problem,
                      limit.half == Half::tuned ? "tuned" : "untouched", solver, limit.factor, holds, fails,
                      std::abs(0.5 * (holds + fails) / limit.factor - 1.0), found.exit_code, trials.size(),
                      evaluations, decided_by("static solver and dynamic step"), decided_by("dynamic step"),
                      decided_by("dynamic step without damping"), decided_by(""));
}

} // namespace

void expect_factor(const KnownLimit &limit, const Scene &scene) {
  double bound = scene.reduction.to;
  if (limit.bound_tolerance > 0.0) {
    const SafetyOutcome found = search_quietly(with_solver(scene, Solver::dynamic), true);
    ASSERT_TRUE(found.report.bound) << limit.problem;
    bound = *found.report.bound;
    expect_value("upper bound by limit analysis, " + limit.problem, limit.factor, bound,
                 limit.bound_tolerance);
  }
  for (const Solver solver : {Solver::dynamic, Solver::statics}) {
    const char *word = solver == Solver::statics ? "static" : "dynamic";
    const SafetyOutcome found = search_quietly(with_solver(scene, solver));
    const std::string name = fmt::format("factor of safety, {}, {} trials", limit.problem, word);
    add_row(limit, word, found);
    EXPECT_EQ(found.exit_code, exit_code::done) << name << ": " << found.message;
    EXPECT_TRUE(found.report.undecided.empty()) << name;
    if (solver == Solver::statics) {
      for (const StrengthTrial &trial : found.report.trials) {
        EXPECT_TRUE(trial.decided_by.starts_with("static solver"))
            << name << ": " << trial.factor << " was left to motion, which takes many times as long";
      }
    }
    ASSERT_TRUE(found.report.holds && found.report.fails) << name;
    EXPECT_LE(*found.report.holds, bound) << name;
    expect_value(name, limit.factor, 0.5 * (*found.report.holds + *found.report.fails), limit.tolerance);
  }
}

void expect_factor(const KnownLimit &limit, const std::string &toml) {
  expect_factor(limit, scene_of(without_duration(toml) + "[[stage]]\nkind = \"settle\"\nlimit = 10.0\n"));
}

} // namespace gcpdda::testing
