#include "critical_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace gcpdda::testing {

double perimeter_of_overlap(const Shape &a, const Shape &b) {
  Overlap overlap;
  overlap.find(a.view(), b.view(), PotentialKind::exact);
  double sum = 0.0;
  for (const Piece &piece : overlap.pieces()) {
    sum += piece.length;
  }
  return sum;
}

namespace {

/// Both sides of 0, ever closer, and a sweep through it.
std::vector<double> stations_about_zero() {
  std::vector<double> stations;
  for (int k = 2; k <= 17; ++k) {
    stations.push_back(std::pow(10.0, -k));
    stations.push_back(-std::pow(10.0, -k));
  }
  for (int k = -200; k <= 200; ++k) {
    stations.push_back(1e-4 * k);
  }
  std::sort(stations.begin(), stations.end());
  return stations;
}

/// @param step  that points of the moving block go at most, m
void expect_near(const Shape &begin, const Shape &end, const Shape &still, double step) {
  const RegionIntegrals f0 = contact_of(begin, still);
  const RegionIntegrals f1 = contact_of(end, still);
  const double perimeter = std::max(perimeter_of_overlap(begin, still), perimeter_of_overlap(end, still));
  const double rounding = 16.0 * std::numeric_limits<double>::epsilon();
  const double bound = 2.0 * (step + rounding) * (perimeter + step);
  ASSERT_LE(norm(f1.force - f0.force), bound);
  ASSERT_LE(std::abs(f1.pressure - f0.pressure), bound);
}

} // namespace

void expect_continuous_force(const CriticalPath &path, double reach,
                             const std::function<void(const Shape &, const RegionIntegrals &)> &also) {
  SCOPED_TRACE(path.name);
  const auto at = [&](double s) { return moved(path.moving, path.turn * s, {}, s * path.direction); };
  const std::vector<double> stations = stations_about_zero();
  double largest = 0.0;
  for (std::size_t k = 0; k + 1 < stations.size(); ++k) {
    const Shape end = at(stations[k + 1]);
    const RegionIntegrals region = contact_of(end, path.still);
    const double step = (1.0 + reach * std::abs(path.turn)) * (stations[k + 1] - stations[k]);
    ASSERT_NO_FATAL_FAILURE(expect_near(at(stations[k]), end, path.still, step)) << stations[k];
    ASSERT_NO_FATAL_FAILURE(also(end, region)) << stations[k];
    largest = std::max(largest, region.pressure);
  }
  EXPECT_GT(largest, 0.0) << "never touches";
}

} // namespace gcpdda::testing
