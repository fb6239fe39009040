#include "app/launch.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

namespace gcpdda {

int announced_ranks() {
  for (const char *name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"}) {
    if (const char *value = std::getenv(name)) {
      if (const int ranks = std::atoi(value); ranks > 1) {
        return ranks;
      }
    }
  }
  return 1;
}

// The program itself has no options that may come before the command of a call that does work.
bool heeds_stop_signal(int argc, const char *const *argv) {
  constexpr std::array<std::string_view, 4> commands{"run", "restart", "fos", "ensemble"};
  return argc > 1 && std::find(commands.begin(), commands.end(), argv[1]) != commands.end();
}

} // namespace gcpdda
