#include "io/results/id_slabs.hpp"

namespace gcpdda {

std::int64_t slab_begin(std::int64_t num_blocks, int num_ranks, int rank) {
  return num_blocks * rank / num_ranks;
}

int slab_owner(std::int64_t num_blocks, int num_ranks, std::int64_t block) {
  return static_cast<int>(((block + 1) * num_ranks - 1) / num_blocks);
}

} // namespace gcpdda
