#pragma once

#include <cstdlib>
#include <iostream>
#include <string_view>

namespace gcpdda::fuzz {

/// What must hold for any input: else the fuzzer stops and keeps the input.
inline void require(bool condition, std::string_view what, std::string_view detail = "") {
  if (!condition) {
    std::cerr << "broken: " << what << (detail.empty() ? "" : ": ") << detail << std::endl;
    std::abort();
  }
}

} // namespace gcpdda::fuzz
