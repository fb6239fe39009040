#pragma once

#include "study.hpp"

namespace gcpdda::study {

/// Work on closed paths in contact: the exact potential against one read at the vertices, and a deformable
/// block's distance in its reference shape against that to its current boundary.
void closed_paths(const Options &options);

} // namespace gcpdda::study
