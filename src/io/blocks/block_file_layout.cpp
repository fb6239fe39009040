#include "io/blocks/block_file_layout.hpp"

#include "base/input_file.hpp"
#include "io/hdf5/hdf5_input.hpp"
#include "io/scene/scene_faults.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gcpdda::block_file {

namespace {

/// All names that are one edit away: a character left out, added or replaced, or two neighbours exchanged.
std::vector<std::string> spellings_near(const std::string &name) {
  std::vector<std::string> spellings;
  for (std::size_t i = 0; i <= name.size(); ++i) {
    const std::string before = name.substr(0, i);
    const std::string from = name.substr(i);
    for (char c = 1; c < 127; ++c) {
      if (c == '/') { // of a path
        continue;
      }
      spellings.push_back(before + c + from);
      if (!from.empty()) {
        spellings.push_back(before + c + from.substr(1));
      }
    }
    if (!from.empty()) {
      spellings.push_back(before + from.substr(1));
    }
    if (from.size() > 1) {
      spellings.push_back(before + from[1] + from[0] + from.substr(2));
    }
  }
  return spellings;
}

std::string type_in_words(const hdf5::Datatype &type) {
  const std::size_t bits = 8 * H5Tget_size(type.get());
  switch (H5Tget_class(type.get())) {
  case H5T_FLOAT:
    return fmt::format("{}-bit reals", bits);
  case H5T_INTEGER:
    return fmt::format("{}{}-bit integers", H5Tget_sign(type.get()) == H5T_SGN_NONE ? "unsigned " : "", bits);
  case H5T_STRING:
    return "text";
  case H5T_ENUM:
    return "enumerated values, such as booleans";
  default:
    return "something that is no number";
  }
}

class Look {
public:
  explicit Look(const BlockFile &file) : block_file_(&file) {}

  Overview take() {
    if (open()) {
      count_other_members();
      for (std::size_t i = 0; i < count; ++i) {
        look_at_dataset(static_cast<Dataset>(i));
      }
      compare_rows();
    }
    return std::move(overview_);
  }

private:
  void fault(std::string what, std::string why, std::string hint) {
    overview_.faults.push_back(
        {Severity::error, {block_file_->path, 0, 0}, std::move(what), std::move(why), std::move(hint)});
  }

  bool open() {
    const std::string &path = block_file_->path;
    if (const InputFile file = look_at_input_file(path); !file.trouble.empty()) {
      const Diagnostic cannot_open{Severity::error, block_file_->where,
                                   fmt::format("cannot open the block file '{}'", path), file.trouble,
                                   "check the path, which starts from the folder of the scene"};
      if (!file.is_missing) { // the scene is sound
        throw FileError(to_string(cannot_open));
      }
      overview_.faults.push_back(cannot_open);
      return false;
    }
    if (H5Fis_hdf5(path.c_str()) <= 0) {
      fault("this is no HDF5 file", "[blocks] file names one", "check the path or write the blocks as HDF5");
      return false;
    }
    const hdf5::Properties access = hdf5::foreign_access();
    try {
      file_ = hdf5::open_to_read(path, access.get());
    } catch (const FileError &) {
      fault("the file is damaged or cut short", fmt::format("HDF5 says: {}", hdf5::last_error()),
            "write or copy it again");
      return false;
    }
    return true;
  }

  [[nodiscard]] bool has_member(const std::string &name) const {
    return H5Lexists(file_.get(), name.c_str(), H5P_DEFAULT) > 0;
  }

  // HDF5 1.10 frees memory that it never set when it fails to list the members of a damaged group, so nothing
  // is listed: members are counted and asked for by name.
  void count_other_members() {
    H5G_info_t group{};
    if (H5Gget_info(file_.get(), &group) < 0) {
      return;
    }
    const auto known = std::count_if(layout.begin(), layout.end(),
                                     [&](const auto &rule) { return has_member(std::string(rule.name)); });
    has_other_members_ = group.nlinks > static_cast<hsize_t>(known);
  }

  /// A member that is meant by `name`, or "".
  [[nodiscard]] std::string misspelt_member(const std::string &name) const {
    if (has_other_members_) {
      for (std::string &spelling : spellings_near(name)) {
        if (has_member(spelling)) {
          return std::move(spelling);
        }
      }
    }
    return "";
  }

  void look_at_dataset(Dataset which) {
    const DatasetRule &rule = layout[which];
    const std::string name(rule.name);
    if (!has_member(name)) {
      report_missing(rule);
      return;
    }
    const hdf5::Dataset dataset(H5Dopen2(file_.get(), name.c_str(), H5P_DEFAULT));
    if (dataset.get() < 0) {
      fault(fmt::format("'/{}' is not a dataset", name),
            fmt::format("it must hold {} {}", words_of(rule.number), shape_of(rule)),
            "write it as a dataset");
      return;
    }
    const hdf5::Datatype type(H5Dget_type(dataset.get()));
    const std::string found = type_in_words(type);
    if (found != words_of(rule.number)) {
      fault(fmt::format("'/{}' holds {}", name, found), fmt::format("it must hold {}", words_of(rule.number)),
            "convert it where the file is written");
    }
    if (const auto rows = rows_of(rule, dataset)) {
      if (is_filled(rule, dataset, *rows)) {
        rows_[which] = *rows;
      }
    }
  }

  void report_missing(const DatasetRule &rule) {
    const std::string name(rule.name);
    const std::string near = misspelt_member(name);
    if (rule.required) {
      fault(fmt::format("'/{}' is missing", name),
            fmt::format("it must hold {} {}", words_of(rule.number), shape_of(rule)),
            near.empty() ? "write it" : fmt::format("did you mean it by '/{}'?", scene_text::shown(near)));
    } else if (!near.empty()) {
      fault(fmt::format("unknown dataset '/{}'", scene_text::shown(near)), "",
            fmt::format("did you mean '/{}'?", name));
    }
  }

  std::optional<std::int64_t> rows_of(const DatasetRule &rule, const hdf5::Dataset &dataset) {
    const hdf5::Dataspace space(H5Dget_space(dataset.get()));
    const int dimensions = std::max(0, H5Sget_simple_extent_ndims(space.get()));
    std::vector<hsize_t> shape(static_cast<std::size_t>(dimensions));
    H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr);
    const bool fits = rule.columns == 1 ? shape.size() == 1 : shape.size() == 2 && shape[1] == rule.columns;
    if (fits) {
      return static_cast<std::int64_t>(shape[0]);
    }
    fault(fmt::format("'/{}' has shape ({})", rule.name, fmt::join(shape, ", ")),
          fmt::format("it must be {}", shape_of(rule)), "reshape it where the file is written");
    return std::nullopt;
  }

  // A few bytes can claim any shape; nothing compresses to less than a two-thousandth.
  bool is_filled(const DatasetRule &rule, const hdf5::Dataset &dataset, std::int64_t rows) {
    const hdf5::Datatype type(H5Dget_type(dataset.get()));
    const double bytes =
        static_cast<double>(rows) * static_cast<double>(rule.columns * H5Tget_size(type.get()));
    const auto stored = static_cast<double>(H5Dget_storage_size(dataset.get()));
    constexpr double densest = 2000.0;
    if (bytes <= densest * stored) {
      return true;
    }
    fault(fmt::format("'/{}' is not filled", rule.name),
          fmt::format("the file stores {:.0f} of its {:.0f} bytes", stored, bytes),
          "write all rows before the file is closed");
    return false;
  }

  void compare_rows() {
    if (const auto found = rows_.find(offsets); found != rows_.end()) {
      overview_.num_blocks = found->second - 1;
      if (overview_.num_blocks < 1) {
        fault("the file has no blocks", "'/offsets' has one entry more than there are blocks",
              "write at least one block, or leave [blocks] out");
        return;
      }
      for (const auto &[which, rows] : rows_) {
        if (layout[which].rows == Rows::blocks && rows != overview_.num_blocks) {
          fault(fmt::format("'/{}' has {} rows", layout[which].name, rows),
                fmt::format("'/offsets' has {} entries, which makes {} blocks", found->second,
                            overview_.num_blocks),
                "write one row for each block");
        }
      }
    }
    if (const auto found = rows_.find(points); found != rows_.end()) {
      overview_.num_points = found->second;
      if (const auto edges = rows_.find(edge_joint); edges != rows_.end() && edges->second != found->second) {
        fault(fmt::format("'/edge_joint' has {} rows", edges->second),
              fmt::format("'/points' has {}, and each begins an edge", found->second),
              "write one row for each point");
      }
    }
  }

  const BlockFile *block_file_;
  const hdf5::QuietErrors quiet_;
  hdf5::File file_;
  bool has_other_members_ = false;       ///< than those of the layout
  std::map<Dataset, std::int64_t> rows_; ///< of the datasets without faults of shape
  Overview overview_;
};

} // namespace

std::string_view words_of(Number number) {
  constexpr std::array<std::string_view, 4> words{"64-bit reals", "64-bit integers", "32-bit integers",
                                                  "unsigned 8-bit integers"};
  return words[static_cast<std::size_t>(number)];
}

std::string_view shape_of(const DatasetRule &rule) {
  if (rule.rows == Rows::points) {
    return "(n, 2)";
  }
  if (rule.rows == Rows::edges) {
    return "(n)";
  }
  if (rule.rows == Rows::blocks_and_one) {
    return "(nb + 1)";
  }
  return rule.columns == 1 ? "(nb)" : "(nb, 3)";
}

Overview look_at(const BlockFile &file) {
  return Look(file).take();
}

} // namespace gcpdda::block_file
