#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <vector>

namespace gcpdda {

/// Where the entries of each row begin in a flat list that few rows have entries in: row i owns
/// [offsets[i], offsets[i + 1]). Takes no memory while the list is empty.
class RowOffsets {
public:
  RowOffsets() = default;
  /// One more than rows, the first one 0.
  RowOffsets(std::initializer_list<std::uint32_t> offsets) {
    for (const std::uint32_t *end = offsets.begin() + 1; end < offsets.end(); ++end) {
      push_back(*end);
    }
  }

  [[nodiscard]] std::uint32_t operator[](std::size_t row) const {
    return offsets_.empty() ? 0 : offsets_[row];
  }
  [[nodiscard]] std::uint32_t back() const { return (*this)[num_rows_]; }
  [[nodiscard]] std::size_t num_rows() const { return num_rows_; }

  /// One more row, whose entries end there.
  void push_back(std::uint32_t end) {
    ++num_rows_;
    if (!offsets_.empty()) {
      offsets_.push_back(end);
    } else if (end > 0) {
      make_room();
      offsets_.back() = end;
    }
  }
  /// So many more entries of a row; those behind it follow.
  void lengthen(std::size_t row, std::int64_t by) {
    if (by == 0) {
      return;
    }
    if (offsets_.empty()) {
      make_room();
    }
    for (std::size_t behind = row + 1; behind <= num_rows_; ++behind) {
      offsets_[behind] = static_cast<std::uint32_t>(offsets_[behind] + by);
    }
  }
  /// Keep so many rows.
  void resize(std::size_t num_rows) {
    num_rows_ = num_rows;
    if (!offsets_.empty()) {
      offsets_.resize(num_rows + 1);
    }
  }
  void clear() { *this = {}; }
  void reserve(std::size_t num_rows) { most_rows_ = std::max(most_rows_, num_rows); }
  [[nodiscard]] std::size_t capacity() const { return offsets_.capacity(); }

private:
  void make_room() {
    offsets_.reserve(std::max(most_rows_, num_rows_) + 1);
    offsets_.assign(num_rows_ + 1, 0);
  }

  std::vector<std::uint32_t> offsets_; ///< none while all are 0
  std::size_t num_rows_ = 0;
  std::size_t most_rows_ = 0;
};

} // namespace gcpdda
