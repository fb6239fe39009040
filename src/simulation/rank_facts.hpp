#pragma once

// What a run tells of all its ranks.

#include "base/check.hpp"
#include "gcpdda/parallel/communicator.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <exception>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <vector>

namespace gcpdda {

/// Root's file work that may fail on the root alone: the verdict is shared before anybody throws.
template <class Work> void on_root(const Communicator &communicator, Work &&work) {
  std::string trouble;
  if (communicator.is_root()) {
    try {
      work();
    } catch (const std::exception &e) {
      trouble = e.what();
    }
  }
  communicator.broadcast(trouble);
  if (!trouble.empty()) {
    throw FileError(trouble);
  }
}

template <class T> std::int64_t total(const Communicator &communicator, T value) {
  auto sum = static_cast<std::int64_t>(value);
  communicator.sum(std::span(&sum, 1));
  return sum;
}

/// The (n/2)-th of everybody's positive numbers in ascending order. Positive doubles sort like their bits, so
/// bisecting the bits finds it exactly, whoever holds it.
inline double agreed_median(const Communicator &communicator, std::span<const double> sizes) {
  const std::int64_t wanted = total(communicator, sizes.size()) / 2;
  std::uint64_t low = 0;
  std::uint64_t high = std::bit_cast<std::uint64_t>(std::numeric_limits<double>::infinity());
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    const auto at_most = std::count_if(sizes.begin(), sizes.end(), [&](double size) {
      return std::bit_cast<std::uint64_t>(size) <= middle;
    });
    if (total(communicator, at_most) > wanted) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return std::bit_cast<double>(low);
}

/// {min, mean, max} of everybody's value.
inline std::array<double, 3> spread(const Communicator &communicator, double value) {
  std::array<double, 3> s{value, 0.0, value};
  const auto all = communicator.all_gather(std::vector<double>{value});
  for (const auto &v : all) {
    s = {std::min(s[0], v[0]), s[1] + v[0] / static_cast<double>(all.size()), std::max(s[2], v[0])};
  }
  return s;
}

/// max/mean of everybody's count.
inline double imbalance_of(const std::vector<std::int64_t> &counts) {
  const double sum = static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::int64_t{0}));
  const double most = static_cast<double>(*std::max_element(counts.begin(), counts.end()));
  return sum > 0.0 ? most * static_cast<double>(counts.size()) / sum : 1.0;
}

inline std::vector<std::int64_t> counts_by_rank(const Communicator &communicator, std::int64_t mine) {
  std::vector<std::int64_t> counts;
  for (const auto &count : communicator.all_gather(std::vector<std::int64_t>{mine})) {
    counts.push_back(count[0]);
  }
  return counts;
}

} // namespace gcpdda
