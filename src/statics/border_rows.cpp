#include "statics/border_rows.hpp"

#include <algorithm>

namespace gcpdda::statics {

void BorderExchange::copy(Field &field) {
  if (rows_.empty()) {
    return;
  }
  const std::size_t width = field.width();
  sent_.resize(rows_.size());
  received_.resize(rows_.size());
  std::vector<Communicator::Message> leaving;
  std::vector<Communicator::Message> arriving;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    sent_[k].clear();
    for (const std::uint32_t row : rows_[k].send) {
      sent_[k].insert(sent_[k].end(), field.of(row), field.of(row) + width);
    }
    received_[k].resize(rows_[k].receive.size() * width);
    if (!sent_[k].empty()) {
      leaving.push_back({rows_[k].rank, std::as_writable_bytes(std::span(sent_[k]))});
    }
    if (!received_[k].empty()) {
      arriving.push_back({rows_[k].rank, std::as_writable_bytes(std::span(received_[k]))});
    }
  }
  communicator_.exchange(leaving, arriving);
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const double *from = received_[k].data();
    for (const std::uint32_t row : rows_[k].receive) {
      std::copy_n(from, width, field.of(row));
      from += width;
    }
  }
}

} // namespace gcpdda::statics
