// The folder of a run: made, taken up again, recognised.

#include "io/results/result_directory.hpp"

#include "base/check.hpp"
#include "io/hdf5/durable_file.hpp"
#include "io/hdf5/numbered_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>

namespace gcpdda {

namespace {

namespace fs = std::filesystem;

constexpr std::array<const char *, 3> folders{"frames", "history", "decomposition"};

bool is_own_history(const fs::path &path) {
  std::ifstream stream(path);
  std::string line;
  return path.extension() == ".csv" && std::getline(stream, line) && line.starts_with("time[s],");
}

bool is_own_file(const fs::path &folder, const fs::path &path) {
  std::string name = path.filename().string();
  if (name.ends_with(".tmp")) {
    name.resize(name.size() - 4); // left by a killed run
  }
  if (folder == "frames") {
    return is_numbered(name, "frame", ".hdf") || is_numbered(name, "contacts", ".hdf") ||
           is_numbered(name, "bolts", ".hdf") || is_numbered(name, "liners", ".hdf") ||
           is_numbered(name, "topology", ".h5");
  }
  if (folder == "checkpoints") {
    return is_numbered(name, "checkpoint", ".h5") || name == "past_scenes.txt";
  }
  if (folder == "decomposition") {
    return is_numbered(name, "owners", ".csv");
  }
  if (folder == "history") {
    return is_own_history(path);
  }
  return name == "run.hdf.series" || name == "contacts.hdf.series" || name == "bolts.hdf.series" ||
         name == "liners.hdf.series" || name == "run.xdmf" || name == "summary.json" ||
         is_numbered(name, "joint_map", ".geojson");
}

std::vector<fs::path> own_files(const fs::path &directory) {
  std::vector<fs::path> found;
  const auto look_into = [&](const fs::path &folder) {
    if (!fs::is_directory(directory / folder)) {
      return;
    }
    for (const fs::directory_entry &entry : fs::directory_iterator(directory / folder)) {
      if (entry.is_regular_file() && is_own_file(folder, entry.path())) {
        found.push_back(entry.path());
      }
    }
  };
  look_into("");
  for (const char *folder : folders) {
    look_into(folder);
  }
  look_into("checkpoints");
  return found;
}

// A run makes its three folders before anything else.
bool holds_run(const fs::path &directory, const std::vector<fs::path> &found) {
  return !found.empty() || std::all_of(folders.begin(), folders.end(), [&](const char *folder) {
    return fs::is_directory(directory / folder);
  });
}

void clear(const fs::path &directory, bool overwrite) {
  if (holds_search(directory) || holds_ensemble(directory)) {
    throw FileError(
        fmt::format("{} holds {}, choose another folder with --out", directory.string(),
                    holds_search(directory) ? "a search for the factor of safety" : "an ensemble"));
  }
  std::vector<fs::path> found = own_files(directory);
  const fs::path scene = directory / "scene.toml";
  if (!holds_run(directory, found)) {
    // Then scene.toml may be a person's input, as with `gcpdda run scene.toml --out .`
    if (fs::exists(scene)) {
      throw FileError(scene.string() + " exists and is not of a run: choose another folder with --out");
    }
    return;
  }
  if (!overwrite) {
    throw FileError("the folder " + directory.string() +
                    " holds a run: choose another with --out, or replace it with --overwrite");
  }
  found.insert(found.end(), {scene, directory / "run.log"});
  for (const fs::path &path : found) {
    fs::remove(path);
  }
}

} // namespace

bool holds_search(const fs::path &directory) {
  return fs::exists(directory / "fos.json") || fs::exists(directory / "settled") ||
         fs::exists(directory / "trials");
}

bool holds_ensemble(const fs::path &directory) {
  return fs::exists(directory / "ensemble.toml");
}

void expect_run_to_restart(const fs::path &directory) {
  std::error_code unseen; // what opens the scene says so
  if (fs::exists(directory / "scene.toml", unseen) || unseen) {
    return;
  }
  const std::string name = directory.string();
  if (holds_search(directory)) {
    throw FileError(fmt::format(
        "{0} holds a search for the factor of safety, and a restart goes on with a run: repeat gcpdda fos "
        "with "
        "--out {0} --overwrite{1}",
        name,
        fs::exists(directory / "settled" / "summary.json")
            ? fmt::format(", or begin with its settled state: another folder with --out, and --settled {}",
                          (directory / "settled").string())
            : std::string()));
  }
  if (holds_ensemble(directory)) {
    throw FileError(name + " holds an ensemble, and a restart goes on with a run: repeat the call of gcpdda "
                           "ensemble, which computes the members that are missing");
  }
}

void prepare_result_directory(const fs::path &directory, bool overwrite, const std::string &resolved_scene) {
  try {
    clear(directory, overwrite);
  } catch (const fs::filesystem_error &error) {
    throw FileError(std::string("cannot use the folder: ") + error.what());
  }
  for (const char *folder : folders) {
    make_directory(directory / folder);
  }
  write_file(directory / "scene.toml", resolved_scene);
}

fs::path kept_joint_map(const fs::path &directory, std::size_t number) {
  return directory / fmt::format("joint_map_{:06}.geojson", number);
}

void reopen_result_directory(const fs::path &directory, const std::string &resolved_scene) {
  for (const char *folder : folders) {
    make_directory(directory / folder);
  }
  write_file(directory / "scene.toml", resolved_scene);
  std::error_code none; // that it says "stopped" harms nobody
  fs::remove(directory / "summary.json", none);
}

bool says_completed(const fs::path &directory) {
  std::ifstream stream(directory / "summary.json");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  return text.find("\"verdict\": \"completed\"") != std::string::npos;
}

void write_owners(const fs::path &directory, std::int64_t step,
                  const std::vector<std::int32_t> &owner_of_block) {
  std::string text = "block,rank\n";
  for (std::size_t block = 0; block < owner_of_block.size(); ++block) {
    text += fmt::format("{},{}\n", block, owner_of_block[block]);
  }
  make_directory(directory / "decomposition");
  write_file(directory / "decomposition" / fmt::format("owners_{}.csv", step), text);
}

} // namespace gcpdda
