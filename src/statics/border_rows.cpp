#include "statics/border_rows.hpp"

#include <algorithm>
#include <span>

namespace gcpdda::statics {

template <class Number> void BorderExchange::copy(FieldOf<Number> &field) {
  if (rows_.empty()) {
    return;
  }
  const std::size_t bytes = field.width() * sizeof(Number);
  const auto row_of = [&](std::uint32_t row) {
    return std::as_writable_bytes(std::span(field.of(row), field.width()));
  };
  sent_.resize(rows_.size());
  received_.resize(rows_.size());
  std::vector<Communicator::Message> leaving;
  std::vector<Communicator::Message> arriving;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    sent_[k].clear();
    for (const std::uint32_t row : rows_[k].send) {
      const std::span<std::byte> of_row = row_of(row);
      sent_[k].insert(sent_[k].end(), of_row.begin(), of_row.end());
    }
    received_[k].resize(rows_[k].receive.size() * bytes);
    if (!sent_[k].empty()) {
      leaving.push_back({rows_[k].rank, sent_[k]});
      ++all_sent_.messages;
      all_sent_.bytes += std::ssize(sent_[k]);
    }
    if (!received_[k].empty()) {
      arriving.push_back({rows_[k].rank, received_[k]});
    }
  }
  communicator_.exchange(leaving, arriving);
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const std::byte *from = received_[k].data();
    for (const std::uint32_t row : rows_[k].receive) {
      std::copy_n(from, bytes, row_of(row).data());
      from += bytes;
    }
  }
}

template void BorderExchange::copy(FieldOf<double> &field);
template void BorderExchange::copy(FieldOf<float> &field);

} // namespace gcpdda::statics
