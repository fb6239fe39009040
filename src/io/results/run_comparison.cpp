#include "io/results/run_comparison.hpp"

#include "io/hdf5/hdf5_input.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace gcpdda {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_differences = 20;

class Comparison {
public:
  Comparison(fs::path a, fs::path b) : a_(std::move(a)), b_(std::move(b)) {}
  std::vector<std::string> run();

private:
  void add(std::string difference) {
    if (differences_.size() < most_differences) {
      differences_.push_back(std::move(difference));
    }
  }
  template <class Name>
  std::vector<Name> names_in_both(const std::string &what, std::vector<Name> of_a, std::vector<Name> of_b);
  void compare_file(const fs::path &name);
  void compare_bytes(const fs::path &name);
  void compare_hdf5(const fs::path &name);
  void compare_contents(const fs::path &name, const hdf5::Content &a, const hdf5::Content &b);

  const hdf5::QuietErrors quiet_;
  const fs::path a_;
  const fs::path b_;
  std::vector<std::string> differences_;
};

std::vector<fs::path> files_of_run(const fs::path &directory) {
  std::vector<fs::path> files;
  for (const char *folder : {"frames", "history"}) {
    if (fs::is_directory(directory / folder)) {
      for (const fs::directory_entry &entry : fs::recursive_directory_iterator(directory / folder)) {
        if (!entry.is_directory()) {
          files.push_back(entry.path().lexically_relative(directory));
        }
      }
    }
  }
  for (const char *index :
       {"run.hdf.series", "run.xdmf", "contacts.hdf.series", "bolts.hdf.series", "liners.hdf.series"}) {
    if (fs::exists(directory / index)) {
      files.emplace_back(index);
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool holds_frames(const std::vector<fs::path> &files) {
  return std::any_of(files.begin(), files.end(), [](const fs::path &file) {
    const std::string name = file.filename().string();
    return file.parent_path() == "frames" && name.starts_with("frame_") && name.ends_with(".hdf");
  });
}

std::string text_of(const std::string &name) {
  return name;
}
std::string text_of(const fs::path &name) {
  return name.string();
}

// Reports names that only one side has; both lists are sorted.
template <class Name>
std::vector<Name> Comparison::names_in_both(const std::string &what, std::vector<Name> of_a,
                                            std::vector<Name> of_b) {
  std::vector<Name> only;
  std::set_difference(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), std::back_inserter(only));
  for (const Name &name : only) {
    add(what + text_of(name) + " is only in " + a_.string());
  }
  only.clear();
  std::set_difference(of_b.begin(), of_b.end(), of_a.begin(), of_a.end(), std::back_inserter(only));
  for (const Name &name : only) {
    add(what + text_of(name) + " is only in " + b_.string());
  }
  std::vector<Name> both;
  std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), std::back_inserter(both));
  return both;
}

std::string bytes_of(const fs::path &path) {
  std::ifstream stream(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (!stream.is_open() || stream.bad()) {
    throw FileError("cannot read " + path.string());
  }
  return bytes;
}

// Text or bytes of a dataset: where they part, counted from 0; -1 if they do not.
template <class Sequence> std::ptrdiff_t first_difference(const Sequence &a, const Sequence &b) {
  const auto where = std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first;
  return where == a.end() && a.size() == b.size() ? -1 : where - a.begin();
}

void Comparison::compare_bytes(const fs::path &name) {
  const std::string a = bytes_of(a_ / name);
  const std::ptrdiff_t where = first_difference(a, bytes_of(b_ / name));
  if (where >= 0) {
    const auto line = std::count(a.begin(), a.begin() + where, '\n') + 1;
    add(fmt::format("{}: differs from line {} on", name.string(), line));
  }
}

void Comparison::compare_contents(const fs::path &name, const hdf5::Content &a, const hdf5::Content &b) {
  const std::string where = name.string() + ": " + a.path;
  if (a.type != b.type) {
    add(fmt::format("{}: type {} and {}", where, a.type, b.type));
  } else if (a.shape != b.shape) {
    add(fmt::format("{}: shape ({}) and ({})", where, fmt::join(a.shape, ", "), fmt::join(b.shape, ", ")));
  } else if (const std::ptrdiff_t byte = first_difference(a.bytes, b.bytes); byte >= 0) {
    add(fmt::format("{}: differs from byte {} on, of {}", where, byte, a.bytes.size()));
  }
}

void Comparison::compare_hdf5(const fs::path &name) {
  const std::size_t before = differences_.size();
  const hdf5::File a = hdf5::open_to_read(a_ / name);
  const hdf5::File b = hdf5::open_to_read(b_ / name);
  for (const std::string &path :
       names_in_both(name.string() + ": ", hdf5::list_contents(a), hdf5::list_contents(b))) {
    compare_contents(name, hdf5::read_content(a, path), hdf5::read_content(b, path));
  }
  if (differences_.size() == before) {
    if (const std::ptrdiff_t byte = first_difference(bytes_of(a_ / name), bytes_of(b_ / name)); byte >= 0) {
      add(fmt::format("{}: the contents are equal, the file differs from byte {} on", name.string(), byte));
    }
  }
}

void Comparison::compare_file(const fs::path &name) {
  try {
    if (name.extension() == ".hdf" || name.extension() == ".h5") {
      compare_hdf5(name);
    } else {
      compare_bytes(name);
    }
  } catch (const FileError &error) {
    add(name.string() + ": " + error.what());
  }
}

std::vector<std::string> Comparison::run() {
  const std::vector<fs::path> of_a = files_of_run(a_);
  const std::vector<fs::path> of_b = files_of_run(b_);
  for (const auto &[directory, files] : {std::pair(a_, of_a), std::pair(b_, of_b)}) {
    if (!holds_frames(files)) {
      add("nothing to compare: no frame in " + directory.string());
    }
  }
  for (const fs::path &name : names_in_both("", of_a, of_b)) {
    if (differences_.size() == most_differences) {
      break;
    }
    compare_file(name);
  }
  return differences_;
}

} // namespace

std::vector<std::string> compare_runs(const fs::path &a, const fs::path &b) {
  return Comparison(a, b).run();
}

} // namespace gcpdda
