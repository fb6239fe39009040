#include "io/checkpoint/checkpoint_facts.hpp"

#include "io/checkpoint/checkpoint_layout.hpp"
#include "io/hdf5/hdf5_input.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <string>
#include <vector>

namespace gcpdda {

namespace {

std::int64_t only_number(const hdf5::File &file, const char *name) {
  const auto values = hdf5::read_numbers<std::int64_t>(file, name);
  if (values.size() != 1) {
    throw FileError(fmt::format("{} is not one number", name));
  }
  return values.front();
}

std::vector<ResultFile> read_results(const hdf5::File &file) {
  const auto names = hdf5::read_numbers<std::uint8_t>(file, checkpoint::result_names);
  const auto bytes = hdf5::read_numbers<std::int64_t>(file, checkpoint::result_bytes);
  const auto rows = hdf5::read_numbers<std::int64_t>(file, checkpoint::result_rows);
  if (std::count(names.begin(), names.end(), '\n') != std::ssize(bytes) || rows.size() != bytes.size()) {
    throw FileError(fmt::format("{} and its sizes are not equally many", checkpoint::result_names));
  }
  std::vector<ResultFile> results(bytes.size());
  auto begin = names.begin();
  for (std::size_t k = 0; k < results.size(); ++k) {
    const auto end = std::find(begin, names.end(), '\n');
    results[k] = {std::string(begin, end), bytes[k], rows[k]};
    begin = end + 1;
  }
  return results;
}

} // namespace

FoundCheckpoint look_at(const std::filesystem::path &path) {
  const hdf5::QuietErrors quiet;
  const hdf5::File file(hdf5::open_to_read(path));
  FoundCheckpoint found;
  found.path = path;
  RunFacts &facts = found.facts;
  facts.step = only_number(file, "/clock/step");
  facts.contact_steps = only_number(file, "/run/contact_steps");
  facts.scene = {only_number(file, "/scene/num_blocks"),
                 only_number(file, "/scene/num_mobile"),
                 static_cast<std::uint64_t>(only_number(file, "/scene/blocks")),
                 static_cast<std::uint64_t>(only_number(file, "/scene/materials")),
                 {}};
  const auto parts = hdf5::read_numbers<std::int64_t>(file, checkpoint::scene_parts);
  if (parts.size() != facts.scene.parts.size()) {
    throw FileError(fmt::format("{} has {} numbers", checkpoint::scene_parts, parts.size()));
  }
  std::copy(parts.begin(), parts.end(), facts.scene.parts.begin());
  for (const auto &[name, member] : checkpoint::real_facts) {
    const auto values = hdf5::read_numbers<double>(file, name);
    if (values.size() != 1) {
      throw FileError(fmt::format("{} is not one number", name));
    }
    facts.*member = values.front();
  }
  for (const auto &[name, member] : checkpoint::real_lists) {
    facts.*member = hdf5::read_numbers<double>(file, name);
  }
  for (const auto &[name, member] : checkpoint::whole_lists) {
    facts.*member = hdf5::read_numbers<std::int64_t>(file, name);
  }
  facts.results = read_results(file);
  found.checksum = only_number(file, checkpoint::checksum);
  return found;
}

} // namespace gcpdda
