#include "driver/restart_changes.hpp"

#include "gcpdda/base/scene_error.hpp"
#include "io/scene/scene_changes.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <string_view>

namespace gcpdda {

namespace {

/// Default intervals follow from the duration: a restart keeps those that the run had.
bool is_kept_interval(const SceneChange &change, const Scene &before, const Scene &after) {
  return (change.path == "output.interval" && before.output.interval == after.output.interval) ||
         (change.path == "output.history_interval" &&
          before.output.history_interval == after.output.history_interval);
}

/// Where the changed scene has the value.
SourcePosition place_of(const SceneChange &change, const Scene &after) {
  if (change.stage >= 0 && change.stage < std::ssize(after.stages)) {
    return after.stages[static_cast<std::size_t>(change.stage)].where;
  }
  const auto place = after.places.find(change.path);
  return place == after.places.end() ? SourcePosition{} : place->second;
}

} // namespace

Diagnostics changes_of_shapes(const Scene &before, const Scene &after) {
  constexpr std::array<std::string_view, 7> cutters{"region", "joint_set", "fault", "opening",
                                                    "layer",  "voronoi",   "bricks"};
  Diagnostics faults;
  for (const SceneChange &change : changes_between(before.resolved, after.resolved)) {
    const std::string_view path = change.path;
    const std::string_view table = path.substr(0, path.find('.'));
    const std::string_view key = path.substr(path.rfind('.') + 1);
    const bool cuts =
        std::find(cutters.begin(), cutters.end(), table) != cutters.end() && path != "region.stress";
    if (cuts || (table == "joint" && (key == "materials" || key == "allowed_overlap"))) {
      faults.push_back({Severity::error, place_of(change, after), "a restart cannot change " + change.path,
                        cuts ? "the blocks in the checkpoint were cut by the old value"
                             : "the contacts in the checkpoint were computed with the old value",
                        "start a new run with gcpdda run, or leave the change out"});
    }
  }
  return faults;
}

void expect_same_past(const Scene &before, const Scene &after, std::int64_t num_over) {
  Diagnostics faults;
  for (const SceneChange &change : changes_between(before.resolved, after.resolved)) {
    if (change.stage >= 0 && change.stage < num_over) {
      faults.push_back(
          {Severity::error, place_of(change, after),
           fmt::format("a restart cannot change {} from {} to {}", change.path, change.before, change.after),
           "this stage is over in the checkpoint",
           "add a further [[stage]], leave the change out, or start a new run with gcpdda run"});
    }
  }
  if (!faults.empty()) {
    throw SceneError(faults);
  }
}

Diagnostics reports_of_changes(const Scene &before, const Scene &after, double time, std::int64_t stage) {
  Diagnostics reports;
  for (const SceneChange &change : changes_between(before.resolved, after.resolved)) {
    if (is_kept_interval(change, before, after)) {
      continue;
    }
    const auto setter = std::find_if(change.set_in.rbegin(), change.set_in.rend(),
                                     [&](std::int64_t k) { return k <= stage; });
    const bool has_effect = setter == change.set_in.rend();
    reports.push_back({has_effect ? Severity::info : Severity::warning,
                       {},
                       fmt::format("{} changes from {} to {}", change.path, change.before, change.after),
                       has_effect
                           ? fmt::format("the run has the new value from t = {:.9g} s on", time)
                           : fmt::format("the change is without effect because stage '{}' sets the value",
                                         after.stages[static_cast<std::size_t>(*setter)].name),
                       has_effect ? "" : "set the value in a further stage"});
  }
  return reports;
}

} // namespace gcpdda
