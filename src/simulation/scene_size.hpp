#pragma once

// What a scene will take, judged before the work.

#include "gcpdda/base/diagnostic.hpp"
#include "gcpdda/model/scene.hpp"
#include "gcpdda/parallel/communicator.hpp"

namespace gcpdda {

/// What a scene takes before its first step, about, from the numbers of its blocks alone.
struct SizeEstimate {
  double blocks = 0.0;
  double bytes = 0.0;   ///< of all ranks together, at least
  double seconds = 0.0; ///< of one rank that has all of the work
};

/// @param scene  its region comes with what cuts it; a block file counts once it has been opened
SizeEstimate estimate_size(const Scene &scene);

/// What the ranks are and have.
struct Machine {
  int ranks = 1;
  double memory = 0.0; ///< that all ranks together can get, bytes
};

/// Of the ranks of a communicator, as the one that has the least of it sees it. Collective.
Machine survey_machine(const Communicator &communicator);

/// An error where the memory cannot hold the scene, warnings where it is nearly full or where the set-up
/// takes long.
/// @param copies  of the scene that are held at one time
Diagnostics judge_size(const SizeEstimate &size, const Machine &machine, double copies = 1.0);
/// The same of a scene on these ranks; what is small costs no look at the machine. Collective.
Diagnostics judge_size(const Communicator &communicator, const Scene &scene, double copies = 1.0);

} // namespace gcpdda
