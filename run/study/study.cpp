#include "study.hpp"

#include "support/setting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <stdexcept>

namespace gcpdda::study {

Table::Table(const std::filesystem::path &path, const std::vector<std::string> &columns)
    : file_(path), num_columns_(columns.size()) {
  file_ << fmt::format("{}\n", fmt::join(columns, ",")) << std::flush;
  if (!file_) {
    throw std::runtime_error("cannot write " + path.string());
  }
}

void Table::add(const std::vector<Cell> &row) {
  if (row.size() != num_columns_) {
    throw std::logic_error(
        fmt::format("a row of {} cells in a table of {} columns", row.size(), num_columns_));
  }
  std::vector<std::string> cells;
  for (const Cell &cell : row) {
    cells.push_back(std::visit([](const auto &value) { return fmt::format("{}", value); }, cell));
  }
  file_ << fmt::format("{}\n", fmt::join(cells, ",")) << std::flush;
}

double cpu_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Cost advance(Simulation &simulation, double time) {
  const Counters before = simulation.counters();
  const std::int64_t steps_before = simulation.step_count();
  const double start = cpu_seconds();
  testing::advance(simulation, time);
  Cost cost;
  cost.cpu = cpu_seconds() - start;
  cost.evaluations = simulation.counters().evaluations - before.evaluations;
  cost.contact_steps = simulation.counters().contact_steps - before.contact_steps;
  cost.steps = simulation.step_count() - steps_before;
  return cost;
}

double stiffness(double height, double block_size, double allowed_overlap) {
  return testing::rock_density * testing::earth_gravity * height / (allowed_overlap * block_size);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

} // namespace gcpdda::study
