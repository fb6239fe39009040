#include "io/scene/record_file.hpp"

#include "base/check.hpp"
#include "base/input_file.hpp"
#include "base/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>

namespace gcpdda {

namespace {

constexpr double largest_number = 1e9;             // s, m/s, m/s2
constexpr std::int64_t longest_record = 512 << 20; // bytes; room for the most rows

class RecordReader {
public:
  explicit RecordReader(const std::string &path) : path_(&path) {}

  RecordReading read(std::string_view text) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF"; // of UTF-8, which spreadsheets write
    text.remove_prefix(text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0);
    int line = 0;
    for (std::size_t at = 0; at < text.size() && reading_.faults.size() < most_faults;) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      read_row(text.substr(at, end - at), ++line);
      at = end + 1;
    }
    if (reading_.faults.empty() && reading_.rows.size() < 2) {
      fault(std::max(line, 1), 1,
            fmt::format("a record of {} row{}", reading_.rows.size(), reading_.rows.size() == 1 ? "" : "s"),
            "it has at least two, time,x or time,x,y");
    } else if (reading_.rows.size() > most_rows) {
      fault(line, 1, fmt::format("a record of {} rows", reading_.rows.size()),
            fmt::format("at most {} are read", most_rows));
    }
    return std::move(reading_);
  }

private:
  static constexpr std::array<const char *, 3> names{"time", "x", "y"};
  static constexpr std::size_t most_faults = 20;
  static constexpr std::size_t most_rows = 10'000'000;

  void read_row(std::string_view row, int line) {
    if (trimmed(row).empty() || trimmed(row).starts_with('#')) {
      return;
    }
    const CsvRow<3> cells(row);
    const auto &[fields, columns, count] = cells;
    std::array<std::optional<double>, 3> numbers;
    for (std::size_t k = 0; k < std::min(count, fields.size()); ++k) {
      numbers[k] = to_number(fields[k], largest_number);
    }
    const bool is_heading = num_fields_ == 0 && !numbers[0] && !numbers[1];
    if (count < 2 || count > fields.size() || (num_fields_ != 0 && count != num_fields_)) {
      fault(line, 1, fmt::format("a row with {} field{}", count, count == 1 ? "" : "s"),
            num_fields_ == 0 ? "a row is time,x or time,x,y, separated by commas"
                             : fmt::format("the rows before have {}", num_fields_));
      return;
    }
    num_fields_ = count;
    if (!is_heading) {
      take(std::span(fields).first(count), columns, numbers, line);
    }
  }

  void take(std::span<const std::string_view> fields, const std::array<int, 3> &columns,
            const std::array<std::optional<double>, 3> &numbers, int line) {
    for (std::size_t k = 0; k < fields.size(); ++k) {
      if (!numbers[k]) {
        fault(line, columns[k],
              fmt::format("'{}' is no {}", printable(fields[k]), k == 0 ? "time" : "motion"),
              fields[k].find(';') != std::string_view::npos
                  ? std::string("commas part the numbers of a row, whose decimals have a point")
                  : fmt::format("{} is a number of at most {:g}", names[k], largest_number));
      }
    }
    const RecordRow row{numbers[0].value_or(0.0), {numbers[1].value_or(0.0), numbers[2].value_or(0.0)}};
    if (numbers[0] && last_time_ && !(row.time > *last_time_)) {
      fault(line, columns[0],
            fmt::format("the time {} is not above that of the row before, {}", row.time, *last_time_),
            "the rows of a record go on in time");
    }
    last_time_ = numbers[0] ? numbers[0] : last_time_;
    reading_.rows.push_back(row);
  }

  void fault(int line, int column, std::string what, std::string why) {
    reading_.faults.push_back(
        {Severity::error, {*path_, line, column}, std::move(what), std::move(why), "mend the file"});
  }

  const std::string *path_;
  RecordReading reading_;
  std::size_t num_fields_ = 0; ///< of a row; 0 before the first one
  std::optional<double> last_time_;
};

} // namespace

RecordReading read_record(std::string_view text, const std::string &path) {
  return RecordReader(path).read(text);
}

Diagnostics open_record(const Communicator &communicator, Scene &scene) {
  Earthquake &earthquake = scene.earthquake;
  if (!earthquake.shakes() || !earthquake.record.empty()) {
    return {};
  }
  InputFile file;
  if (communicator.is_root()) {
    file = read_input_file(earthquake.file, longest_record);
  }
  communicator.broadcast(file.trouble);
  if (!file.trouble.empty()) {
    const Diagnostic fault{Severity::error, earthquake.where,
                           fmt::format("cannot open the record '{}'", earthquake.file), file.trouble,
                           "its path starts from the folder of the scene"};
    std::int64_t is_missing = file.is_missing ? 1 : 0;
    communicator.max(std::span(&is_missing, 1));
    if (is_missing == 0) { // the scene is sound
      throw FileError(to_string(fault));
    }
    return {fault};
  }
  communicator.broadcast(file.text);
  RecordReading reading = read_record(file.text, earthquake.file);
  earthquake.record = std::move(reading.rows);
  return std::move(reading.faults);
}

} // namespace gcpdda
