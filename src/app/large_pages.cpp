// Arrays of a model in large pages: a step runs through megabytes of them, and with pages of 4 kB some of
// its time goes into looking up where they are. Linux gives large pages to whoever asks for them (the usual
// setting, "madvise"); where it has none, or on other systems, nothing changes.

#if defined(__has_feature)
#define GCPDDA_HAS_FEATURE(x) __has_feature(x)
#else
#define GCPDDA_HAS_FEATURE(x) 0
#endif

// The address and thread sanitizers have an operator new of their own.
#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) &&                 \
    !GCPDDA_HAS_FEATURE(address_sanitizer) && !GCPDDA_HAS_FEATURE(thread_sanitizer)

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <malloc.h>
#include <new>
#include <sys/mman.h>

namespace {

constexpr std::size_t small_page = 4096;
constexpr std::size_t large_array = 65536;

/// All arrays but the largest side by side, so that one large page may hold several.
[[maybe_unused]] const int side_by_side = mallopt(M_MMAP_THRESHOLD, 32 << 20);
/// Room that an output leaves is there for the next one: fresh pages have to be cleared first.
[[maybe_unused]] const int kept_room = mallopt(M_TRIM_THRESHOLD, 256 << 20);

void ask_for_large_pages(void *memory, std::size_t size) {
  const std::size_t before_page =
      (small_page - reinterpret_cast<std::uintptr_t>(memory) % small_page) % small_page;
  const std::size_t whole_pages = (size - before_page) / small_page * small_page;
  madvise(static_cast<std::byte *>(memory) + before_page, whole_pages, MADV_HUGEPAGE); // a wish: it may fail
}

} // namespace

void *operator new(std::size_t size) {
  void *memory = std::malloc(size > 0 ? size : 1);
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  if (size >= large_array) {
    ask_for_large_pages(memory, size);
  }
  return memory;
}

void operator delete(void *memory) noexcept {
  std::free(memory);
}

void operator delete(void *memory, std::size_t) noexcept {
  std::free(memory);
}

#endif
