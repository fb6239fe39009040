// What members draw, what is said of [ensemble], and what all members together say.

#include "driver/histogram.hpp"
#include "gcpdda/model/ensemble.hpp"
#include "io/results/ensemble_report.hpp"
#include "unit/scene_texts.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gcpdda::ensemble_test {
namespace {

using namespace testing;

constexpr std::int64_t num_draws = 20000;

Variation variation_of(Distribution distribution) {
  Variation variation;
  variation.distribution = distribution;
  variation.mean = 4.0;
  variation.deviation = 1.5;
  if (distribution == Distribution::uniform || distribution == Distribution::triangular) {
    variation.min = 2.0;
    variation.max = 9.0;
    variation.mode = 3.0;
  }
  return variation;
}

Ensemble ensemble_of(std::vector<Variation> variations) {
  Ensemble ensemble;
  ensemble.count = num_draws;
  ensemble.seed = 11;
  ensemble.variations = std::move(variations);
  return ensemble;
}

std::vector<double> drawn(const Ensemble &ensemble, std::size_t value) {
  std::vector<double> values;
  for (std::int64_t member = 0; member < num_draws; ++member) {
    values.push_back(sample(ensemble, member)[value]);
  }
  return values;
}

/// Largest distance of the sample's distribution function from the one it should have; above 1.95/sqrt(n) for
/// one sample in a thousand (Kolmogorov).
template <class Probability> double distance(std::vector<double> values, Probability &&probability) {
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  double farthest = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double p = probability(values[i]);
    const auto k = static_cast<double>(i);
    farthest = std::max({farthest, p - k / n, (k + 1.0) / n - p});
  }
  return farthest;
}
const double farthest_allowed = 1.95 / std::sqrt(static_cast<double>(num_draws));

double phi(double x) {
  return 0.5 * std::erfc(-x / std::sqrt(2.0));
}

TEST(Statistics, NormalQuantileIsTheInverse) {
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-14); // tables
  EXPECT_NEAR(normal_quantile(0.5), 0.0, 1e-16);
  for (const double p : {1e-16, 1e-9, 1e-3, 0.02, 0.3, 0.7, 0.999, 1.0 - 1e-9}) {
    EXPECT_NEAR(normal_probability(normal_quantile(p)) / p, 1.0, 1e-13) << p;
  }
}

TEST(Statistics, IntervalOfAProbability) {
  const Interval none = probability_interval(0, 50, 0.95);
  EXPECT_EQ(none.low, 0.0);
  EXPECT_NEAR(none.high, 1.0 - std::pow(0.025, 1.0 / 50.0), 1e-13) << "(1 - p)^50 = 0.025";
  const Interval all = probability_interval(50, 50, 0.95);
  EXPECT_NEAR(all.low, 1.0 - none.high, 1e-13);
  EXPECT_EQ(all.high, 1.0);
  const Interval tenth = probability_interval(10, 100, 0.95); // tables
  EXPECT_NEAR(tenth.low, 0.0490, 5e-5);
  EXPECT_NEAR(tenth.high, 0.1762, 5e-5);
}

// The promise of the interval, summed over all that may be seen.
TEST(Statistics, IntervalHoldsTheProbabilityAsOftenAsItSays) {
  constexpr std::int64_t trials = 30;
  for (const double p : {0.01, 0.1, 0.35, 0.5, 0.9}) {
    double covered = 0.0;
    double chance = std::pow(1.0 - p, trials);
    for (std::int64_t seen = 0; seen <= trials; ++seen) {
      const Interval interval = probability_interval(seen, trials, 0.95);
      covered += interval.low <= p && p <= interval.high ? chance : 0.0;
      chance *= static_cast<double>(trials - seen) / static_cast<double>(seen + 1) * p / (1.0 - p);
    }
    EXPECT_GE(covered, 0.95) << p;
  }
}

TEST(Statistics, MomentsOfASample) {
  const std::vector<double> values{1.0, 2.0, 3.0, 10.0};
  const SampleMoments moments = sample_moments(values);
  EXPECT_DOUBLE_EQ(moments.mean, 4.0);
  EXPECT_DOUBLE_EQ(moments.deviation, std::sqrt(50.0 / 3.0));
  EXPECT_DOUBLE_EQ(moments.standard_error(), std::sqrt(50.0 / 12.0));
  EXPECT_DOUBLE_EQ(moments.skewness,
                   4.0 * (-27.0 - 8.0 - 1.0 + 216.0) / (3.0 * 2.0 * std::pow(50.0 / 3.0, 1.5)));
  EXPECT_EQ(moments.least, 1.0);
  EXPECT_EQ(moments.most, 10.0);
}

TEST(EnsembleSampling, FollowsItsDistributions) {
  const double log_variance = std::log1p(1.5 * 1.5 / 16.0);
  const double log_mean = std::log(4.0) - 0.5 * log_variance;
  Variation cut = variation_of(Distribution::normal);
  cut.min = 3.0;
  cut.max = 4.5;
  const Ensemble ensemble =
      ensemble_of({variation_of(Distribution::normal), variation_of(Distribution::lognormal),
                   variation_of(Distribution::uniform), variation_of(Distribution::triangular), cut});
  const auto normal = [](double x) { return phi((x - 4.0) / 1.5); };
  EXPECT_LT(distance(drawn(ensemble, 0), normal), farthest_allowed);
  EXPECT_LT(distance(drawn(ensemble, 1),
                     [&](double x) { return phi((std::log(x) - log_mean) / std::sqrt(log_variance)); }),
            farthest_allowed);
  EXPECT_LT(distance(drawn(ensemble, 2), [](double x) { return (x - 2.0) / 7.0; }), farthest_allowed);
  EXPECT_LT(distance(drawn(ensemble, 3),
                     [](double x) {
                       return x < 3.0 ? (x - 2.0) * (x - 2.0) / 7.0 : 1.0 - (9.0 - x) * (9.0 - x) / 42.0;
                     }),
            farthest_allowed);
  const auto within = [&](double x) { return (normal(x) - normal(3.0)) / (normal(4.5) - normal(3.0)); };
  EXPECT_LT(distance(drawn(ensemble, 4), within), farthest_allowed);
  for (const std::size_t value : {0U, 1U}) { // four standard errors
    const SampleMoments moments = sample_moments(drawn(ensemble, value));
    EXPECT_NEAR(moments.mean, 4.0, 4.0 * 1.5 / std::sqrt(static_cast<double>(num_draws)));
    EXPECT_NEAR(moments.deviation, 1.5, value == 0 ? 0.03 : 0.06) << "the lognormal has a long tail";
  }
}

TEST(EnsembleSampling, SeedsAreWholeAndDiffer) {
  const Ensemble ensemble = ensemble_of({variation_of(Distribution::seed)});
  std::vector<double> seeds = drawn(ensemble, 0);
  for (const double seed : seeds) {
    ASSERT_EQ(seed, std::floor(seed));
    ASSERT_GE(seed, 0.0);
  }
  std::sort(seeds.begin(), seeds.end());
  EXPECT_LE(seeds.end() - std::unique(seeds.begin(), seeds.end()), 5)
      << "of 2e8 pairs and 1e9 seeds 0.2 meet";
}

double correlation(const std::vector<double> &a, const std::vector<double> &b) {
  const SampleMoments of_a = sample_moments(a);
  const SampleMoments of_b = sample_moments(b);
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += (a[i] - of_a.mean) * (b[i] - of_b.mean);
  }
  return sum / (static_cast<double>(a.size() - 1) * of_a.deviation * of_b.deviation);
}

// Standard error of a correlation r is (1 - r^2)/sqrt(n): 0.005 here.
TEST(EnsembleSampling, CorrelatesNormalsAsToldAndLeavesEachAsItIs) {
  Ensemble ensemble = ensemble_of({variation_of(Distribution::normal), variation_of(Distribution::uniform),
                                   variation_of(Distribution::normal)});
  ensemble.correlation_factor = lower_factor({1.0, 0.0, -0.5, 0.0, 1.0, 0.3, -0.5, 0.3, 1.0}, 3);
  ASSERT_FALSE(ensemble.correlation_factor.empty());
  const std::vector<double> a = drawn(ensemble, 0);
  const std::vector<double> b = drawn(ensemble, 1);
  const std::vector<double> c = drawn(ensemble, 2);
  EXPECT_NEAR(correlation(a, b), 0.0, 0.03);
  EXPECT_NEAR(correlation(a, c), -0.5, 0.025);
  // Of a uniform and a normal value sqrt(3/pi) of that of the normal ones.
  EXPECT_NEAR(correlation(b, c), 0.3 * std::sqrt(3.0 / std::acos(-1.0)), 0.03);
  EXPECT_LT(distance(c, [](double x) { return phi((x - 4.0) / 1.5); }), farthest_allowed);
  EXPECT_TRUE(lower_factor({1.0, 0.9, -0.9, 0.9, 1.0, 0.9, -0.9, 0.9, 1.0}, 3).empty());
}

TEST(EnsembleSampling, MemberIsTheSameWhateverElseThereIs) {
  Ensemble ensemble = ensemble_of({variation_of(Distribution::normal), variation_of(Distribution::uniform)});
  const std::vector<double> member = sample(ensemble, 7);
  ensemble.count = 8;
  EXPECT_EQ(sample(ensemble, 7), member);
  ensemble.variations.push_back(variation_of(Distribution::lognormal));
  EXPECT_EQ(sample(ensemble, 7)[0], member[0]);
  EXPECT_EQ(sample(ensemble, 7)[1], member[1]);
  EXPECT_NE(sample(ensemble, 8)[0], member[0]);
  ensemble.seed = 12;
  EXPECT_NE(sample(ensemble, 7)[0], member[0]);
}

const std::string ensemble_text = small_scene + R"([ensemble]
count = 20
measure = "verdict"
[[ensemble.vary]]
key = "joint.default.friction_angle_deg"
distribution = "normal"
mean = 35
deviation = 3
min = 20
[[ensemble.vary]]
key = "joint.default.cohesion"
distribution = "lognormal"
mean = 1e4
deviation = 3e3
[[ensemble.correlation]]
keys = ["joint.default.cohesion", "joint.default.friction_angle_deg"]
coefficient = -0.5
)";

TEST(EnsembleScene, IsReadAndReadAgain) {
  const Scene scene = good(ensemble_text);
  const Ensemble &ensemble = scene.ensemble;
  EXPECT_EQ(ensemble.count, 20);
  EXPECT_EQ(ensemble.seed, 0);
  EXPECT_EQ(ensemble.measure, Measure::verdict);
  ASSERT_EQ(ensemble.variations.size(), 2U);
  EXPECT_EQ(ensemble.variations[0].key, "joint.default.friction_angle_deg");
  EXPECT_EQ(ensemble.variations[0].min, 20.0);
  EXPECT_EQ(ensemble.variations[1].distribution, Distribution::lognormal);
  EXPECT_EQ(ensemble.correlation_factor, (std::vector<double>{1.0, 0.0, -0.5, std::sqrt(0.75)}));
  EXPECT_EQ(sample(good(scene.resolved).ensemble, 5), sample(ensemble, 5));
  EXPECT_EQ(good(small_scene).ensemble.count, 0);
  EXPECT_EQ(assignment(ensemble.variations[0], 0.1), "joint.default.friction_angle_deg=0.1");
}

TEST(EnsembleScene, FaultsAreToldAllAtOnce) {
  const std::string text = small_scene + R"([ensemble]
count = 20
measure = "verdict"
[[ensemble.vary]]
key = "joint.defalt.cohesion"
distribution = "normal"
mean = 35
[[ensemble.vary]]
key = "fos.limit"
distribution = "uniform"
mean = 35
min = 2
max = 1
[[ensemble.vary]]
key = "run.safety"
distribution = "triangular"
min = 0.1
max = 0.2
mode = 0.3
[[ensemble.vary]]
key = "run.safety"
distribution = "normal"
mean = 1
deviation = 0.01
min = 5
[[ensemble.correlation]]
keys = ["run.safety", "run.saftey"]
coefficient = 0.5
)";
  const std::vector<std::string> expected{
      "s.toml:14:1: error: 'deviation' in vary 0 of [ensemble] is missing, a normal distribution needs it, "
      "for "
      "example deviation = 2.0",
      "s.toml:15:7: error: no joint is named 'defalt', did you mean 'default'?",
      "s.toml:19:7: error: 'fos.limit' cannot vary, it says how members are compared, for example key = "
      "\"joint.default.friction_angle_deg\"",
      "s.toml:21:8: error: 'mean' in vary 1 of [ensemble] has no meaning, the distribution is uniform, leave "
      "it "
      "out",
      "s.toml:23:7: error: 'max' in vary 1 of [ensemble] is 1 and min is 2, values lie between them, use a "
      "larger "
      "max",
      "s.toml:29:8: error: 'mode' in vary 2 of [ensemble] is 0.3, it lies between min and max, move it there",
      "s.toml:31:7: error: 'run.safety' varies twice, it has one value in each member, leave one of them out",
      "s.toml:32:16: error: vary 3 of [ensemble] has almost nothing between min and max, only 0 of the "
      "distribution lies there, move mean, min or max",
      "s.toml:37:23: error: 'run.saftey' does not vary, a correlation is one of two values that do, did you "
      "mean "
      "'run.safety'?"};
  EXPECT_EQ(messages(read_scene(text, "s.toml", {})), expected);
}

// What only a scene with another value shows.
TEST(EnsembleScene, MedianOfEachValueMakesAScene) {
  const std::string text = small_scene + R"([ensemble]
count = 20
[[ensemble.vary]]
key = "material.granite.densty"
distribution = "uniform"
min = 2000
max = 3000
[[ensemble.vary]]
key = "block.slider.name"
distribution = "seed"
[[ensemble.vary]]
key = "joint.default.friction_angle_deg"
distribution = "normal"
mean = 95
deviation = 2
)";
  const std::vector<std::string> told = messages(read_scene(text, "s.toml", {}));
  ASSERT_EQ(told.size(), 3U);
  EXPECT_EQ(told[0], "s.toml:14:7: error: 'material.granite.densty' cannot vary: unknown key 'densty' in "
                     "[material.granite], did you mean 'density'?");
  EXPECT_EQ(told[1].find("s.toml:19:7: error: 'block.slider.name' cannot vary: 'name' in block"), 0U)
      << told[1];
  EXPECT_EQ(told[2],
            "s.toml:22:7: error: 'joint.default.friction_angle_deg' cannot vary: 'friction_angle_deg' "
            "in [joint.default] is 95, it must be at least 0 and below 90, for example "
            "friction_angle_deg = 35.0");
}

TEST(EnsembleScene, DisplacementIsLimitedWhereTheGroundShakes) {
  const std::string what = "error: 'largest_displacement' in [ensemble] has no meaning, ";
  const auto told = [](const std::string &measure) {
    const std::vector<std::string> messages_told =
        messages(read_scene(ensemble_text, "s.toml",
                            {"ensemble.measure=\"" + measure + "\"", "ensemble.largest_displacement=0.1"}));
    return messages_told.empty() ? std::string() : messages_told.front();
  };
  EXPECT_NE(told("verdict").find(what + "the scene has no [earthquake]"), std::string::npos)
      << told("verdict");
  EXPECT_NE(told("factor").find(what + "measure is factor"), std::string::npos) << told("factor");
}

TEST(EnsembleScene, StagesMayNotSetWhatVariesAndMustJudge) {
  std::string text = small_scene;
  text.replace(text.find("duration = 2.0\n"), 15, "");
  text += R"([[stage]]
kind = "settle"
limit = 3
[[stage]]
kind = "run"
duration = 3
set = { "joint.default.friction_angle_deg" = 30.0 }
[ensemble]
count = 20
measure = "verdict"
[[ensemble.vary]]
key = "joint.default.friction_angle_deg"
distribution = "uniform"
min = 20
max = 30
)";
  const std::vector<std::string> expected{
      "s.toml:19:11: error: 'measure' in [ensemble] is verdict, and stage 'stage1' has none, a run of a "
      "given "
      "duration does not say whether the blocks stand, give that stage a limit in place of its duration",
      "s.toml:21:7: error: 'joint.default.friction_angle_deg' cannot vary, stage 'stage1' sets it at line "
      "16, "
      "leave it out there, or vary another key"};
  EXPECT_EQ(messages(read_scene(text, "s.toml", {})), expected);
}

EnsembleMember member_with(std::int64_t number, MemberOutcome outcome) {
  EnsembleMember member;
  member.number = number;
  member.outcome = outcome;
  member.values = {0.1, -3e20};
  return member;
}

TEST(EnsembleReport, RowsAreReadAsTheyWereWritten) {
  EnsembleMember member = member_with(12, MemberOutcome::cannot_run);
  member.message = "s.toml:1:2: error: too deep, \"slider\"";
  member.steps = 77;
  const auto again = member_of(row_of(member, false), 2, false);
  ASSERT_TRUE(again);
  EXPECT_EQ(row_of(*again, false), row_of(member, false));
  EXPECT_EQ(again->message, "s.toml:1:2: error: too deep, 'slider'");
  EXPECT_EQ(again->values, member.values);
  EXPECT_FALSE(again->factor());
  EnsembleMember bracketed = member_with(3, MemberOutcome::fails);
  bracketed.holds = 0.1;
  bracketed.fails = 0.3;
  EXPECT_EQ(member_of(row_of(bracketed, false), 2, false)->factor(), bracketed.factor());
  const std::string row = row_of(bracketed, false);
  EXPECT_FALSE(member_of(row.substr(0, row.size() - 2), 2, false)) << "cut off by a full disk";
  EXPECT_FALSE(member_of("", 2, false));
  EXPECT_FALSE(member_of(row, 2, true)) << "it lacks a cell";
}

TEST(EnsembleReport, PermanentDisplacementsAreOfMembersAtRest) {
  EnsembleReport report;
  report.measure = Measure::verdict;
  report.keys = {"a", "b"};
  report.count = 4;
  report.shakes = true;
  report.largest_displacement = 0.25;
  for (const double displacement : {0.1, 0.2, 0.6}) {
    const bool is_far = displacement > report.largest_displacement;
    EnsembleMember member = member_with(static_cast<std::int64_t>(report.members.size()),
                                        is_far ? MemberOutcome::fails : MemberOutcome::holds);
    member.displacement = displacement;
    const auto again = member_of(row_of(member, true), 2, true);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->displacement, member.displacement);
    report.members.push_back(*again);
  }
  report.members.push_back(*member_of(row_of(member_with(3, MemberOutcome::fails), true), 2, true));
  EXPECT_FALSE(report.members.back().displacement) << "it goes on";
  const EnsembleStatistics found = statistics_of(report);
  EXPECT_EQ(found.fails, 2);
  EXPECT_EQ(found.beyond, 1);
  EXPECT_EQ(found.displacement.number, 3);
  EXPECT_EQ(found.median_displacement, 0.2);
  EXPECT_NEAR(found.displacement.mean, 0.3, 1e-15);
  const std::string text = to_text(report);
  EXPECT_NE(text.find("permanent displacement of 3 members at rest: median 0.2 m, mean 0.3 m"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("1 member at rest farther than 0.25 m"), std::string::npos) << text;
}

TEST(Statistics, MedianIsTheMiddle) {
  EXPECT_EQ(median_of({}), 0.0);
  EXPECT_EQ(median_of({3.0}), 3.0);
  EXPECT_EQ(median_of({5.0, 1.0, 3.0}), 3.0);
  EXPECT_EQ(median_of({5.0, 1.0, 3.0, 4.0}), 3.5);
}

TEST(EnsembleReport, UndecidedMembersWidenTheIntervalAndTheOthersStayOut) {
  EnsembleReport report;
  report.measure = Measure::verdict;
  report.keys = {"a", "b"};
  report.count = 12;
  for (std::int64_t k = 0; k < 12; ++k) {
    report.members.push_back(member_with(k, k < 2   ? MemberOutcome::fails
                                            : k < 5 ? MemberOutcome::undecided
                                            : k < 7 ? MemberOutcome::cannot_run
                                                    : MemberOutcome::holds));
  }
  const EnsembleStatistics found = statistics_of(report);
  EXPECT_EQ(found.trials(), 10);
  EXPECT_EQ(found.probability, 0.2);
  EXPECT_EQ(found.interval.low, probability_interval(2, 10, 0.95).low);
  EXPECT_EQ(found.interval.high, probability_interval(5, 10, 0.95).high);
  const std::string text = to_text(report);
  EXPECT_NE(text.find("3 members undecided"), std::string::npos) << text;
  EXPECT_NE(text.find("2 cannot run"), std::string::npos) << text;
}

TEST(EnsembleReport, NoneThatFailsIsNotNever) {
  EnsembleReport report;
  report.count = 50;
  for (std::int64_t k = 0; k < 50; ++k) {
    report.members.push_back(member_with(k, MemberOutcome::holds));
  }
  EXPECT_EQ(
      to_text(report).find("no member of 50 fails, which does not make it impossible: the probability of "
                           "failure is at most 0.071 (95 % confidence"),
      0U)
      << to_text(report);
}

TEST(Histogram, CountsEveryMemberAndHasAnEdgeAtOne) {
  Variation variation = variation_of(Distribution::normal);
  variation.mean = 1.1;
  variation.deviation = 0.1;
  std::vector<double> values;
  for (int k = 0; k < 100; ++k) {
    values.push_back(variation.quantile((k + 0.5) / 100.0));
  }
  const Bars bars = bars_of(values, 1.0);
  EXPECT_EQ(std::accumulate(bars.counts.begin(), bars.counts.end(), std::int64_t{0}), 100);
  EXPECT_DOUBLE_EQ(bars.width, 0.1) << "Scott: 0.075";
  const double edges = (1.0 - bars.begin) / bars.width;
  EXPECT_NEAR(edges, std::round(edges), 1e-9);
  EXPECT_LE(bars.begin, values.front());
  EXPECT_GT(bars.begin + bars.width * static_cast<double>(bars.counts.size()), values.back());
  EXPECT_EQ(bars_of({1.5}, 1.0).counts, std::vector<std::int64_t>{1});
}

} // namespace
} // namespace gcpdda::ensemble_test
