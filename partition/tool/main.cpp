// gcpdda-partition: cell weights in, owners out. For trying decompositions without a run; the library does
// not touch files.

#include "base/check.hpp"
#include "base/input_file.hpp"
#include "base/standard_output.hpp"
#include "gcpdda/base/diagnostic.hpp"
#include "partition/domain_map.hpp"
#include "partition/partition_cells.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <iostream>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

using namespace gcpdda;

enum ExitCode { done = 0, internal = 1, usage = 2, bad_input = 3, file_trouble = 4 };

struct BadInput {
  Diagnostic what;
};

struct Number {
  std::int64_t value;
  SourcePosition where;
};

constexpr std::string_view separators = " \t,;\r";
constexpr std::int64_t longest_file = 1 << 30; // bytes

Number parse(std::string_view word, const SourcePosition &where) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size() || value < 0) {
    throw BadInput{{.where = where,
                    .what = "'" + std::string(word) + "' is not a weight",
                    .why = "weights are whole numbers from 0 to 2^63-1",
                    .hint = "round or scale them"}};
  }
  return {value, where};
}

std::vector<Number> numbers_in(const std::string &text, const std::string &file) {
  std::vector<Number> numbers;
  std::istringstream lines(text);
  int line_number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++line_number;
    std::size_t begin = line.find_first_not_of(separators);
    while (begin != std::string::npos) {
      const std::size_t end = std::min(line.find_first_of(separators, begin), line.size());
      const SourcePosition where{file, line_number, static_cast<int>(begin) + 1};
      numbers.push_back(parse(std::string_view(line).substr(begin, end - begin), where));
      begin = line.find_first_not_of(separators, end);
    }
  }
  return numbers;
}

struct Work {
  CellGrid grid;
  std::vector<std::int64_t> weights;
};

Work work_in(const std::string &text, const std::string &file) {
  const std::vector<Number> numbers = numbers_in(text, file);
  if (numbers.size() < 2) {
    throw BadInput{{.where = {file, 1, 1},
                    .what = "no header",
                    .why = "the first two numbers are columns and rows",
                    .hint = "begin with a line like '100 50'"}};
  }
  Work work;
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
    if (numbers[i].value < 1 || numbers[i].value > max_background_cells) {
      throw BadInput{{.where = numbers[i].where,
                      .what = std::to_string(numbers[i].value) + (i == 0 ? " columns" : " rows"),
                      .why = "a grid has 1 to " + std::to_string(max_background_cells) + " cells",
                      .hint = ""}};
    }
  }
  work.grid.columns = static_cast<std::int32_t>(numbers[0].value);
  work.grid.rows = static_cast<std::int32_t>(numbers[1].value);
  const auto given = static_cast<std::int64_t>(numbers.size()) - 2;
  if (given != work.grid.num_cells()) {
    const bool too_many = given > work.grid.num_cells();
    throw BadInput{{.where = too_many ? numbers[static_cast<std::size_t>(work.grid.num_cells()) + 2].where
                                      : numbers.back().where,
                    .what = (too_many ? "too many weights: " : "too few weights: ") + std::to_string(given),
                    .why = "columns x rows is " + std::to_string(work.grid.num_cells()),
                    .hint = "give one weight for each cell, row by row from the lower left"}};
  }
  std::int64_t room = max_total_weight;
  for (std::size_t i = 2; i < numbers.size(); ++i) {
    if (numbers[i].value > room) {
      throw BadInput{{.where = numbers[i].where,
                      .what = "the sum of the weights exceeds 2^58 here",
                      .why = "sums are kept in 64-bit integers",
                      .hint = "divide all weights by a common number"}};
    }
    room -= numbers[i].value;
    work.weights.push_back(numbers[i].value);
  }
  return work;
}

std::string read_all(const std::string &path) {
  if (path == "-") {
    std::ostringstream text;
    text << std::cin.rdbuf();
    return text.str();
  }
  InputFile file = read_input_file(path, longest_file);
  if (!file.trouble.empty()) {
    throw FileError(path + ": cannot be read, " + file.trouble);
  }
  return std::move(file.text);
}

void print_owners(const DomainMap &map) {
  for (std::size_t i = 0; i < map.owner.size(); ++i) {
    const bool ends_row = (i + 1) % static_cast<std::size_t>(map.grid.columns) == 0;
    std::cout << map.owner[i] << (ends_row ? '\n' : ',');
  }
  flush_standard_output();
}

void partition(const std::string &path, int num_parts) {
  const Work work = work_in(read_all(path), path == "-" ? "stdin" : path);
  PartitionReport report;
  print_owners(partition_cells(work.grid, work.weights, num_parts, &report));
  std::cerr << num_parts << " parts by " << (report.by_metis ? "METIS" : "the Hilbert curve")
            << ": imbalance " << report.imbalance << ", edge cut " << report.edge_cut << ", "
            << report.empty_parts << " empty\n";
}

} // namespace

int main(int argc, char **argv) try {
  CLI::App app("Cut a grid of weighted cells into parts of equal weight with short borders.");
  std::string path;
  int num_parts = 1;
  app.add_option("weights", path,
                 "text or CSV: columns, rows, then the weights row by row from the lower left; - for stdin")
      ->required();
  app.add_option("--parts", num_parts, "number of parts")->required()->check(CLI::Range(1, 1'000'000));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError &error) {
    return app.exit(error) == 0 ? done : usage;
  }
  partition(path, num_parts);
  return done;
} catch (const BadInput &error) {
  std::cerr << to_string(error.what) << '\n';
  return bad_input;
} catch (const FileError &error) {
  std::cerr << error.what() << '\n';
  return file_trouble;
} catch (const std::exception &error) {
  std::cerr << "internal error: " << error.what() << '\n';
  return internal;
}
