#include "io/results/ensemble_report.hpp"

#include "base/check.hpp"
#include "base/program_facts.hpp"
#include "io/hdf5/durable_file.hpp"
#include "io/hdf5/numbered_name.hpp"
#include "io/results/json.hpp"
#include "io/results/result_directory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>

namespace gcpdda {

namespace {

namespace fs = std::filesystem;

constexpr double confidence = 0.95;
constexpr std::array<const char *, 4> report_names{"ensemble.txt", "ensemble.json", "ensemble_members.csv",
                                                   "ensemble.svg"};
constexpr const char *identity_name = "ensemble.toml";

std::string members_text(std::int64_t number) {
  return fmt::format("{} member{}", number, number == 1 ? "" : "s");
}

std::string probability_text(const EnsembleStatistics &found) {
  if (found.trials() == 0) {
    return "no member has run: nothing is known of the probability of failure\n";
  }
  std::string text =
      found.fails == 0
          ? fmt::format(
                "no member of {} fails, which does not make it impossible: the probability of failure "
                "is at most {:.2g}",
                found.trials(), found.interval.high)
          : fmt::format("probability of failure {:.3g}: {} of {} fail; {:.2g} to {:.2g}", found.probability,
                        found.fails, members_text(found.trials()), found.interval.low, found.interval.high);
  text += fmt::format(" ({:.0f} % confidence, Clopper and Pearson)\n", 100.0 * confidence);
  if (found.undecided > 0) {
    text += fmt::format("{} undecided: taken as holding at the low end and as failing at the high end\n",
                        members_text(found.undecided));
  }
  return text;
}

std::string factor_text(const EnsembleStatistics &found) {
  const SampleMoments &factor = found.factor;
  std::string text;
  if (factor.number > 0) {
    text +=
        fmt::format("factor of safety of {}: mean {:.4g} (standard error {:.2g}), standard deviation {:.3g}, "
                    "skewness {:.2g}, from {:.4g} to {:.4g}\n",
                    members_text(factor.number), factor.mean, factor.standard_error(), factor.deviation,
                    factor.skewness, factor.least, factor.most);
  }
  if (factor.number > 1 && factor.deviation > 0.0) {
    const double index = (factor.mean - 1.0) / factor.deviation;
    text += fmt::format("reliability index (mean - 1)/deviation {:.3g}; a normal distribution like this has "
                        "{:.2g} below 1\n",
                        index, normal_probability(-index));
  }
  if (found.below > 0) {
    text += fmt::format("{} without a factor: fail at the smallest one tried (fos.from)\n",
                        members_text(found.below));
  }
  if (found.above > 0) {
    text += fmt::format("{} without a factor: no trial failed, up to fos.to\n", members_text(found.above));
  }
  return text;
}

std::string displacement_text(const EnsembleReport &report, const EnsembleStatistics &found) {
  const SampleMoments &displacement = found.displacement;
  if (!report.shakes) {
    return {};
  }
  if (displacement.number == 0) {
    return "no member has come to rest after the shaking: none has a permanent displacement\n";
  }
  const bool has_limit = std::isfinite(report.largest_displacement);
  return fmt::format("permanent displacement of {} at rest: median {:.3g} m, mean {:.3g} m, standard "
                     "deviation {:.2g} "
                     "m, from {:.3g} to {:.3g} m\n",
                     members_text(displacement.number), found.median_displacement, displacement.mean,
                     displacement.deviation, displacement.least, displacement.most) +
         (has_limit ? fmt::format("{} at rest farther than {:g} m (ensemble.largest_displacement): taken as "
                                  "failing\n",
                                  members_text(found.beyond), report.largest_displacement)
                    : "members hold wherever they have come to rest; ensemble.largest_displacement takes "
                      "those farther away for failure\n");
}

std::string trouble_text(const EnsembleReport &report) {
  std::string text;
  constexpr int most = 10;
  int shown = 0;
  for (const EnsembleMember &member : report.members) {
    if (member.outcome != MemberOutcome::cannot_run) {
      continue;
    }
    if (++shown > most) {
      text += "  ...\n";
      break;
    }
    text += fmt::format("  member {}: {}\n", member.number, member.message);
  }
  return text;
}

JsonObject displacement_object(const EnsembleReport &report, const EnsembleStatistics &found) {
  const SampleMoments &displacement = found.displacement;
  return JsonObject()
      .add("members", displacement.number)
      .add("median", found.median_displacement)
      .add("mean", displacement.mean)
      .add("deviation", displacement.deviation)
      .add("least", displacement.least)
      .add("most", displacement.most)
      .add("largest_allowed", report.largest_displacement)
      .add("beyond", found.beyond);
}

std::string json_of(const EnsembleReport &report, const EnsembleStatistics &found) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN(); // null
  const SampleMoments &factor = found.factor;
  const bool has_factor = factor.number > 0;
  JsonObject object(",\n ");
  object.add("measure", std::string(report.measure == Measure::factor ? "factor" : "verdict"))
      .add("count", report.count)
      .add("done", static_cast<std::int64_t>(report.members.size()))
      .add("keys", report.keys)
      .add("holds", found.holds)
      .add("fails", found.fails)
      .add("undecided", found.undecided)
      .add("cannot_run", found.cannot_run)
      .add("holds_after_slide", found.slid)
      .add("probability_of_failure", found.probability)
      .add("confidence", confidence)
      .add("low", found.interval.low)
      .add("high", found.interval.high)
      .add("factors", factor.number)
      .add("mean", has_factor ? factor.mean : none)
      .add("standard_error", has_factor ? factor.standard_error() : none)
      .add("deviation", has_factor ? factor.deviation : none)
      .add("skewness", has_factor ? factor.skewness : none)
      .add("least", has_factor ? factor.least : none)
      .add("most", has_factor ? factor.most : none);
  if (found.displacement.number > 0) {
    object.add("permanent_displacement", displacement_object(report, found));
  }
  return object.add("version", program_version()).add("command", command_line()).text() + "\n";
}

std::string members_csv(const EnsembleReport &report) {
  std::string text = "member,outcome,holds,fails,steps,cpu[s]";
  for (const std::string &key : report.keys) {
    text += "," + key;
  }
  text += report.shakes ? ",permanent_displacement[m],message\n" : ",message\n";
  for (const EnsembleMember &member : report.members) {
    text += row_of(member, report.shakes) + "\n";
  }
  return text;
}

std::string number_text(const std::optional<double> &number) {
  return number ? fmt::format("{:.17g}", *number) : std::string();
}

std::optional<double> optional_number(const std::string &text) {
  return text.empty() ? std::nullopt : std::optional(std::strtod(text.c_str(), nullptr));
}

/// What follows the comma before it.
std::string next_cell(const std::string &row, std::size_t &at) {
  const std::size_t comma = std::min(row.find(',', at), row.size());
  std::string cell = row.substr(std::min(at, row.size()), comma - std::min(at, row.size()));
  at = comma + 1;
  return cell;
}

std::string content_of(const fs::path &path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

bool is_row(const fs::path &path) {
  return is_numbered(path.filename().string(), "member", ".csv");
}

void remove_ensemble(const fs::path &directory) {
  for (const char *name : report_names) {
    fs::remove(directory / name);
  }
  if (fs::is_directory(directory / "members")) {
    for (const fs::directory_entry &entry : fs::directory_iterator(directory / "members")) {
      if (is_row(entry.path()) || is_numbered(entry.path().filename().string(), "member", "")) {
        fs::remove_all(entry.path());
      }
    }
  }
  fs::remove(directory / identity_name);
}

} // namespace

EnsembleStatistics statistics_of(const EnsembleReport &report) {
  EnsembleStatistics found;
  std::vector<double> factors;
  std::vector<double> displacements;
  for (const EnsembleMember &member : report.members) {
    found.holds += member.outcome == MemberOutcome::holds ? 1 : 0;
    found.fails += member.outcome == MemberOutcome::fails ? 1 : 0;
    found.undecided += member.outcome == MemberOutcome::undecided ? 1 : 0;
    found.cannot_run += member.outcome == MemberOutcome::cannot_run ? 1 : 0;
    found.below += member.fails && !member.holds ? 1 : 0;
    found.above += member.holds && !member.fails ? 1 : 0;
    found.slid += member.holds_after_slide() ? 1 : 0;
    if (const std::optional<double> factor = member.factor()) {
      factors.push_back(*factor);
    }
    if (member.displacement) {
      displacements.push_back(*member.displacement);
      found.beyond += *member.displacement > report.largest_displacement ? 1 : 0;
    }
  }
  found.probability = static_cast<double>(found.fails) / static_cast<double>(found.trials()); // 0/0: NaN
  if (found.trials() > 0) {
    found.interval = {probability_interval(found.fails, found.trials(), confidence).low,
                      probability_interval(found.fails + found.undecided, found.trials(), confidence).high};
  }
  found.factor = sample_moments(factors);
  found.displacement = sample_moments(displacements);
  found.median_displacement = median_of(displacements);
  return found;
}

std::string row_of(const EnsembleMember &member, bool shakes) {
  std::string row =
      fmt::format("{},{},{},{},{},{:.3f}", member.number, word_of(member.outcome), number_text(member.holds),
                  number_text(member.fails), member.steps, member.cpu_s);
  for (const double value : member.values) {
    row += fmt::format(",{:.17g}", value);
  }
  if (shakes) {
    row += "," + number_text(member.displacement);
  }
  std::string message = member.message; // the last cell: only line ends and quotes would break it
  std::replace(message.begin(), message.end(), '\n', ' ');
  std::replace(message.begin(), message.end(), '"', '\'');
  return row + (message.empty() ? "," : ",\"" + message + "\"");
}

std::optional<EnsembleMember> member_of(const std::string &row, std::size_t num_values, bool shakes) {
  const std::size_t num_commas = 6 + num_values + (shakes ? 1 : 0);
  if (static_cast<std::size_t>(std::count(row.begin(), row.end(), ',')) < num_commas) {
    return std::nullopt;
  }
  EnsembleMember member;
  std::size_t at = 0;
  member.number = std::strtoll(next_cell(row, at).c_str(), nullptr, 10);
  const std::string word = next_cell(row, at);
  constexpr std::array outcomes{MemberOutcome::holds, MemberOutcome::fails, MemberOutcome::undecided,
                                MemberOutcome::cannot_run};
  const auto *const outcome =
      std::find_if(outcomes.begin(), outcomes.end(), [&](MemberOutcome o) { return word == word_of(o); });
  if (outcome == outcomes.end()) {
    return std::nullopt;
  }
  member.outcome = *outcome;
  member.holds = optional_number(next_cell(row, at));
  member.fails = optional_number(next_cell(row, at));
  member.steps = std::strtoll(next_cell(row, at).c_str(), nullptr, 10);
  member.cpu_s = std::strtod(next_cell(row, at).c_str(), nullptr);
  for (std::size_t i = 0; i < num_values; ++i) {
    member.values.push_back(std::strtod(next_cell(row, at).c_str(), nullptr));
  }
  if (shakes) {
    member.displacement = optional_number(next_cell(row, at));
  }
  if (at < row.size()) {
    member.message = row.substr(at + 1, row.size() - at - 2); // without its quotes
  }
  return member;
}

std::string to_text(const EnsembleReport &report) {
  const EnsembleStatistics found = statistics_of(report);
  std::string keys;
  for (const std::string &key : report.keys) {
    keys += (keys.empty() ? "" : ", ") + key;
  }
  double cpu = 0.0;
  std::int64_t steps = 0;
  for (const EnsembleMember &member : report.members) {
    cpu += member.cpu_s;
    steps += member.steps;
  }
  std::string text = probability_text(found) + factor_text(found) + displacement_text(report, found);
  text += fmt::format(
      "{} of {} done: {} hold, {} fail, {} undecided, {} cannot run; varied: {}; {} steps, {:.2f} "
      "CPU s\n",
      report.members.size(), members_text(report.count), found.holds, found.fails, found.undecided,
      found.cannot_run, keys, steps, cpu);
  if (found.slid > 0) {
    text += fmt::format(
        "warning: {} held only after blocks slid while they settled: the strength may have failed "
        "where they were; column message of ensemble_members.csv names them, and a smaller "
        "failure_motion of that stage takes such slides for failure\n",
        members_text(found.slid));
  }
  if (found.cannot_run > 0) {
    text += "those that cannot run are no part of these shares:\n" + trouble_text(report);
  }
  return text;
}

void write_ensemble_report(const fs::path &directory, const EnsembleReport &report,
                           const std::string &picture) {
  write_file(directory / "ensemble.txt", to_text(report));
  write_file(directory / "ensemble.json", json_of(report, statistics_of(report)));
  write_file(directory / "ensemble_members.csv", members_csv(report));
  if (!picture.empty()) {
    write_file(directory / "ensemble.svg", picture);
  }
}

std::vector<std::string> prepare_ensemble_directory(const fs::path &directory, bool overwrite,
                                                    const std::string &identity, FolderLock &lock) {
  if (fs::exists(directory / "scene.toml") || holds_search(directory)) {
    throw FileError(fmt::format("{} holds a run or a search already, choose another folder with --out",
                                directory.string()));
  }
  make_directory(directory);
  lock.acquire_for_many_runs(directory);
  if (overwrite) {
    remove_ensemble(directory);
  }
  const fs::path identity_path = directory / identity_name;
  if (!fs::exists(identity_path)) {
    make_directory(directory / "members");
    write_file(identity_path, identity);
    return {};
  }
  if (content_of(identity_path) != identity) {
    throw FileError(fmt::format("{} holds an ensemble of another scene, choose another folder with --out or "
                                "replace it with --overwrite",
                                directory.string()));
  }
  make_directory(directory / "members");
  std::vector<std::string> rows;
  for (const fs::directory_entry &entry : fs::directory_iterator(directory / "members")) {
    if (is_row(entry.path())) {
      rows.push_back(content_of(entry.path()));
    }
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

void write_member(const fs::path &directory, const EnsembleMember &member, bool shakes) {
  write_file(directory / "members" / fmt::format("member_{:06}.csv", member.number), row_of(member, shakes));
}

fs::path member_directory(const fs::path &directory, std::int64_t number) {
  return directory / "members" / fmt::format("member_{:06}", number);
}

} // namespace gcpdda
