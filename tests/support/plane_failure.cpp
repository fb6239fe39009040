#include "plane_failure.hpp"

#include "scenes.hpp"
#include "setting.hpp"

#include <fmt/format.h>

#include <cmath>

namespace gcpdda::testing {

std::string plane_failure_toml(double from_cohesion) {
  const std::string shipped = "cohesion = 3188.25";
  const double half = 3188.25; // Pa: adds 0.5
  std::string toml = shipped_toml("plane_failure");
  return toml.replace(toml.find(shipped), shipped.size(),
                      fmt::format("cohesion = {:.17g}", from_cohesion * half / 0.5));
}

double plane_failure_factor(double from_cohesion) {
  return std::tan(40.0 * degree) / std::tan(30.0 * degree) + from_cohesion;
}

} // namespace gcpdda::testing
