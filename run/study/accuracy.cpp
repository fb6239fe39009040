#include "study.hpp"

namespace gcpdda::study {

void accuracy(const Options & /*options*/) {}

} // namespace gcpdda::study
