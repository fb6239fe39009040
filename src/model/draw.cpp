#include "model/draw.hpp"

#include <cmath>
#include <numbers>

namespace gcpdda {

double Draw::normal() {
  const double radius = std::sqrt(-2.0 * std::log(uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

} // namespace gcpdda
