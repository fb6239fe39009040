#pragma once

// The exception that lists what is wrong with a scene.

#include "gcpdda/base/diagnostic.hpp"

#include <stdexcept>
#include <utility>

namespace gcpdda {

/// A scene that cannot be run (exit_code::bad_scene); what it says goes to people.
class SceneError : public std::runtime_error {
public:
  /// @param diagnostics  at least one error among them
  explicit SceneError(Diagnostics diagnostics)
      : std::runtime_error(diagnostics.empty() ? "bad scene" : to_string(diagnostics.front())),
        diagnostics_(std::move(diagnostics)) {}
  /// All that is wrong, in the order of the scene.
  [[nodiscard]] const Diagnostics &diagnostics() const { return diagnostics_; }

private:
  Diagnostics diagnostics_;
};

} // namespace gcpdda
