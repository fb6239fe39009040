// The text of a report says first what was found, and where nothing was, why.

#include "io/results/safety_report.hpp"

#include <gtest/gtest.h>

#include <string>

namespace gcpdda::safety_report_test {
namespace {

SafetyReport bound_alone() {
  SafetyReport report;
  report.is_bound_alone = true;
  return report;
}

TEST(SafetyReport, BeginsWithTheBoundOrWhyThereIsNone) {
  SafetyReport solved = bound_alone();
  solved.bound = 1.25;
  EXPECT_TRUE(to_text(solved).starts_with("factor of safety at most 1.25, by limit analysis"));
  EXPECT_TRUE(to_text(bound_alone()).starts_with("limit analysis gives no bound: forces balance the loads"));
  SafetyReport unsolved = bound_alone();
  unsolved.unsolved_bound = "the programme was not solved";
  EXPECT_TRUE(to_text(unsolved).starts_with("limit analysis gives no bound: the programme was not solved\n"))
      << to_text(unsolved);
}

} // namespace
} // namespace gcpdda::safety_report_test
