#include "failure_search.hpp"
#include "stability.hpp"

namespace gcpdda::study {

void failures(const Options &options) {
  Boundaries boundaries(options.folder / "boundaries.csv");
  failures_at_rest(options, boundaries);
  failures_of_shape(options, boundaries);
  failures_in_motion(options, boundaries);
  failures_of_steps(options, boundaries);
  boundaries.print();
}

} // namespace gcpdda::study
