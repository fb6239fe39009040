// A step takes no memory: all it needs has been there since the last refresh, or has grown once.

#include "simulation/simulation.hpp"

#include "support/cut_region.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define GCPDDA_ADDRESS_SANITIZER
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define GCPDDA_ADDRESS_SANITIZER
#endif
#ifdef GCPDDA_ADDRESS_SANITIZER
#include <sanitizer/allocator_interface.h>
#endif

namespace gcpdda::step_allocations_test {
namespace {

std::atomic<std::int64_t> allocations{0};

} // namespace
} // namespace gcpdda::step_allocations_test

#ifdef GCPDDA_ADDRESS_SANITIZER
namespace gcpdda::step_allocations_test {
namespace {

// The sanitizer has operators of its own, which match each other in every form.
[[maybe_unused]] const int hooks = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void *, std::size_t) { ++allocations; }, [](const volatile void *) {});

} // namespace
} // namespace gcpdda::step_allocations_test
#else
namespace gcpdda::step_allocations_test {
namespace {

void *counted(void *memory) {
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  ++allocations;
  return memory;
}

} // namespace
} // namespace gcpdda::step_allocations_test

// Inlined, they would look mismatched to the compiler.
[[gnu::noinline]] void *operator new(std::size_t size) {
  return gcpdda::step_allocations_test::counted(std::malloc(size));
}
[[gnu::noinline]] void *operator new(std::size_t size, std::align_val_t alignment) {
  const auto to = static_cast<std::size_t>(alignment);
  return gcpdda::step_allocations_test::counted(std::aligned_alloc(to, (size + to - 1) / to * to));
}
[[gnu::noinline]] void operator delete(void *memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void *memory, std::size_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void *memory, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void *memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
#endif

namespace gcpdda::step_allocations_test {
namespace {

using namespace testing;

/// How many of so many steps took memory and did not refresh the neighbourhood.
int steps_with_allocations(Simulation &simulation, int steps) {
  int count = 0;
  for (int step = 0; step < steps; ++step) {
    const std::int64_t refreshes = simulation.counters().refreshes;
    const std::int64_t before = allocations;
    simulation.step();
    count += simulation.counters().refreshes == refreshes && allocations > before ? 1 : 0;
  }
  return count;
}

/// @param growing  so many steps may lengthen a list for contacts that are born
void expect_no_allocations(const Scene &scene, std::size_t least_general, int growing) {
  Simulation simulation(Communicator::self(), scene);
  EXPECT_GE(simulation.candidates().general.size(), least_general) << "pairs of blocks that are not convex";
  EXPECT_GT(steps_with_allocations(simulation, 100), 0) << "lists get their lengths";
  EXPECT_LE(steps_with_allocations(simulation, 100), growing);
  EXPECT_GT(simulation.counters().contact_steps, 4000);
}

// Edges have laws of their own.
TEST(Step, OfJointedRockTakesNoMemory) {
  Scene scene = shipped_scene("jointed_bench", {"output.interval=0.5"});
  prepare_region(scene);
  expect_no_allocations(scene, 50, 5);
}

TEST(Step, OfDeformableBlocksTakesNoMemory) {
  expect_no_allocations(scene_of(mixed_wall_toml(4, 6, 10.0)), 20, 0);
}

} // namespace
} // namespace gcpdda::step_allocations_test
