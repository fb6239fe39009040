#pragma once

// Writes summary.json of a result folder.

#include "gcpdda/io/run_summary.hpp"

#include <filesystem>

namespace gcpdda {

/// Written to a temporary name and renamed. Root only.
void write_summary(const std::filesystem::path &directory, const RunSummary &summary);

} // namespace gcpdda
