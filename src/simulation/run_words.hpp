#pragma once

#include "gcpdda/simulation/simulation.hpp"

#include <string>

namespace gcpdda {

/// Why a run cannot go on.
std::string fault_message(const Simulation &simulation);

/// Which blocks are rigid, and what that leaves out.
std::string words_on_fidelity(const FidelityReport &fidelity, double accepted_error);

/// How many bolts there are, and what they do to the step.
std::string words_on_bolts(const Simulation &simulation);

} // namespace gcpdda
