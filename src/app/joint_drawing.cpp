#include "app/joint_drawing.hpp"

#include "base/edit_distance.hpp"
#include "base/input_file.hpp"
#include "base/text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <spawn.h>
#include <sstream>
#include <sys/wait.h>
#include <utility>
#include <vector>

namespace gcpdda {

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t most_bytes = 256 << 20;
constexpr std::int64_t most_words = 1 << 20; // of messages and names of layers
constexpr int no_such_program = 127;         // of a child that could not be started, as a shell has it

/// A folder that only this process can read.
class TemporaryFolder {
public:
  TemporaryFolder() {
    std::error_code error;
    std::string name = (fs::temp_directory_path(error) / "gcpdda_drawing_XXXXXX").string();
    if (!error && ::mkdtemp(name.data()) != nullptr) {
      path_ = name;
    }
  }
  ~TemporaryFolder() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  TemporaryFolder(const TemporaryFolder &) = delete;
  TemporaryFolder &operator=(const TemporaryFolder &) = delete;
  [[nodiscard]] bool exists() const { return !path_.empty(); }
  [[nodiscard]] std::string operator/(const char *name) const { return (path_ / name).string(); }

private:
  fs::path path_;
};

/// Starts a program of PATH, its input empty, both of its outputs in a file, and waits for it.
/// @return its exit code; no_such_program where there is no such program, -1 where it was killed or could not
/// be started for another reason
int run_and_wait(std::vector<std::string> words, const std::string &output) {
  std::vector<char *> pointers;
  for (std::string &word : words) {
    pointers.push_back(word.data());
  }
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                     S_IRUSR | S_IWUSR);
  ::posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, pointers[0], &actions, nullptr, pointers.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    return error == ENOENT ? no_such_program : -1;
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) {
      return -1;
    }
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// The last line of what a program has said, without what begins every message of GDAL.
std::string last_words(const std::string &output) {
  std::istringstream stream(read_input_file(output, most_words).text);
  std::string last;
  for (std::string line; std::getline(stream, line);) {
    last = trimmed(line).empty() ? last : line;
  }
  std::string words;
  for (std::size_t at = 0; at < std::min<std::size_t>(last.size(), 200); at += 40) {
    words += printable(std::string_view(last).substr(at));
  }
  return words;
}

class Conversion {
public:
  explicit Conversion(const JointMap &map) : map_(&map), drawing_(fs::absolute(map.path).string()) {}

  DrawnLines convert() {
    if (!folder_.exists()) {
      fault("cannot make a temporary folder for the lines of the drawing", "ogr2ogr writes them there",
            "set TMPDIR to a folder with room");
      return std::move(result_);
    }
    std::string where = "OGR_GEOMETRY LIKE '%LINESTRING%'";
    if (!map_->layer.empty()) {
      where += fmt::format(" AND Layer = '{}'", doubled_quotes(map_->layer));
    }
    const std::string lines = folder_ / "lines.geojson";
    // RFC7946=NO: coordinates are metres of the drawing, not degrees.
    const int code = run_and_wait({"ogr2ogr", "-f", "GeoJSON", lines, drawing_, "entities", "-dim", "XY",
                                   "-where", where, "-lco", "RFC7946=NO", "-lco", "COORDINATE_PRECISION=12"},
                                  folder_ / "said");
    if (code == no_such_program) {
      fault(fmt::format("the drawing '{}' cannot be read without ogr2ogr", map_->path),
            "GDAL's program ogr2ogr, which is not on PATH, takes the lines out of it",
            "install the package gdal-bin, or convert the drawing where it is installed, by "
            "run/dxf_to_geojson.sh IN.dxf OUT.geojson LAYER, and name the .geojson file here");
      return std::move(result_);
    }
    result_.geojson = read_input_file(lines, most_bytes).text;
    if (code != 0 || result_.geojson.empty()) {
      const std::string words = last_words(folder_ / "said");
      fault(fmt::format("ogr2ogr cannot read the drawing '{}'", map_->path),
            words.empty() ? "it says nothing" : "it says: " + words, "check that it is a DXF drawing");
    } else if (result_.geojson.find("\"coordinates\"") == std::string::npos) {
      report_empty();
    }
    return std::move(result_);
  }

private:
  void fault(std::string what, std::string why, std::string hint) {
    result_.what = std::move(what);
    result_.why = std::move(why);
    result_.hint = std::move(hint);
  }

  static std::string doubled_quotes(const std::string &text) {
    std::string result;
    for (const char c : text) {
      result += c == '\'' ? "''" : std::string(1, c);
    }
    return result;
  }

  /// Layers that hold anything.
  std::vector<std::string> layers() {
    const std::string file = folder_ / "layers.csv";
    run_and_wait({"ogr2ogr", "-f", "CSV", file, drawing_, "-sql", "SELECT DISTINCT Layer FROM entities"},
                 folder_ / "said");
    std::istringstream stream(read_input_file(file, most_words).text);
    std::vector<std::string> names;
    std::string line;
    std::getline(stream, line); // the heading
    while (std::getline(stream, line)) {
      std::string_view name = trimmed(line);
      if (name.size() > 1 && name.front() == '"' && name.back() == '"') {
        name = name.substr(1, name.size() - 2);
      }
      if (!name.empty()) {
        names.emplace_back(name);
      }
    }
    return names;
  }

  void report_empty() {
    if (map_->layer.empty()) {
      fault(fmt::format("the drawing '{}' holds no lines", map_->path), "a map without traces cuts nothing",
            "check that joints are lines, polylines, arcs or splines, and not parts of blocks");
      return;
    }
    const std::vector<std::string> known = layers();
    if (std::find(known.begin(), known.end(), map_->layer) != known.end()) {
      fault(fmt::format("layer '{}' of the drawing '{}' holds no lines", printable(map_->layer), map_->path),
            "a map without traces cuts nothing",
            "check that joints are lines, polylines, arcs or splines, and not parts of blocks");
      return;
    }
    const std::string near = nearest_word(map_->layer, known);
    std::vector<std::string> shown;
    for (std::size_t k = 0; k < std::min<std::size_t>(known.size(), 10); ++k) {
      shown.push_back("'" + printable(known[k]) + "'");
    }
    fault(fmt::format("the drawing '{}' has nothing on a layer '{}'", map_->path, printable(map_->layer)),
          shown.empty() ? "a map without traces cuts nothing"
                        : fmt::format("its layers are {}{}", fmt::join(shown, ", "),
                                      known.size() > shown.size() ? " and others" : ""),
          near.empty() ? "check the name, with its capitals" : fmt::format("did you mean '{}'?", near));
  }

  const JointMap *map_;
  std::string drawing_;
  TemporaryFolder folder_;
  DrawnLines result_;
};

} // namespace

bool is_drawing(const std::string &path) {
  return lower_case(fs::path(path).extension().string()) == ".dxf";
}

DrawnLines lines_of_drawing(const JointMap &map) {
  return Conversion(map).convert();
}

} // namespace gcpdda
