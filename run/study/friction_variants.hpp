#pragma once

#include "study.hpp"

namespace gcpdda::study {

/// Stick springs and dashpots as the program has them and as they were rejected, on one block.
void friction_variants(const Options &options);

} // namespace gcpdda::study
