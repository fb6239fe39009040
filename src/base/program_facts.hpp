#pragma once

// Which program has computed a result, and by which command: the provenance that summary.json records.

#include <span>
#include <string>

namespace gcpdda {

/// The project's version, with the description that git gave when the build was configured: "1.0.0+4f63e1a".
/// Only the project's version where the sources are not in a git repository.
std::string program_version();

/// The compiler and the header-only libraries of this build, one "name version" per line.
std::string build_versions();

/// The words as one line that a shell reads back as the same words.
std::string shell_line(std::span<const std::string> words);

/// The command line of this process as shell_line(), without a launcher such as mpirun; empty where the
/// system does not tell it.
std::string command_line();

} // namespace gcpdda
