// The kernels of plain_batch.hpp for the instruction set of the build.

#include "base/lanes_of_build.hpp"

#include "contact/lanes/plain_kernel.hpp"

#include <utility>

namespace gcpdda {

const RegionState PlainLanes::no_memory{.slip = -1.0};

std::unique_ptr<PlainBatch> make_plain_batch(Instructions instructions) {
  std::unique_ptr<PlainBatch> batch;
  if (instructions == Instructions::widest) {
    batch = make_avx512_batch();
  }
  if (!batch && instructions != Instructions::portable) {
    batch = make_avx2_batch();
  }
  return batch ? std::move(batch) : std::make_unique<GCPDDA_INSTRUCTIONS::LaneBatch>();
}

} // namespace gcpdda
