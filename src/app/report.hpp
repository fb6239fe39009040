#pragma once

// `gcpdda report`: the Python package of the tree or of the installation writes the report.

#include "gcpdda/base/exit_code.hpp"
#include "gcpdda/parallel/communicator.hpp"

#include <string>
#include <vector>

namespace gcpdda {

/// The root starts Python, the first on PATH or of the system that has the libraries, with the package that
/// belongs to this program, and waits for it. Collective.
/// @param words  arguments of the report: the result folder and options
/// @return what Python ended with; file_trouble where it or one of its libraries is missing
ExitCode write_report(const Communicator &world, const std::vector<std::string> &words);

} // namespace gcpdda
