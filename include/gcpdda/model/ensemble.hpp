#pragma once

// Many scenes from one: values of the scene drawn at random, member by member. What a member draws depends on
// the seed, its number and the place of the value in the list alone, so that an ensemble can be dealt to any
// ranks in any order, stopped, continued and made larger.

#include "gcpdda/base/diagnostic.hpp"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace gcpdda {

enum class Distribution { normal, lognormal, uniform, triangular, seed };

/// What is found out of each member.
enum class Measure {
  verdict, ///< whether it stands: one run
  factor   ///< its factor of safety: a search
};

/// A value of the scene that each member draws.
struct Variation {
  std::string key; ///< path in the scene, as with --set
  Distribution distribution = Distribution::normal;
  double mean = 0.0; ///< of normal and lognormal before they are cut off at min and max, as the next
  double deviation = 0.0;
  double min = -std::numeric_limits<double>::infinity(); ///< beyond these nothing is drawn
  double max = std::numeric_limits<double>::infinity();
  double mode = 0.0; ///< of triangular, between min and max
  SourcePosition where;

  /// The value below which a share p of all members lies, p in (0, 1). Cut off means that the rest of the
  /// distribution is scaled up, not that values pile up at the ends.
  [[nodiscard]] double quantile(double p) const;
  /// Share of the distribution that lies between min and max.
  [[nodiscard]] double share_within() const;

private:
  [[nodiscard]] double probability(double x) const;
  [[nodiscard]] double whole_quantile(double p) const;
};

/// Members of an ensemble: how many, from which seed, and what varies among them.
struct Ensemble {
  std::int64_t count = 0; ///< members; 0 where the scene has no ensemble
  std::int64_t seed = 0;
  Measure measure = Measure::factor;
  std::int64_t ranks = 0; ///< of each member; 0: as few as keep all busy
  bool keep = false;      ///< result folders of the members stay
  /// m; a member fails, too, whose blocks come to rest farther from where the ground began to shake.
  double largest_displacement = std::numeric_limits<double>::infinity();
  std::vector<Variation> variations;
  /// Lower triangular factor of the correlation matrix of the normal variables behind the values, by rows;
  /// empty where all are independent (Gaussian copula).
  std::vector<double> correlation_factor;
};

/// Lower triangular factor of a symmetric matrix (Cholesky), both n by n by rows; empty where the matrix is
/// not positive definite.
std::vector<double> lower_factor(const std::vector<double> &matrix, std::size_t n);

/// What a member has in place of the values of the scene, in the order of Ensemble::variations.
std::vector<double> sample(const Ensemble &ensemble, std::int64_t member);

} // namespace gcpdda
