// Error against cost, one factor at a time around the defaults, each over the time step.

#include "accuracy_problems.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace gcpdda::study {

namespace {

struct Point {
  Choice choice;
  Measured outcome;
};

std::vector<Choice> choices_of(const Problem &problem) {
  std::vector<Choice> choices{{}};
  const auto add = [&](const std::string &factor, const std::string &value, const std::string &keys) {
    choices.push_back({.factor = factor, .value = value, .run_keys = keys});
  };
  if (problem.stiffness_is_free) {
    for (const double overlap : {1e-2, 1e-4}) {
      choices.push_back(
          {.factor = "stiffness", .value = fmt::format("overlap {:g}", overlap), .allowed_overlap = overlap});
    }
  }
  for (const char *scheme : {"newmark-dda", "central-difference", "explicit-generalized-alpha"}) {
    add("scheme", scheme, fmt::format("scheme = \"{}\"\n", scheme));
  }
  for (const char *time : {"start", "predictor", "predictor-end"}) {
    add("contact_time", time, fmt::format("contact_time = \"{}\"\n", time));
  }
  for (const double radius : {0.0, 0.5, 0.9, 1.0}) {
    add("spectral_radius", fmt::format("{:g}", radius), fmt::format("spectral_radius = {:g}\n", radius));
  }
  if (problem.is_elastic) {
    choices.push_back({.factor = "fidelity", .value = "rigid", .fidelity = "rigid"});
    add("elasticity", "explicit", "elasticity = \"explicit\"\n");
  }
  return choices;
}

bool has_default_stiffness(const Point &point) {
  return point.choice.factor != "stiffness";
}

/// No worse than another point in error; what lies below the floor is equally good.
bool is_as_accurate(const Point &a, const Point &b, double floor) {
  return a.outcome.error <= std::max(b.outcome.error, floor);
}

bool is_on_front(const Point &point, const std::vector<Point> &points, double floor) {
  return std::none_of(points.begin(), points.end(), [&](const Point &other) {
    return is_as_accurate(other, point, floor) && other.outcome.cost.cpu < point.outcome.cost.cpu &&
           has_default_stiffness(other) == has_default_stiffness(point);
  });
}

/// CPU times as medians of `rounds` (five times as many where a run takes a few milliseconds), for the
/// default and whatever may be on the front or within a factor of three of it. Each round takes them all: a
/// machine that is slower for a while is so for all of them.
void repeat_near_front(const Problem &problem, std::vector<Point> &points, int rounds) {
  constexpr double short_run = 3e-3; // s
  std::vector<Point *> near;
  for (Point &point : points) {
    Point cheaper = point;
    cheaper.outcome.cost.cpu /= 3.0;
    if (std::isfinite(point.outcome.error) &&
        (is_on_front(cheaper, points, problem.floor) || point.choice.factor == "default")) {
      near.push_back(&point);
    }
  }
  std::vector<std::vector<double>> times(near.size());
  for (int round = 0; round < (rounds > 1 ? 5 * rounds : rounds); ++round) {
    for (std::size_t i = 0; i < near.size(); ++i) {
      if (round < rounds || near[i]->outcome.cost.cpu < short_run) {
        times[i].push_back(problem.compute(near[i]->choice).cost.cpu);
      }
    }
  }
  for (std::size_t i = 0; i < near.size(); ++i) {
    near[i]->outcome.cost.cpu = median(times[i]);
  }
}

/// The cheapest point with at most the default's error, by CPU time and by contact evaluations.
void judge_default(const Problem &problem, const std::vector<Point> &points, Table &table) {
  const auto usual = std::find_if(points.begin(), points.end(), [](const Point &p) {
    return p.choice.factor == "default" && p.choice.safety == 0.0;
  });
  const Point *by_cpu = &*usual;
  const Point *by_count = &*usual;
  for (const Point &point : points) {
    if (has_default_stiffness(point) && is_as_accurate(point, *usual, problem.floor)) {
      by_cpu = point.outcome.cost.cpu < by_cpu->outcome.cost.cpu ? &point : by_cpu;
      by_count = point.outcome.cost.evaluations < by_count->outcome.cost.evaluations ? &point : by_count;
    }
  }
  const auto name = [](const Point &p) {
    return fmt::format("{} {} S={:g}", p.choice.factor, p.choice.value, p.choice.safety);
  };
  const double cpu_ratio = usual->outcome.cost.cpu / by_cpu->outcome.cost.cpu;
  const double count_ratio =
      static_cast<double>(usual->outcome.cost.evaluations) /
      static_cast<double>(std::max<std::int64_t>(1, by_count->outcome.cost.evaluations));
  table.add({problem.name, usual->outcome.error, usual->outcome.cost.cpu, usual->outcome.cost.evaluations,
             cpu_ratio, name(*by_cpu), count_ratio, name(*by_count)});
  std::cout
      << fmt::format(
             "{:15} default: error {:.2e}, {:9.3f} ms, {:8} evaluations; as accurate at 1/{:.2f} of the "
             "CPU time ({}) and 1/{:.2f} of the evaluations ({})\n",
             problem.name, usual->outcome.error, 1e3 * usual->outcome.cost.cpu,
             usual->outcome.cost.evaluations, cpu_ratio, name(*by_cpu), count_ratio, name(*by_count))
      << std::flush;
}

} // namespace

void accuracy(const Options &options) {
  std::cout << "k_n = rho g h/(e L) with allowed overlap e = 1e-3 unless a point says otherwise; the bars "
               "have their own\n";
  Table table(options.folder / "accuracy.csv",
              {"problem", "compared", "factor", "value", "safety", "time_step", "normal_stiffness", "error",
               "cpu_s", "evaluations", "contact_steps", "steps", "on_front"});
  Table verdict(options.folder / "accuracy_defaults.csv",
                {"problem", "error", "cpu_s", "evaluations", "cpu_over_cheapest", "cheapest",
                 "evaluations_over_fewest", "fewest"});
  for (const Problem &problem : accuracy_problems(options.quick)) {
    std::vector<Point> points;
    for (Choice choice : choices_of(problem)) {
      std::vector<double> safeties = problem.safeties;
      if (choice.factor == "default") {
        safeties.insert(safeties.begin(), 0.0);
      } else {
        const double smallest = choice.factor == "stiffness" ? 0.25 : 0.125;
        std::erase_if(safeties, [&](double safety) { return safety < smallest; });
      }
      for (const double safety : safeties) {
        choice.safety = safety;
        points.push_back({choice, problem.compute(choice)});
      }
    }
    repeat_near_front(problem, points, options.quick ? 1 : 5);
    for (const auto &[choice, outcome] : points) {
      table.add({problem.name, "\"" + problem.error + "\"", choice.factor, choice.value, choice.safety,
                 outcome.time_step, outcome.normal_stiffness, outcome.error, outcome.cost.cpu,
                 outcome.cost.evaluations, outcome.cost.contact_steps, outcome.cost.steps,
                 std::int64_t{is_on_front({choice, outcome}, points, problem.floor)}});
    }
    judge_default(problem, points, verdict);
  }
  compare_with_peers(options);
}

} // namespace gcpdda::study
