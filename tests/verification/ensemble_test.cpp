// Probability of failure of the plane failure of run/scenes/plane_failure.toml whose strengths are drawn at
// random, against the closed form of each member and of all of them.

#include "problem.hpp"

#include "driver/ensemble.hpp"
#include "gcpdda/io/scene_reader.hpp"
#include "io/results/ensemble_report.hpp"
#include "support/run_facts.hpp"
#include "support/temporary_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace gcpdda::testing::ensemble_test {
namespace {

constexpr double half_factor = 3188.25; // Pa of cohesion that add 0.5

double factor_of(double friction_deg, double cohesion) {
  return std::tan(friction_deg * degree) / std::tan(30.0 * degree) + 0.5 * cohesion / half_factor;
}

/// The factor is below 1 where the friction angle is below one that falls with the cohesion: the share of
/// that in the friction's distribution, averaged over that of the cohesion by the midpoint rule.
double exact_probability(const Ensemble &ensemble) {
  const Variation &friction = ensemble.variations[0];
  const auto normal = [&](double x) { return normal_probability((x - friction.mean) / friction.deviation); };
  constexpr int slices = 4000;
  double sum = 0.0;
  for (int k = 0; k < slices; ++k) {
    const double cohesion = ensemble.variations[1].quantile((k + 0.5) / slices);
    const double tangent = std::tan(30.0 * degree) * (1.0 - 0.5 * cohesion / half_factor);
    const double angle = std::clamp(std::atan(tangent) / degree, friction.min, friction.max);
    sum += (normal(angle) - normal(friction.min)) / friction.share_within();
  }
  return sum / slices;
}

struct Found {
  Ensemble ensemble;
  std::vector<EnsembleMember> members;
  std::string json;
  int exit_code = 0;

  explicit Found(const std::vector<std::string> &sets) {
    const TemporaryFolder temporary;
    const std::string folder = temporary.path().string();
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    const Scene scene = shipped_scene("plane_failure", sets);
    ensemble = scene.ensemble;
    const auto member_scene = [&](const Communicator & /*alone*/, const std::vector<double> &values) {
      std::vector<std::string> with = sets;
      for (std::size_t i = 0; i < values.size(); ++i) {
        with.push_back(assignment(ensemble.variations[i], values[i]));
      }
      return shipped_scene("plane_failure", with);
    };
    exit_code = run_ensemble(Communicator::self(), scene, member_scene, {folder + "/e", false, "text"});
    ::testing::internal::GetCapturedStderr();
    ::testing::internal::GetCapturedStdout();
    const std::vector<std::string> lines = lines_of(file_text(folder + "/e/ensemble_members.csv"));
    for (std::size_t k = 1; k < lines.size(); ++k) {
      members.push_back(member_of(lines[k], 2, false).value());
    }
    for (const char *key : {"probability_of_failure", "low", "high"}) {
      json += json_value(folder + "/e/ensemble.json", key) + " ";
    }
  }
};

// A member within 1 % of the limit slides so slowly that its limit of time could end first. The share that
// fails lies within three standard errors of the closed form for 997 seeds in 1,000.
TEST(Ensemble, ProbabilityOfPlaneFailure) {
  const Found found({"ensemble.count=30"});
  EXPECT_EQ(found.exit_code, 0);
  ASSERT_EQ(found.members.size(), 30U);
  double fails = 0.0;
  for (const EnsembleMember &member : found.members) {
    const double exact = factor_of(member.values[0], member.values[1]);
    fails += member.outcome == MemberOutcome::fails ? 1.0 : 0.0;
    if (std::abs(exact - 1.0) > 0.01) {
      EXPECT_EQ(word_of(member.outcome), word_of(exact < 1.0 ? MemberOutcome::fails : MemberOutcome::holds))
          << "factor " << exact;
    }
  }
  const double exact = exact_probability(found.ensemble);
  const double error = std::sqrt(exact * (1.0 - exact) / 30.0);
  expect_value("probability of plane failure, strengths drawn 30 times", exact, fails / 30.0,
               3.0 * error / exact);
}

// The bracket is 3 % wide, and 1 % beyond it a block slides so slowly that its limit could end first. Members
// that fail with their own strength have a factor too.
TEST(Ensemble, FactorsOfItsMembers) {
  const Found found(
      {"ensemble.count=4", "ensemble.measure=factor", "fos.tolerance=0.03", "fos.to=2.0", "fos.from=0.7"});
  EXPECT_EQ(found.exit_code, 0);
  ASSERT_EQ(found.members.size(), 4U);
  double largest = 0.0;
  double least = 2.0;
  for (const EnsembleMember &member : found.members) {
    const double exact = factor_of(member.values[0], member.values[1]);
    ASSERT_TRUE(member.factor()) << member.message;
    largest = std::max(largest, std::abs(*member.factor() / exact - 1.0));
    least = std::min(least, *member.factor());
  }
  EXPECT_LT(least, 1.0) << "one of them is to fail with its own strength";
  expect_below("factors of safety of an ensemble: largest error", 0.025, largest);
}

} // namespace
} // namespace gcpdda::testing::ensemble_test
