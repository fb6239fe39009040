#include "stability.hpp"

namespace gcpdda::study {

void stability(const Options &options) {
  linear_stability(options);
  rejected_variants(options);
  failures(options);
  soak(options);
}

} // namespace gcpdda::study
