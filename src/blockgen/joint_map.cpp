#include "blockgen/joint_map.hpp"

#include "base/text.hpp"

#include <geos_c.h>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

namespace gcpdda {

namespace {

constexpr double largest_coordinate = 1e9;
constexpr std::size_t most_faults = 20;

class CsvReader {
public:
  explicit CsvReader(const std::string &path) : path_(&path) {}

  JointMapReading read(std::string_view text) {
    int line = 0;
    for (std::size_t at = 0; at < text.size() && reading_.faults.size() < most_faults;) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      read_row(text.substr(at, end - at), ++line);
      at = end + 1;
    }
    close_trace();
    if (reading_.lines.empty() && reading_.faults.empty()) {
      fault(std::max(line, 1), 1, "no trace in the file", "a trace has at least two rows trace,x,y");
    }
    return std::move(reading_);
  }

private:
  void read_row(std::string_view row, int line) {
    if (trimmed(row).empty() || trimmed(row).starts_with('#')) {
      return;
    }
    const CsvRow<3> cells(row);
    const auto &[fields, columns, count] = cells;
    if (count != fields.size()) {
      fault(line, 1, fmt::format("a row with {} field{}", count, count == 1 ? "" : "s"),
            "a row is trace,x,y");
      return;
    }
    const auto x = to_number(fields[1], largest_coordinate);
    const auto y = to_number(fields[2], largest_coordinate);
    const bool is_heading = !has_rows_ && !x && !y;
    has_rows_ = true;
    if (is_heading) {
      return;
    }
    for (const std::size_t k : {std::size_t{1}, std::size_t{2}}) {
      if (!(k == 1 ? x : y)) {
        fault(line, columns[k], fmt::format("'{}' is no coordinate", printable(fields[k])),
              fmt::format("{} is a number of at most {:g} m", k == 1 ? "x" : "y", largest_coordinate));
      }
    }
    if (trace_.empty() || fields[0] != name_) {
      close_trace();
      name_ = fields[0];
      first_line_ = line;
    }
    trace_.push_back({x.value_or(0.0), y.value_or(0.0)});
  }

  void close_trace() {
    if (trace_.size() == 1) {
      fault(first_line_, 1, fmt::format("trace '{}' has one row", printable(name_)),
            "a trace has at least two rows, one after the other");
    } else if (!trace_.empty()) {
      reading_.lines.push_back(trace_);
    }
    trace_.clear();
  }

  void fault(int line, int column, std::string what, std::string why) {
    reading_.faults.push_back(
        {Severity::error, {*path_, line, column}, std::move(what), std::move(why), "mend the file"});
  }

  const std::string *path_;
  JointMapReading reading_;
  std::vector<Vec2> trace_;
  std::string name_;
  int first_line_ = 0;
  bool has_rows_ = false;
};

/// Rewrites what RFC 7946 allows and the reader of GEOS refuses: coordinates beyond the second, and features
/// without a geometry, which become features with an empty one. Only the latter move what follows in a line.
class GeoJsonForGeos {
public:
  explicit GeoJsonForGeos(std::string text) : text_(std::move(text)) {}

  std::string rewritten() {
    std::size_t bracket = std::string::npos; // that opened last
    for (std::size_t at = 0; at < text_.size(); ++at) {
      switch (text_[at]) {
      case '"': {
        const std::size_t end = end_of_string(at);
        if (std::string_view(text_).substr(at, end - at) == "\"geometry\"") {
          fill_geometry(end);
        }
        bracket = std::string::npos;
        at = end - 1;
        break;
      }
      case '[':
        bracket = at;
        break;
      case ']':
        if (bracket != std::string::npos) {
          blank_beyond_two(bracket, at);
        }
        bracket = std::string::npos;
        break;
      default:
        break;
      }
    }
    return std::move(text_);
  }

private:
  /// One past the closing quote.
  [[nodiscard]] std::size_t end_of_string(std::size_t at) const {
    for (++at; at < text_.size() && text_[at] != '"'; ++at) {
      at += text_[at] == '\\' ? 1 : 0;
    }
    return std::min(at + 1, text_.size());
  }

  /// @param at  one past the key
  void fill_geometry(std::size_t at) {
    constexpr const char *space = " \t\r\n";
    constexpr std::string_view null = "null";
    const std::size_t colon = text_.find_first_not_of(space, at);
    if (colon == std::string::npos || text_[colon] != ':') {
      return;
    }
    const std::size_t value = text_.find_first_not_of(space, colon + 1);
    if (value != std::string::npos && text_.compare(value, null.size(), null) == 0) {
      text_.replace(value, null.size(), R"({"type":"GeometryCollection","geometries":[]})");
    }
  }

  /// Of an array that is numbers alone, by spaces, so that all else stays where it is.
  void blank_beyond_two(std::size_t open, std::size_t close) {
    const std::string_view array = std::string_view(text_).substr(open + 1, close - open - 1);
    const std::size_t second = array.find(',', array.find(',') + 1);
    const bool has_more = array.find(',') != std::string_view::npos && second != std::string_view::npos;
    if (has_more && array.find_first_not_of("0123456789+-.eE, \t\r\n") == std::string_view::npos &&
        !trimmed(array.substr(array.rfind(',') + 1)).empty()) {
      for (std::size_t at = open + 1 + second; at < close; ++at) {
        text_[at] = text_[at] == '\n' ? '\n' : ' ';
      }
    }
  }

  std::string text_;
};

class GeoJsonReader {
public:
  explicit GeoJsonReader(const std::string &path) : path_(&path), handle_(GEOS_init_r()) {
    GEOSContext_setErrorMessageHandler_r(
        handle_,
        [](const char *message, void *self) { static_cast<GeoJsonReader *>(self)->trouble_ = message; },
        this);
  }
  ~GeoJsonReader() { GEOS_finish_r(handle_); }
  GeoJsonReader(const GeoJsonReader &) = delete;
  GeoJsonReader &operator=(const GeoJsonReader &) = delete;

  JointMapReading read(std::string_view given) {
    const std::string text = GeoJsonForGeos(std::string(given)).rewritten();
    GEOSGeoJSONReader *reader = GEOSGeoJSONReader_create_r(handle_);
    GEOSGeometry *geometry = GEOSGeoJSONReader_readGeometry_r(handle_, reader, text.c_str());
    GEOSGeoJSONReader_destroy_r(handle_, reader);
    if (geometry == nullptr) {
      report_syntax();
      return std::move(reading_);
    }
    take(geometry);
    GEOSGeom_destroy_r(handle_, geometry);
    if (reading_.lines.empty() && reading_.faults.empty()) {
      fault(1, 1, "no trace in the file", "it holds neither LineString nor MultiLineString");
    }
    return std::move(reading_);
  }

private:
  // GEOS says "... at line 3, column 7: ..." of texts that are no JSON.
  void report_syntax() {
    int line = 1;
    int column = 1;
    if (const std::size_t at = trouble_.find("at line "); at != std::string::npos) {
      std::sscanf(trouble_.c_str() + at, "at line %d, column %d", &line, &column); // NOLINT(cert-err34-c)
    }
    fault(line, column, "not valid GeoJSON", shown_whole(trouble_));
  }

  static std::string shown_whole(const std::string &text) {
    std::string result;
    for (std::size_t at = 0; at < std::min<std::size_t>(text.size(), 200); at += 40) {
      result += printable(std::string_view(text).substr(at));
    }
    return result;
  }

  void take(const GEOSGeometry *geometry) {
    if (GEOSGeomTypeId_r(handle_, geometry) == GEOS_LINESTRING) {
      take_line(geometry);
      return;
    }
    const int n = GEOSGetNumGeometries_r(handle_, geometry);
    for (int k = 0; k < n; ++k) {
      if (const GEOSGeometry *part = GEOSGetGeometryN_r(handle_, geometry, k); part != geometry) {
        take(part);
      }
    }
  }

  void take_line(const GEOSGeometry *line) {
    const GEOSCoordSequence *sequence = GEOSGeom_getCoordSeq_r(handle_, line);
    unsigned n = 0;
    GEOSCoordSeq_getSize_r(handle_, sequence, &n);
    std::vector<Vec2> points(n);
    for (unsigned k = 0; k < n; ++k) {
      GEOSCoordSeq_getXY_r(handle_, sequence, k, &points[k].x, &points[k].y);
      if (!(std::abs(points[k].x) <= largest_coordinate && std::abs(points[k].y) <= largest_coordinate)) {
        fault(1, 1,
              fmt::format("line {} has the point [{}, {}]", reading_.lines.size(), points[k].x, points[k].y),
              fmt::format("coordinates are numbers of at most {:g} m", largest_coordinate));
        return;
      }
    }
    if (n >= 2) {
      reading_.lines.push_back(std::move(points));
    }
  }

  void fault(int line, int column, std::string what, std::string why) {
    reading_.faults.push_back(
        {Severity::error, {*path_, line, column}, std::move(what), std::move(why), "mend the file"});
  }

  const std::string *path_;
  GEOSContextHandle_t handle_;
  std::string trouble_;
  JointMapReading reading_;
};

} // namespace

JointMapReading read_joint_map(std::string_view text, const std::string &path) {
  const std::string extension = lower_case(std::filesystem::path(path).extension().string());
  if (extension == ".geojson" || extension == ".json") {
    return GeoJsonReader(path).read(text);
  }
  return CsvReader(path).read(text);
}

} // namespace gcpdda
