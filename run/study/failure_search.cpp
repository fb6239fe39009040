#include "failure_search.hpp"

#include "support/scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace gcpdda::study {

namespace {

std::string name_of(Ending ending) {
  switch (ending) {
  case Ending::fine:
    return "nothing wrong";
  case Ending::refused:
    return "refused";
  case Ending::stopped:
    return "stopped";
  case Ending::warned:
    return "wrong after a warning";
  case Ending::physical:
    return "as the equations say";
  case Ending::silent:
    break;
  }
  return "SILENTLY WRONG";
}

std::string fault_text(const Simulation &simulation) {
  const Fault &fault = *simulation.fault();
  const char *const causes[] = {"not finite", "too deep", "too fast"};
  return fmt::format("{} at t = {:.4g} s: {:.4g} m, allowed {:.4g} m", causes[static_cast<int>(fault.cause)],
                     simulation.time(), fault.value, fault.limit);
}

/// What a person is told of the highest severity.
std::string told(const Diagnostics &notes, Severity severity) {
  for (const Diagnostic &note : notes) {
    if (note.severity == severity) {
      return to_string(note);
    }
  }
  return {};
}

std::string quoted(std::string text) {
  for (std::size_t at = text.find('"'); at != std::string::npos; at = text.find('"', at + 2)) {
    text.insert(at, 1, '"');
  }
  return '"' + text + '"';
}

} // namespace

Outcome try_scene(const std::string &toml, const Drive &drive, const std::vector<std::string> &sets) {
  try {
    Simulation simulation(Communicator::self(), testing::scene_of(toml, sets));
    Outcome outcome = simulation.fault() ? Outcome{} : drive(simulation);
    if (simulation.fault()) {
      return {Ending::stopped, fault_text(simulation)};
    }
    std::string warning = told(simulation.notes(), Severity::warning);
    const std::string at_the_end = told(warnings_of(simulation.state()), Severity::warning);
    warning += (warning.empty() || at_the_end.empty() ? "" : "; ") + at_the_end;
    if (outcome.ending == Ending::silent && !warning.empty()) {
      return {Ending::warned, outcome.text + "; " + warning};
    }
    return outcome;
  } catch (const SceneError &error) {
    return {Ending::refused, told(error.diagnostics(), Severity::error)};
  }
}

std::string ground() {
  return testing::block_toml("ground", testing::rectangle({-10.0, -2.0}, {11.0, 0.0}), "fixed = true");
}

Outcome judged(bool is_fine, std::string text) {
  return {is_fine ? Ending::fine : Ending::silent, std::move(text)};
}

Search search(const Options &options, double from, double to, int points, int bisections) {
  return {from, to, options.quick ? 3 : points, options.quick ? 2 : bisections, false};
}

Boundary find_boundary(const Search &search, const std::function<Outcome(double)> &trial) {
  const auto allowed = [&](double value) { return search.whole ? std::round(value) : value; };
  Boundary boundary;
  for (int k = 0; k < search.points && !boundary.found; ++k) {
    const double share = static_cast<double>(k) / std::max(search.points - 1, 1);
    const double value = allowed(search.from * std::pow(search.to / search.from, share));
    const Outcome outcome = trial(value);
    boundary.found = outcome.ending != Ending::fine;
    (boundary.found ? boundary.first_bad : boundary.last_fine) = value;
    (boundary.found ? boundary.beyond : boundary.fine) = outcome;
  }
  for (int k = 0; k < search.bisections && boundary.found && boundary.last_fine != 0.0; ++k) {
    const double middle = allowed(std::sqrt(boundary.last_fine * boundary.first_bad));
    if (middle == boundary.last_fine || middle == boundary.first_bad) {
      break;
    }
    const Outcome outcome = trial(middle);
    const bool is_fine = outcome.ending == Ending::fine;
    (is_fine ? boundary.last_fine : boundary.first_bad) = middle;
    (is_fine ? boundary.fine : boundary.beyond) = outcome;
  }
  return boundary;
}

Boundaries::Boundaries(const std::filesystem::path &path)
    : table_(path,
             {"problem", "parameter", "unit", "boundary", "tried_up_to", "what_happens_beyond", "detail"}) {}

void Boundaries::add(const std::string &problem, const std::string &parameter, const std::string &unit,
                     const Search &search, const Boundary &boundary, const std::string &detail) {
  const std::string value = boundary.found ? fmt::format("{:.5g}", boundary.last_fine) : "none";
  const std::string beyond = boundary.found ? fmt::format("{} ({:.5g}): {}", name_of(boundary.beyond.ending),
                                                          boundary.first_bad, boundary.beyond.text)
                                            : fmt::format("none up to {:.5g}", search.to);
  const std::string all =
      boundary.fine.text.empty() ? detail : fmt::format("{}; last fine: {}", detail, boundary.fine.text);
  const double tried = boundary.found ? boundary.first_bad : search.to;
  table_.add({quoted(problem), quoted(parameter), unit, value, tried, quoted(beyond), quoted(all)});
  const std::string line = fmt::format("{}: {} {}{}{}; {}\n    {}\n", problem, parameter, value,
                                       unit.empty() ? "" : " ", unit, beyond, all);
  text_ += line;
}

void Boundaries::print() const {
  std::cout << "Boundaries that no linear theory gives\n" << text_ << std::flush;
}

} // namespace gcpdda::study
