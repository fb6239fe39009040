#pragma once

// Where the entries of each row begin in an array that holds those of all rows one after the other.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <vector>

namespace gcpdda {

/// Where the entries of each row begin in a flat list that few rows have entries in: row i owns
/// [offsets[i], offsets[i + 1]). As a vector with one number more than rows, the first one 0, but without
/// memory while the list is empty.
class RowOffsets {
public:
  RowOffsets() = default;
  RowOffsets(std::initializer_list<std::uint32_t> offsets) {
    for (const std::uint32_t *end = offsets.begin() + 1; end < offsets.end(); ++end) {
      push_back(*end);
    }
  }

  [[nodiscard]] std::uint32_t operator[](std::size_t row) const {
    return offsets_.empty() ? 0 : offsets_[row];
  }
  [[nodiscard]] std::uint32_t back() const { return (*this)[size_ - 1]; }
  [[nodiscard]] std::size_t size() const { return size_; }

  /// One more row, whose entries end there.
  void push_back(std::uint32_t end) {
    ++size_;
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
    for (std::size_t behind = row + 1; behind < size_; ++behind) {
      offsets_[behind] = static_cast<std::uint32_t>(offsets_[behind] + by);
    }
  }
  /// To no more than there are.
  void resize(std::size_t size) {
    size_ = size;
    if (!offsets_.empty()) {
      offsets_.resize(size);
    }
  }
  /// No rows.
  void clear() { *this = {}; }
  void reserve(std::size_t size) { reserved_ = std::max(reserved_, size); }
  [[nodiscard]] std::size_t capacity() const { return offsets_.capacity(); }

private:
  void make_room() {
    offsets_.reserve(std::max(reserved_, size_));
    offsets_.assign(size_, 0);
  }

  std::vector<std::uint32_t> offsets_; ///< none while all are 0
  std::size_t size_ = 1;
  std::size_t reserved_ = 0; ///< for when there are some
};

} // namespace gcpdda
