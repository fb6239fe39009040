#include "study.hpp"

namespace gcpdda::study {

void fidelity(const Options & /*options*/) {}

} // namespace gcpdda::study
