#pragma once

// The list of keys as a document.

#include <string>

namespace gcpdda {

/// All keys of a scene and the layout of the block file, as one Markdown page made from the tables that the
/// reader itself goes by.
std::string scene_reference();

} // namespace gcpdda
