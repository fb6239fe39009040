#pragma once

#include "study.hpp"

namespace gcpdda::study {

/// Largest stable step of chains of blocks between walls, rigid and deformable, against the linear theory of
/// the same chain and the bound that the program steps by.
void chain_limits(const Options &options);

} // namespace gcpdda::study
