#pragma once

// Words that are near each other, for "did you mean".

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace gcpdda {

inline constexpr std::size_t longest_compared_word = 64;

/// Insertions, deletions, replacements and swaps of neighbours that turn a into b (optimal string alignment);
/// for words of at most longest_compared_word characters.
inline std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::array<std::array<std::size_t, longest_compared_word + 1>, 3> rows{};
  for (std::size_t j = 0; j <= b.size(); ++j) {
    rows[0][j] = j;
  }
  for (std::size_t i = 1; i <= a.size(); ++i) {
    const auto &before = rows[(i + 1) % 3]; // row i - 2
    const auto &last = rows[(i - 1) % 3];
    auto &row = rows[i % 3];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({replaced, last[j] + 1, row[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
  }
  return rows[a.size() % 3][b.size()];
}

/// Whether the two words have the same characters.
inline bool is_rearranged(std::string_view a, std::string_view b) {
  return a.size() == b.size() && std::is_permutation(a.begin(), a.end(), b.begin());
}

/// The candidate a person most likely meant by `word`, or "" when none is near: at most one edit in three
/// characters. Of several that are equally near the first one is taken, but one with swapped characters
/// before one with another character: fingers change the order of characters more often than they find a
/// wrong one.
inline std::string nearest_word(std::string_view word, const std::vector<std::string> &candidates) {
  // A hint is not worth comparing thousands of words with thousands of words.
  constexpr std::size_t most_candidates = 256;
  if (word.size() > longest_compared_word || candidates.size() > most_candidates) {
    return "";
  }
  std::string best;
  std::size_t best_distance = longest_compared_word;
  for (const std::string &candidate : candidates) {
    if (candidate.size() > longest_compared_word) {
      continue;
    }
    const bool cut_short = word.size() >= 3 && candidate.starts_with(word);
    const std::size_t near = std::max<std::size_t>(1, std::max(word.size(), candidate.size()) / 3);
    const std::size_t distance = cut_short ? 1 : edit_distance(word, candidate);
    const bool is_nearer =
        distance < best_distance ||
        (distance == best_distance && is_rearranged(word, candidate) && !is_rearranged(word, best));
    if (distance <= near && is_nearer && distance < candidate.size()) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

} // namespace gcpdda
