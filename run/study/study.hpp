#pragma once

// What the studies share: tables, the cost of stepping, and the rule by which every scene gets its stiffness.

#include "simulation/simulation.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <variant>
#include <vector>

namespace gcpdda::study {

struct Options {
  std::filesystem::path folder; ///< of the tables, exists
  bool quick = false;           ///< fewer points, never fewer problems
};

/// A CSV file, written row by row so that a stopped study leaves what it has. Numbers are written so that
/// they read back equal.
class Table {
public:
  using Cell = std::variant<std::string, double, std::int64_t>;
  /// @throws std::runtime_error  the file cannot be written
  Table(const std::filesystem::path &path, const std::vector<std::string> &columns);
  void add(const std::vector<Cell> &row);

private:
  std::ofstream file_;
  std::size_t num_columns_;
};

/// What stepping took on this rank.
struct Cost {
  double cpu = 0.0;               ///< s of the process
  std::int64_t evaluations = 0;   ///< candidate pairs whose boxes met, over all steps
  std::int64_t contact_steps = 0; ///< touching pairs over all steps
  std::int64_t steps = 0;
};

/// CPU time of this process, s.
double cpu_seconds();

/// Step to a time or to a fault, counting.
Cost advance(Simulation &simulation, double time);

/// The one stiffness rule of all studies: k_n = rho |g| h/(e L), joints that close by the share e of a
/// block's size under the weight of the model, with earth gravity also where a scene has none. h: height of
/// the model, m; L: size of a block, m. Pa/m.
double stiffness(double height, double block_size, double allowed_overlap = 1e-3);

double median(std::vector<double> values);

/// The studies; each writes its tables to the folder and what it found to stdout.
void stability(const Options &options);
void accuracy(const Options &options);
void fidelity(const Options &options);
void flutter(const Options &options);

} // namespace gcpdda::study
