// The part of a scene that decides its settled state (scene_reader.hpp).

#include "gcpdda/io/scene_reader.hpp"

#include <algorithm>
#include <array>

namespace gcpdda {

// No string of a resolved scene holds a line end, so that a line which begins with a bracket is a header.
std::string settling_part(std::string_view resolved) {
  constexpr std::array<std::string_view, 4> left_out{"fos", "output", "ensemble", "monitor"};
  std::string part;
  bool counts = true;
  while (!resolved.empty()) {
    const std::string_view line = resolved.substr(0, resolved.find('\n'));
    resolved.remove_prefix(std::min(line.size() + 1, resolved.size()));
    if (line.starts_with('[')) {
      const std::string_view path = line.substr(line.find_first_not_of('['));
      const std::string_view table = path.substr(0, path.find_first_of(".]"));
      counts = std::find(left_out.begin(), left_out.end(), table) == left_out.end();
    }
    if (counts && !line.empty() && !line.starts_with('#')) {
      part.append(line).push_back('\n');
    }
  }
  return part;
}

} // namespace gcpdda
