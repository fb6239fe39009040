#include "stability.hpp"

namespace gcpdda::study {

void soak(const Options & /*options*/) {}

} // namespace gcpdda::study
