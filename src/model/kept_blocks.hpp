#pragma once

// Blocks that are made once, for runs of the same scene one after another.

#include "model/block_source.hpp"

#include <memory>
#include <optional>
#include <utility>

namespace gcpdda {

/// What another source has made stays in memory, a few hundred bytes a block, and is given again where the
/// same tiles are asked for. For one thread.
class KeptBlocks : public BlockSource {
public:
  explicit KeptBlocks(std::shared_ptr<const BlockSource> source) : source_(std::move(source)) {}

  [[nodiscard]] std::int64_t num_tiles() const override { return source_->num_tiles(); }
  [[nodiscard]] double expected_blocks() const override { return source_->expected_blocks(); }
  [[nodiscard]] double expected_seconds() const override { return source_->expected_seconds(); }
  [[nodiscard]] Made make(std::int64_t first, std::int64_t last) const override {
    if (!made_ || first != first_ || last != last_) {
      made_.reset(); // never two of them
      made_ = source_->make(first, last);
      first_ = first;
      last_ = last;
    }
    return *made_;
  }

private:
  std::shared_ptr<const BlockSource> source_;
  mutable std::optional<Made> made_; ///< of the tiles [first_, last_)
  mutable std::int64_t first_ = 0;
  mutable std::int64_t last_ = 0;
};

} // namespace gcpdda
