// Which factors a search for the factor of safety tries.

#include "driver/safety_search.hpp"
#include "unit/scene_texts.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include <cmath>
#include <map>

namespace gcpdda::safety_search_test {
namespace {

/// Blocks that hold below `limit`, and say nothing within `fog` of it.
Verdict verdict_at(double factor, double limit, double fog = 0.0) {
  return std::abs(factor - limit) < fog ? Verdict::undecided
         : factor < limit               ? Verdict::settled
                                        : Verdict::failed;
}

struct Outcome {
  SafetySearch search;
  std::map<double, Verdict> tried;
  int rounds = 0;
};

Outcome search(const SearchRange &range, double limit, double fog, std::size_t at_once) {
  Outcome outcome;
  const TrialVerdicts known = [&](double factor) -> std::optional<Verdict> {
    const auto found = outcome.tried.find(factor);
    return found == outcome.tried.end() ? std::nullopt : std::optional(found->second);
  };
  for (std::vector<double> next = next_factors(range, known, at_once); !next.empty();
       next = next_factors(range, known, at_once)) {
    EXPECT_LE(next.size(), at_once);
    EXPECT_EQ(next.front(), follow(range, known).next) << "what is asked for comes first";
    for (const double factor : next) {
      EXPECT_TRUE(outcome.tried.emplace(factor, verdict_at(factor, limit, fog)).second) << "no trial twice";
    }
    ++outcome.rounds;
  }
  outcome.search = follow(range, known);
  return outcome;
}

TEST(SafetySearch, BracketsTheLimit) {
  StrengthReduction reduction;
  reduction.tolerance = 0.002;
  for (const double limit : {0.51, 1.0, 1.4534, 3.99}) {
    const Outcome found = search({reduction}, limit, 0.0, 1);
    ASSERT_TRUE(found.search.holds && found.search.fails);
    EXPECT_LT(*found.search.holds, limit);
    EXPECT_GE(*found.search.fails, limit);
    EXPECT_LE(*found.search.fails - *found.search.holds, 0.002 * *found.search.holds);
    EXPECT_EQ(found.search.decisive.size(), found.tried.size()) << "one at a time tries nothing in vain";
    EXPECT_LE(found.tried.size(), 3 + static_cast<std::size_t>(std::ceil(std::log2(3.5 / (0.002 * 0.5)))));
  }
}

TEST(SafetySearch, LeavesNoDoubtWhetherTheSceneStands) {
  StrengthReduction reduction;
  for (const double limit : {0.99, 0.999, 1.0, 1.001, 1.01}) {
    const SafetySearch found = search({reduction}, limit, 0.0, 1).search;
    ASSERT_TRUE(found.holds && found.fails) << limit;
    EXPECT_TRUE(*found.holds >= 1.0 || *found.fails <= 1.0) << limit;
  }
}

TEST(SafetySearch, IsTheSameForAnyNumberOfTrialsAtOnce) {
  StrengthReduction reduction;
  for (const double fog : {0.0, 0.05}) {
    const Outcome alone = search({reduction}, 1.4534, fog, 1);
    for (const std::size_t at_once : {2U, 3U, 4U, 7U}) {
      const Outcome together = search({reduction}, 1.4534, fog, at_once);
      EXPECT_EQ(together.search.holds, alone.search.holds);
      EXPECT_EQ(together.search.fails, alone.search.fails);
      EXPECT_EQ(together.search.undecided, alone.search.undecided);
      EXPECT_EQ(together.search.decisive, alone.search.decisive);
    }
    EXPECT_LE(search({reduction}, 1.4534, fog, 3).rounds, (alone.rounds + 2) / 2) << "two levels in a round";
  }
}

TEST(SafetySearch, KeepsWhatIsUndecidedInTheBracket) {
  StrengthReduction reduction;
  const Outcome found = search({reduction}, 1.4534, 0.05, 1);
  ASSERT_FALSE(found.search.undecided.empty());
  EXPECT_LE(*found.search.holds, 1.4034);
  EXPECT_GE(*found.search.fails, 1.5034);
  EXPECT_NEAR(*found.search.holds, 1.4034, 0.015) << "as near as the tolerance asks for";
  EXPECT_NEAR(*found.search.fails, 1.5034, 0.015);
  for (const double factor : found.search.undecided) {
    EXPECT_EQ(verdict_at(factor, 1.4534, 0.05), Verdict::undecided);
  }
}

TEST(SafetySearch, EndsWhereTheEndsDoNotBracketIt) {
  const StrengthReduction reduction;
  const Outcome weak = search({reduction}, 0.3, 0.0, 4);
  EXPECT_FALSE(weak.search.holds);
  EXPECT_EQ(weak.search.fails, reduction.from);
  const Outcome strong = search({reduction}, 9.0, 0.0, 1);
  EXPECT_EQ(strong.search.holds, reduction.to);
  EXPECT_FALSE(strong.search.fails);
  StrengthReduction coarse;
  coarse.tolerance = 3.0;
  EXPECT_EQ(search({coarse}, 3.9, 0.0, 1).search.fails, coarse.to) << "the end is tried all the same";
}

// What is tried is what the settled state makes likely.
TEST(SafetySearch, GoesUpFromTheSettledState) {
  const StrengthReduction reduction;
  const auto first_factors = [&](double settled, double limit) {
    std::vector<double> factors = search({reduction, settled}, limit, 0.0, 1).search.decisive;
    factors.resize(4);
    return factors;
  };
  const auto expect_factors = [&](const std::vector<double> &found, const std::vector<double> &expected) {
    for (std::size_t k = 0; k < expected.size(); ++k) {
      EXPECT_NEAR(found[k], expected[k], 1e-12);
    }
  };
  expect_factors(first_factors(1.0, 1.2), {1.0, 1.16, 1.16 * 1.16, 1.16 * 1.08});
  expect_factors(first_factors(1.0, 3.9), {1.0, 1.16, 1.16 * 1.16, 1.16 * 1.16 * 1.16});
  EXPECT_EQ(first_factors(1.0, 0.9), (std::vector<double>{1.0, 0.5, 0.75, 0.875}))
      << "it did not stay at rest";
  expect_factors(first_factors(0.5, 0.9), {0.5, 0.5 * 1.16, 0.5 * 1.16 * 1.16, 0.5 * 1.16 * 1.16 * 1.16});
  EXPECT_EQ(first_factors(5.0, 0.9)[0], reduction.from) << "beyond what is tried";
}

// Steps up are powers of two of the tolerance: no trial makes the bracket narrower than is asked for.
TEST(SafetySearch, HalvesDownToTheToleranceAndNoFurther) {
  for (const double tolerance : {0.005, 0.01, 0.02, 0.04}) {
    StrengthReduction reduction;
    reduction.tolerance = tolerance;
    const auto halvings = static_cast<std::size_t>(std::round(std::log2(0.16 / tolerance)));
    for (const double limit : {1.001, 1.0799, 1.1599}) {
      const Outcome found = search({reduction}, limit, 0.0, 1);
      EXPECT_NEAR(*found.search.fails - *found.search.holds, tolerance, 1e-12) << limit;
      EXPECT_EQ(found.tried.size(), 2 + halvings) << limit;
    }
    EXPECT_EQ(search({reduction}, 1.3, 0.0, 1).tried.size(), 3 + halvings);
    EXPECT_EQ(search({reduction}, 1.5, 0.0, 1).tried.size(), 4 + halvings);
  }
}

// Trials beyond 1.5 break down without a verdict; the limit is below.
TEST(SafetySearch, ComesDownFromAnEndWithoutAVerdict) {
  const StrengthReduction reduction;
  std::map<double, Verdict> tried;
  const TrialVerdicts known = [&](double factor) -> std::optional<Verdict> {
    const auto found = tried.find(factor);
    return found == tried.end() ? std::nullopt : std::optional(found->second);
  };
  SafetySearch found = follow({reduction}, known);
  for (; found.next; found = follow({reduction}, known)) {
    ASSERT_LT(tried.size(), 20U);
    tried[*found.next] = *found.next > 1.5 ? Verdict::undecided : verdict_at(*found.next, 1.4534);
  }
  ASSERT_TRUE(found.holds && found.fails);
  EXPECT_LT(*found.holds, 1.4534);
  EXPECT_GT(*found.fails, 1.4534);
  EXPECT_LE(*found.fails - *found.holds, reduction.tolerance * *found.holds);
  EXPECT_TRUE(found.undecided.empty()) << "none is in the bracket";
}

// Trials just beyond the limit are too slow for a verdict.
TEST(SafetySearch, GoesOnUpwardFromFactorsWithoutAVerdict) {
  const StrengthReduction reduction;
  const Outcome found = search({reduction}, 1.5, 0.2, 1);
  ASSERT_TRUE(found.search.holds && found.search.fails);
  EXPECT_NEAR(*found.search.holds, 1.3, 0.015);
  EXPECT_NEAR(*found.search.fails, 1.7, 0.02);
  const Outcome none = search({reduction}, 3.9, 0.2, 1);
  EXPECT_NEAR(*none.search.holds, 3.7, 0.04);
  EXPECT_FALSE(none.search.fails) << "the end is undecided";
  EXPECT_EQ(none.search.undecided.back(), reduction.to);
}

Scene staged_scene() {
  Scene scene;
  scene.joints.laws.resize(3);
  for (JointLaw &law : scene.joints.laws) {
    law.tan_friction = 0.8;
    law.residual_tan_friction = 0.6;
    law.cohesion = 4e5;
    law.residual_cohesion = 1e5;
    law.tension = 2e5;
    law.tan_dilation = 0.35;
    law.dilation_limit = 0.01;
  }
  scene.joints.laws[2].is_barton_bandis = true;
  scene.joints.laws[2].roughness = 10.0;
  scene.joints.laws[2].strength = 5e7;
  scene.stages.resize(4);
  scene.stages[0].kind = StageKind::settle;
  scene.stages[0].duration = 7.0;
  scene.stages[1].kind = StageKind::change;
  auto after = std::make_shared<Scene>(scene);
  after->joints.laws[0].cohesion = 8e5;
  scene.stages[1].after = after;
  scene.stages[2].kind = StageKind::excavate;
  scene.stages[3].kind = StageKind::run;
  return scene;
}

TEST(WeakenedScene, DividesTheStrengthThatIsInForce) {
  Scene scene = staged_scene();
  scene.reduction.families = {0, 2};
  const Scene trial = weakened_scene(scene, 2.0);
  ASSERT_EQ(trial.stages.size(), 4U) << "settle, what changes at once, and the trial in place of the run";
  EXPECT_EQ(trial.stages[2].kind, StageKind::excavate);
  EXPECT_TRUE(trial.stages[3].until_verdict);
  EXPECT_EQ(trial.stages[3].drag_limit, 7.0);
  EXPECT_EQ(trial.stages[3].duration, 63.0) << "eight times as long again without local damping";
  const std::vector<JointLaw> &laws = trial.stages[3].after->joints.laws;
  EXPECT_EQ(laws[0].tan_friction, 0.4);
  EXPECT_EQ(laws[0].residual_tan_friction, 0.3);
  EXPECT_EQ(laws[0].cohesion, 4e5) << "half of what the change has set";
  EXPECT_EQ(laws[0].tension, 1e5);
  EXPECT_EQ(laws[0].residual_cohesion, 0.5e5);
  EXPECT_EQ(laws[1].tan_friction, 0.8) << "not chosen";
  EXPECT_EQ(laws[1].cohesion, 4e5);
  const JointLaw &whole = scene.joints.laws[2];
  for (const double stress : {1e4, 5e5, 1e7, 1e8}) {
    EXPECT_DOUBLE_EQ(laws[2].tan_friction_at(stress), 0.5 * whole.tan_friction_at(stress));
  }
}

TEST(WeakenedScene, IsSolvedAsTheLastSettleStageIs) {
  Scene scene = staged_scene();
  EXPECT_EQ(weakened_scene(scene, 2.0).stages.back().solver, Solver::dynamic);
  const auto last_settle = std::find_if(scene.stages.rbegin(), scene.stages.rend(),
                                        [](const Stage &stage) { return stage.kind == StageKind::settle; });
  last_settle->solver = Solver::statics;
  const Scene trial = weakened_scene(scene, 2.0);
  EXPECT_EQ(trial.stages.back().solver, Solver::statics);
  EXPECT_EQ(trial.stages.back().increments, last_settle->increments);
  EXPECT_EQ(weakened_scene(scene, 2.0, 2.0).stages.back().increments, 1) << "nothing changes";
  for (const Verdict found : {Verdict::settled, Verdict::failed}) {
    const std::vector<Stage> stages = with_confirming_stage(trial, found).stages;
    EXPECT_EQ(stages.size(), trial.stages.size() + 1);
    EXPECT_EQ(stages.back().name, confirming_stage);
    EXPECT_EQ(stages.back().begins_at_rest, found == Verdict::settled);
    EXPECT_EQ(stages.back().goes_on_failing, found == Verdict::failed);
  }
}

// Increments of at most 2 % from the strengths of the settled state to those of the trial, which come last.
TEST(WeakenedScene, FallsInSmallIncrements) {
  Scene scene = staged_scene();
  scene.reduction.families = {0};
  const Stage trial = weakened_scene(scene, 2.0, 0.5).stages.back();
  ASSERT_FALSE(trial.weakening.empty());
  double before = 0.8 / 0.5;
  for (const std::vector<JointLaw> &laws : trial.weakening) {
    EXPECT_LT(laws[0].tan_friction, before);
    EXPECT_GT(1.02 * laws[0].tan_friction, before);
    EXPECT_DOUBLE_EQ(laws[0].cohesion / laws[0].tan_friction, 8e5 / 0.8) << "all strengths alike";
    EXPECT_EQ(laws[1].tan_friction, 0.8) << "not chosen";
    before = laws[0].tan_friction;
  }
  EXPECT_GT(1.02 * trial.after->joints.laws[0].tan_friction, before);
  EXPECT_TRUE(weakened_scene(scene, 1.01).stages.back().weakening.empty()) << "one increment";
  EXPECT_TRUE(weakened_scene(scene, 0.9).stages.back().weakening.empty()) << "gains strength";
  scene.stages[0].solver = Solver::statics;
  for (const Stage &stage : weakened_scene(scene, 2.0).stages) {
    EXPECT_TRUE(stage.weakening.empty()) << "the static solver has no inertia";
  }
}

// Where the static solver has failed in a trial, the dynamic one takes the strengths down just as it does in
// a trial of its own.
TEST(WeakenedScene, FallsInTheSameIncrementsWhereTheStaticSolverHasFailed) {
  Scene scene = staged_scene();
  const Stage expected = weakened_scene(scene, 2.0, 0.5).stages.back();
  scene.stages[0].solver = Solver::statics;
  const Stage trial = with_dynamic_solver(weakened_scene(scene, 2.0, 0.5), scene, 2.0, 0.5).stages.back();
  EXPECT_EQ(trial.solver, Solver::dynamic);
  ASSERT_EQ(trial.weakening.size(), expected.weakening.size());
  ASSERT_FALSE(trial.weakening.empty());
  for (std::size_t k = 0; k < trial.weakening.size(); ++k) {
    for (std::size_t law = 0; law < trial.weakening[k].size(); ++law) {
      EXPECT_EQ(trial.weakening[k][law].tan_friction, expected.weakening[k][law].tan_friction);
      EXPECT_EQ(trial.weakening[k][law].cohesion, expected.weakening[k][law].cohesion);
    }
  }
}

TEST(WeakenedScene, DilatesNoMoreThanItsFrictionAllows) {
  const std::vector<JointLaw> laws = weakened_scene(staged_scene(), 2.0).stages.back().after->joints.laws;
  EXPECT_EQ(laws[0].tan_dilation, 0.35);
  EXPECT_EQ(weakened_scene(staged_scene(), 4.0).stages.back().after->joints.laws[0].tan_dilation, 0.2);
}

// What is said of [fos].
TEST(SafetySearch, FaultsAreToldAllAtOnce) {
  const std::string text = testing::small_scene + R"([fos]
families = ["defalt", "default"]
from = 2
to = 1.5
)";
  const std::vector<std::string> expected{
      "s.toml:12:13: error: no joint is named 'defalt', did you mean 'default'?",
      "s.toml:14:6: error: 'to' in [fos] is 1.5 and from is 2, the factor is searched from the one to the "
      "other, exchange them"};
  EXPECT_EQ(testing::messages(read_scene(text, "s.toml", {})), expected);
}

} // namespace
} // namespace gcpdda::safety_search_test
