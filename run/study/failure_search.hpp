#pragma once

// How a parameter is driven until something goes wrong, and what is told of it.

#include "study.hpp"

#include <functional>
#include <string>
#include <vector>

namespace gcpdda::study {

/// How a trial ended: as it should; refused before the run; stopped by a fault; wrong after a warning; away
/// from rest because the equations say so, which `text` shows; wrong without a word.
enum class Ending { fine, refused, stopped, warned, physical, silent };

struct Outcome {
  Ending ending = Ending::fine;
  std::string text; ///< what was measured
};

/// Steps a fresh run and judges it; a fault need not be looked at.
using Drive = std::function<Outcome(Simulation &)>;

/// Make and drive a run; says itself when the scene is refused or the run stops.
Outcome try_scene(const std::string &toml, const Drive &drive, const std::vector<std::string> &sets = {});

/// Fine if `is_fine`, else silently wrong.
Outcome judged(bool is_fine, std::string text);

/// Values `from` to `to`, up or down, in equal ratios, and then halvings of the ratio around the first
/// failure.
struct Search {
  double from = 0.0;
  double to = 0.0;
  int points = 7;
  int bisections = 6;
  bool whole = false; ///< whole numbers only
};
Search search(const Options &options, double from, double to, int points = 7, int bisections = 6);

struct Boundary {
  double last_fine = 0.0;
  double first_bad = 0.0;
  bool found = false;
  Outcome fine;   ///< at last_fine
  Outcome beyond; ///< at first_bad
};
Boundary find_boundary(const Search &search, const std::function<Outcome(double)> &trial);

/// boundaries.csv, and the same as a short text.
class Boundaries {
public:
  explicit Boundaries(const std::filesystem::path &path);
  /// @param detail  what no outcome says: what is held fixed, what a closed form predicts
  void add(const std::string &problem, const std::string &parameter, const std::string &unit,
           const Search &search, const Boundary &boundary, const std::string &detail);
  void print() const;

private:
  Table table_;
  std::string text_;
};

/// One [[block]], fixed: 2 m thick and 21 m wide under y = 0.
std::string ground();

/// The problems of one kind, each with its rows.
void failures_at_rest(const Options &options, Boundaries &boundaries);
void failures_of_shape(const Options &options, Boundaries &boundaries);
void failures_in_motion(const Options &options, Boundaries &boundaries);
void failures_of_steps(const Options &options, Boundaries &boundaries);

} // namespace gcpdda::study
