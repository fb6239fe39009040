#include "io/scene/scene_faults.hpp"

#include <algorithm>
#include <utility>

namespace gcpdda::scene_text {

Origins::Origins(std::string file, const std::vector<std::string> &sets) : file_(std::move(file)) {
  for (const std::string &set : sets) {
    labels_.push_back("--set " + shown(set, 200));
  }
}

SourcePosition Origins::position(const toml::source_region &region) const {
  if (region.path) {
    return {*region.path, 0, 0};
  }
  // Line 0 would read as "no position": what is missing from the whole file is reported at its start.
  return {file_, std::max(1, static_cast<int>(region.begin.line)),
          std::max(1, static_cast<int>(region.begin.column))};
}

Origins::Order Origins::order(const toml::source_region &region) const {
  std::size_t rank = 0;
  if (region.path) {
    rank = 1 + static_cast<std::size_t>(std::find(labels_.begin(), labels_.end(), *region.path) -
                                        labels_.begin());
  }
  return {rank, region.begin.line, region.begin.column};
}

std::string Origins::place(const toml::source_region &region) const {
  return region.path ? *region.path : "line " + std::to_string(region.begin.line);
}

void Faults::add(const toml::source_region &where, std::string what, std::string why, std::string hint) {
  entries_.emplace_back(origins_->order(where), Diagnostic{Severity::error, origins_->position(where),
                                                           std::move(what), std::move(why), std::move(hint)});
}

void Faults::add_new(const Faults &other) {
  for (const auto &[order, diagnostic] : other.entries_) {
    const auto is_same = [text = to_string(diagnostic)](const auto &entry) {
      return to_string(entry.second) == text;
    };
    if (std::none_of(entries_.begin(), entries_.end(), is_same)) {
      entries_.emplace_back(order, diagnostic);
    }
  }
}

Diagnostics Faults::sorted() const {
  auto entries = entries_;
  std::stable_sort(entries.begin(), entries.end(),
                   [](const auto &a, const auto &b) { return a.first < b.first; });
  Diagnostics diagnostics;
  for (auto &[order, diagnostic] : entries) {
    diagnostics.push_back(std::move(diagnostic));
  }
  return diagnostics;
}

std::string shown(std::string_view text, std::size_t most) {
  std::string result(text.substr(0, most));
  for (char &c : result) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      c = ' ';
    }
  }
  return text.size() > most ? result + "..." : result;
}

} // namespace gcpdda::scene_text
