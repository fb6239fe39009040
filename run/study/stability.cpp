#include "study.hpp"

namespace gcpdda::study {

void stability(const Options & /*options*/) {}

} // namespace gcpdda::study
