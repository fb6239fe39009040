#include "stability.hpp"

namespace gcpdda::study {

void linear_stability(const Options & /*options*/) {}

} // namespace gcpdda::study
