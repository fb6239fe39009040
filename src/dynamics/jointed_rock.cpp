#include "dynamics/jointed_rock.hpp"

#include "dynamics/block_matrix.hpp"

#include <algorithm>

namespace gcpdda {

Compliance compliance_along(Vec2 edge, std::array<double, 2> stiffness) {
  const double length = norm(edge);
  const Vec2 t = (1.0 / length) * edge;
  const Vec2 n = perp(t);
  const std::array<Vec2, 3> traction{{{n.x, 0.0}, {0.0, n.y}, {n.y, n.x}}}; // of each stress
  Compliance result{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      result[packed(i, j)] = 0.5 * length *
                             (dot(traction[i], n) * dot(traction[j], n) / stiffness[0] +
                              dot(traction[i], t) * dot(traction[j], t) / stiffness[1]);
    }
  }
  return result;
}

Compliance compliance_of_rock(double direct, double cross, double shear) {
  const double determinant = direct * direct - cross * cross;
  return {direct / determinant, -cross / determinant, direct / determinant, 0.0, 0.0, 1.0 / shear};
}

std::array<double, 2> wave_moduli(const Compliance &compliance, Vec2 direction) {
  std::array<double, 21> lower{};
  std::copy(compliance.begin(), compliance.end(), lower.begin());
  const BlockMatrix factors = factorise<3>(lower);
  const auto modulus = [&](const std::array<double, 3> &strain) {
    const std::array<double, 3> stress = solve<3>(factors, strain);
    return strain[0] * stress[0] + strain[1] * stress[1] + strain[2] * stress[2];
  };
  const auto [x, y] = direction;
  return {modulus({x * x, y * y, 2.0 * x * y}), modulus({-x * y, x * y, x * x - y * y})};
}

} // namespace gcpdda
