#include "statics/border_rows.hpp"

#include <cstring>
#include <type_traits>

namespace gcpdda::statics {

void BorderExchange::take(std::vector<BorderRows> rows) {
  rows_ = std::move(rows);
  doubles_ = {};
  floats_ = {};
}

template <class Number> BorderExchange::Round &BorderExchange::round_of(std::size_t width) {
  Round &round = std::is_same_v<Number, double> ? doubles_ : floats_;
  const std::size_t bytes = width * sizeof(Number);
  if (round.bytes_a_row == bytes) {
    return round;
  }
  round = {};
  round.bytes_a_row = bytes;
  std::vector<Communicator::Message> leaving;
  std::vector<Communicator::Message> arriving;
  round.sent.resize(rows_.size());
  round.received.resize(rows_.size());
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    round.sent[k].resize(rows_[k].send.size() * bytes);
    round.received[k].resize(rows_[k].receive.size() * bytes);
    if (!round.sent[k].empty()) {
      leaving.push_back({rows_[k].rank, round.sent[k]});
    }
    if (!round.received[k].empty()) {
      arriving.push_back({rows_[k].rank, round.received[k]});
    }
  }
  round.messages = MessageRound(communicator_, leaving, arriving);
  return round;
}

template <class Number> void BorderExchange::start(const FieldOf<Number> &field) {
  Round &round = round_of<Number>(field.width());
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    std::byte *to = round.sent[k].data();
    for (const std::uint32_t row : rows_[k].send) {
      std::memcpy(to, field.of(row), round.bytes_a_row);
      to += round.bytes_a_row;
    }
    all_sent_.messages += round.sent[k].empty() ? 0 : 1;
    all_sent_.bytes += std::ssize(round.sent[k]);
  }
  round.messages.start();
}

template <class Number> void BorderExchange::finish(FieldOf<Number> &field) {
  Round &round = round_of<Number>(field.width());
  round.messages.finish();
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const std::byte *from = round.received[k].data();
    for (const std::uint32_t row : rows_[k].receive) {
      std::memcpy(field.of(row), from, round.bytes_a_row);
      from += round.bytes_a_row;
    }
  }
}

template void BorderExchange::start(const FieldOf<double> &field);
template void BorderExchange::start(const FieldOf<float> &field);
template void BorderExchange::finish(FieldOf<double> &field);
template void BorderExchange::finish(FieldOf<float> &field);

} // namespace gcpdda::statics
