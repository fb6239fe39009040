#include "stability.hpp"

namespace gcpdda::study {

void rejected_variants(const Options & /*options*/) {}

} // namespace gcpdda::study
