#pragma once

// From TOML text to a scene.

#include "gcpdda/base/diagnostic.hpp"
#include "gcpdda/model/scene.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace gcpdda {

/// A scene and what is to be said of its text.
struct SceneReading {
  Scene scene;             ///< complete only if the diagnostics hold no error
  Diagnostics diagnostics; ///< every fault of the text, in file order
};

/// Read and validate one scene. No file is touched and no MPI call made, so that every rank that is given the
/// same text gets the same answer. The resolved text names a block file by its absolute path.
///
/// @param text  the TOML text
/// @param file  its name as the user gave it, for diagnostics and Scene::stem
/// @param sets  "dotted.path=value" arguments, applied before validation
/// An error in a scene with the median of what its ensemble varies is an error of the scene.
SceneReading read_scene(std::string_view text, const std::string &file, const std::vector<std::string> &sets);

/// Of the text of a resolved scene what decides its settled state: without comments, [fos], [output],
/// [ensemble] and monitors.
std::string settling_part(std::string_view resolved);

/// An error for each --set argument of an ensemble that sets a value which varies: each member draws its own.
Diagnostics sets_without_effect(const Ensemble &ensemble, const std::vector<std::string> &sets);

/// The --set argument that gives a value of the scene that varies.
std::string assignment(const Variation &variation, double value);

} // namespace gcpdda
