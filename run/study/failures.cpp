#include "stability.hpp"

namespace gcpdda::study {

void failures(const Options & /*options*/) {}

} // namespace gcpdda::study
