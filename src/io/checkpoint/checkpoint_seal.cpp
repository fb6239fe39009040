#include "io/checkpoint/checkpoint_seal.hpp"

#include "base/input_file.hpp"
#include "io/checkpoint/checkpoint_layout.hpp"
#include "io/hdf5/hdf5_collective_file.hpp"
#include "io/hdf5/numbered_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

namespace gcpdda::checkpoint {

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t word_size = sizeof(std::uint64_t);
constexpr const char *first_line = "gcpdda checkpoint\n";

std::string text_of(const Seal &seal) {
  std::string text = fmt::format("{}version {}\nstep {}\nbytes {}\nsum {:016x}\n", first_line, seal.version,
                                 seal.step, seal.size, seal.sum);
  text.resize(static_cast<std::size_t>(seal_size), '\0');
  return text;
}

/// Words [first, last) behind the seal of a file of so many bytes; the last one may be incomplete. A word
/// counts with its place, so that the sums of any pieces are that of the whole (modulo 2^64).
std::uint64_t sum_of_words(const fs::path &path, std::int64_t first, std::int64_t last, std::int64_t size) {
  constexpr std::uint64_t stride = 0x9e3779b97f4a7c15U; // odd: every place moves a word differently
  std::ifstream stream(path, std::ios::binary);
  stream.seekg(seal_size + first * word_size);
  std::array<std::uint64_t, 8192> words{};
  std::uint64_t sum = 0;
  for (std::int64_t word = first; word < last;) {
    const std::int64_t count = std::min(last - word, std::ssize(words));
    const std::int64_t bytes = std::min(count * word_size, size - seal_size - word * word_size);
    words[static_cast<std::size_t>(count - 1)] = 0;
    if (!stream.read(reinterpret_cast<char *>(words.data()), bytes)) {
      throw FileError("cannot read " + path.string() + ": " + std::strerror(errno));
    }
    for (std::int64_t k = 0; k < count; ++k) {
      sum += scattered(words[static_cast<std::size_t>(k)] + static_cast<std::uint64_t>(word + k) * stride);
    }
    word += count;
  }
  return sum;
}

/// Collective.
std::uint64_t sum_of_file(const Communicator &communicator, const fs::path &path, const Seal &seal) {
  const std::int64_t words = (seal.size - seal_size + word_size - 1) / word_size;
  const std::int64_t ranks = communicator.size();
  std::uint64_t mine = 0;
  on_all_ranks(communicator, [&] {
    const std::int64_t rank = communicator.rank();
    mine = sum_of_words(path, words / ranks * rank + std::min(rank, words % ranks),
                        words / ranks * (rank + 1) + std::min(rank + 1, words % ranks), seal.size);
  });
  const auto number = [](std::int64_t x) { return static_cast<std::uint64_t>(x); };
  return ContentSum::agreed_sum(communicator, mine) +
         scattered(number(seal.size) ^ scattered(number(seal.step) ^ scattered(number(seal.version))));
}

} // namespace

void put_seal(const Communicator &communicator, const fs::path &unfinished, std::int64_t step) {
  Seal seal{version, step, 0, 0};
  on_all_ranks(communicator, [&] { seal.size = static_cast<std::int64_t>(fs::file_size(unfinished)); });
  seal.sum = sum_of_file(communicator, unfinished, seal);
  on_root(communicator, [&] {
    std::fstream stream(unfinished, std::ios::in | std::ios::out | std::ios::binary);
    stream.write(text_of(seal).data(), seal_size);
    stream.close();
    if (!stream) {
      throw FileError("cannot write " + unfinished.string() + ": " + std::strerror(errno));
    }
  });
}

Seal read_seal(const fs::path &path) {
  if (const InputFile file = look_at_input_file(path.string()); !file.trouble.empty()) {
    throw FileError(file.trouble);
  }
  std::string text(static_cast<std::size_t>(seal_size), '\0');
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    throw FileError(std::string("cannot open it: ") + std::strerror(errno));
  }
  const auto size = static_cast<std::int64_t>(fs::file_size(path));
  stream.read(text.data(), seal_size);
  if (text.starts_with("\x89HDF\r\n")) {
    throw FileError(fmt::format(
        "it is an HDF5 file, but no checkpoint of gcpdda, or one of a format version before {}", version));
  }
  long long number = 0;
  if (!text.starts_with(first_line) ||
      std::sscanf(text.c_str() + std::strlen(first_line), "version %lld", &number) != 1) {
    throw FileError(
        fmt::format("it is damaged or no checkpoint of gcpdda: its {} bytes begin with no seal", size));
  }
  if (number != version) {
    throw FileError(fmt::format("it has format version {}, this gcpdda reads version {}", number, version));
  }
  Seal seal{number, 0, 0, 0};
  long long step = 0;
  long long bytes = 0;
  unsigned long long sum = 0;
  std::sscanf(text.c_str() + std::strlen(first_line), "version %*d step %lld bytes %lld sum %llx", &step,
              &bytes, &sum);
  seal.step = step;
  seal.size = bytes;
  seal.sum = sum;
  if (text != text_of(seal) || seal.size < seal_size) {
    throw FileError("it is damaged: its seal is broken");
  }
  if (seal.size != size) {
    throw FileError(fmt::format("it is damaged: it has {} of {} bytes", size, seal.size));
  }
  if (number_of(path.filename().string(), "checkpoint", ".h5") != seal.step) {
    throw FileError(fmt::format("it is the checkpoint of step {} under the name of another", seal.step));
  }
  return seal;
}

void expect_unchanged(const Communicator &communicator, const fs::path &path, const Seal &seal) {
  if (sum_of_file(communicator, path, seal) != seal.sum) {
    throw FileError("it is damaged: its checksum is wrong");
  }
}

} // namespace gcpdda::checkpoint
