#pragma once

#include "gcpdda/io/frame_rows.hpp"
#include "gcpdda/io/frame_writer.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

namespace gcpdda::testing {

/// Rows of this rank in any order; vertices are concatenated in the order of `rows`.
struct FrameData {
  std::vector<FrameRow> rows;
  std::vector<Vec2> vertices;
};

/// A frame of given rows.
class GivenFrame : public FrameSource {
public:
  explicit GivenFrame(FrameData data) : data_(std::move(data)), first_vertex_(data_.rows.size()) {
    std::size_t vertex = 0;
    for (std::size_t k = 0; k < data_.rows.size(); ++k) {
      first_vertex_[k] = vertex;
      vertex += static_cast<std::size_t>(data_.rows[k].num_vertices);
    }
    order_.resize(data_.rows.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::size_t a, std::size_t b) { return data_.rows[a].block < data_.rows[b].block; });
  }
  [[nodiscard]] std::int64_t num_rows() const override { return std::ssize(data_.rows); }
  void append(std::int64_t first, std::int64_t last, std::vector<FrameRow> &rows,
              std::vector<Vec2> &vertices) const override {
    const auto begin =
        std::lower_bound(order_.begin(), order_.end(), first,
                         [&](std::size_t k, std::int64_t block) { return data_.rows[k].block < block; });
    for (auto k = begin; k != order_.end() && data_.rows[*k].block < last; ++k) {
      const FrameRow &row = data_.rows[*k];
      rows.push_back(row);
      const auto vertex = data_.vertices.begin() + static_cast<std::ptrdiff_t>(first_vertex_[*k]);
      vertices.insert(vertices.end(), vertex, vertex + row.num_vertices);
    }
  }

private:
  FrameData data_;
  std::vector<std::size_t> first_vertex_;
  std::vector<std::size_t> order_; ///< by block
};

/// The same for contacts.
class GivenContacts : public ContactSource {
public:
  explicit GivenContacts(std::vector<ContactRow> rows) : rows_(std::move(rows)) {
    std::sort(rows_.begin(), rows_.end(), [](const ContactRow &a, const ContactRow &b) {
      return std::tie(a.lower, a.higher, a.position) < std::tie(b.lower, b.higher, b.position);
    });
  }
  [[nodiscard]] std::int64_t count(std::int64_t first, std::int64_t last) const override {
    return at(last) - at(first);
  }
  void append(std::int64_t first, std::int64_t last, std::vector<ContactRow> &rows) const override {
    rows.insert(rows.end(), at(first), at(last));
  }

private:
  [[nodiscard]] std::vector<ContactRow>::const_iterator at(std::int64_t lower) const {
    return std::lower_bound(rows_.begin(), rows_.end(), lower,
                            [](const ContactRow &row, std::int64_t id) { return row.lower < id; });
  }

  std::vector<ContactRow> rows_;
};

} // namespace gcpdda::testing
