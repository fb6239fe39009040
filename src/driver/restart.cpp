#include "driver/restart.hpp"

#include "base/check.hpp"
#include "base/text.hpp"
#include "driver/restart_changes.hpp"
#include "gcpdda/driver/run.hpp"
#include "io/checkpoint/checkpoint_reader.hpp"
#include "io/results/result_directory.hpp"
#include "model/fingerprint.hpp"
#include "simulation/simulation.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iostream>
#include <string_view>
#include <utility>

namespace gcpdda {

namespace {

const std::string new_run = "start a new run with gcpdda run, or leave the change out";

Diagnostic refused(const SourcePosition &where, const std::string &what, const std::string &why) {
  return {Severity::error, where, "a restart cannot change " + what, why, new_run};
}

const std::string belongs_to_state = "the state in the checkpoint was computed with the old value";

void compare_settings(const RunSettings &before, const RunSettings &after, Diagnostics &faults) {
  const auto expect_same = [&](auto member, const char *key, const std::string &why) {
    if (before.*member != after.*member) {
      faults.push_back(refused({}, std::string("run.") + key, why));
    }
  };
  const std::string trials = "friction springs are stretched between trial configurations of one scheme";
  expect_same(&RunSettings::scheme, "scheme", trials);
  expect_same(&RunSettings::spectral_radius, "spectral_radius", trials);
  expect_same(&RunSettings::contact_time, "contact_time", trials);
  expect_same(&RunSettings::plane_strain, "plane", belongs_to_state);
  const std::string fidelity = "a rigid and a deformable block have different states";
  expect_same(&RunSettings::fidelity, "fidelity", fidelity);
  expect_same(&RunSettings::accepted_error, "accepted_error", fidelity);
  expect_same(&RunSettings::initial_friction, "initial_friction", "it says something of t = 0 only");
}

void compare_materials(const std::vector<Material> &before, const std::vector<Material> &after,
                       Diagnostics &faults) {
  if (before.size() != after.size()) {
    faults.push_back(refused({}, "the list of materials", belongs_to_state));
    return;
  }
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (before[i].name != after[i].name) {
      faults.push_back(refused({}, "the list of materials", belongs_to_state));
      return;
    }
    const auto expect_same = [&](double Material::*member, const char *key) {
      if (before[i].*member != after[i].*member) {
        faults.push_back(refused({}, fmt::format("material.{}.{}", before[i].name, key), belongs_to_state));
      }
    };
    expect_same(&Material::density, "density");
    expect_same(&Material::youngs_modulus, "youngs_modulus");
    expect_same(&Material::poissons_ratio, "poissons_ratio");
  }
}

/// Where edges have laws, they and the regions know them by their numbers.
void compare_joints(const JointLaws &before, const JointLaws &after, Diagnostics &faults) {
  bool on_edges = false;
  for (std::int32_t law = 1; law < std::ssize(before.laws); ++law) {
    on_edges = on_edges || std::find(before.of_material.begin(), before.of_material.end(), law) ==
                               before.of_material.end();
  }
  const auto same_name = [](const JointLaw &a, const JointLaw &b) { return a.name == b.name; };
  if (on_edges &&
      !std::equal(before.laws.begin(), before.laws.end(), after.laws.begin(), after.laws.end(), same_name)) {
    faults.push_back(refused({}, "the list of joints", "the contacts in the checkpoint name them by number"));
  }
  for (const JointLaw &law : after.laws) {
    const auto same = std::find_if(before.laws.begin(), before.laws.end(),
                                   [&](const JointLaw &old) { return same_name(old, law); });
    if (law.has_bonds && same != before.laws.end() && !same->has_bonds) {
      faults.push_back(
          {Severity::error,
           {},
           fmt::format("a restart cannot give [joint.{}] bonds by tension or residual values", law.name),
           "bonds form at t = 0 only; contacts without bonds would have the residual values alone",
           "change cohesion and friction_angle_deg alone, or start a new run with gcpdda run"});
    }
  }
}

bool same_generator(const BrickGenerator &a, const BrickGenerator &b) {
  const auto key = [](const BrickGenerator &g) {
    return std::tuple(g.kind, g.material, g.origin.x, g.origin.y, g.rows, g.columns, g.block_size.x,
                      g.block_size.y, g.bond, g.gap);
  };
  return key(a) == key(b);
}

void compare_blocks(const Scene &before, const Scene &after, Diagnostics &faults) {
  if (before.blocks.size() != after.blocks.size() || before.generators.size() != after.generators.size() ||
      before.block_file.path.empty() != after.block_file.path.empty()) {
    faults.push_back(refused({}, "the number of blocks", "the checkpoint holds a state for each of them"));
    return;
  }
  for (std::size_t i = 0; i < before.blocks.size(); ++i) {
    if (fingerprint(0, before.blocks[i]) != fingerprint(0, after.blocks[i])) {
      faults.push_back(
          refused(after.blocks[i].where, fmt::format("block '{}'", before.blocks[i].name),
                  "its outline, material, initial or prescribed velocity and what holds it belong "
                  "to the state in the checkpoint"));
    } else if (before.blocks[i].fidelity != after.blocks[i].fidelity) {
      faults.push_back(refused(after.blocks[i].where, fmt::format("block '{}'", before.blocks[i].name),
                               "a rigid and a deformable block have different states"));
    }
  }
  for (std::size_t i = 0; i < before.generators.size(); ++i) {
    if (!same_generator(before.generators[i], after.generators[i])) {
      faults.push_back(refused(after.generators[i].where, fmt::format("'{}'", before.generators[i].name),
                               belongs_to_state));
    }
  }
}

/// The checkpoint knows bolts by their numbers; further ones may come, put in by a stage.
void compare_bolts(const Scene &before, const Scene &after, Diagnostics &faults) {
  bool same = before.bolts.size() <= after.bolts.size();
  for (std::size_t i = 0; i < before.bolts.size() && same; ++i) {
    const Bolt &a = before.bolts[i];
    const Bolt &b = after.bolts[i];
    same = a.name == b.name && a.from == b.from && a.to == b.to && a.active == b.active &&
           before.supports[static_cast<std::size_t>(a.support)].kind ==
               after.supports[static_cast<std::size_t>(b.support)].kind;
  }
  for (std::size_t i = before.bolts.size(); i < after.bolts.size() && same; ++i) {
    same = !after.bolts[i].active;
  }
  if (!same) {
    faults.push_back(
        refused({}, "bolts that are there, or put in others at the start",
                "the checkpoint holds those in place; further ones stand behind them with active "
                "= false and are put in by a stage"));
  }
}

/// The same of liners.
void compare_liners(const Scene &before, const Scene &after, Diagnostics &faults) {
  bool same = before.liners.size() <= after.liners.size();
  for (std::size_t i = 0; i < after.liners.size() && same; ++i) {
    const Liner &b = after.liners[i];
    if (i >= before.liners.size()) {
      same = !b.active;
      continue;
    }
    const Liner &a = before.liners[i];
    same = a.name == b.name && a.path == b.path && a.is_closed == b.is_closed && a.active == b.active;
  }
  if (!same) {
    faults.push_back(
        refused({}, "liners that are there, or put in others at the start",
                "the checkpoint holds those in place; further ones stand behind them with active "
                "= false and are put in by a stage"));
  }
}

/// A run that reached its end and left no checkpoint.
bool is_finished(const Communicator &communicator, const std::filesystem::path &directory) {
  std::int64_t finished = 0;
  if (communicator.is_root()) {
    finished = checkpoint_files(directory).empty() && says_completed(directory) ? 1 : 0;
  }
  communicator.max(std::span(&finished, 1));
  return finished > 0;
}

} // namespace

void keep_intervals(const OutputSettings &before, std::vector<std::string> &sets) {
  if (sets.empty()) {
    return;
  }
  const auto names = [&](std::string_view key) {
    return std::any_of(sets.begin(), sets.end(),
                       [&](std::string_view set) { return trimmed(set.substr(0, set.find('='))) == key; });
  };
  const bool names_interval = names("output") || names("output.interval");
  const bool names_history = names_interval || names("output.history_interval");
  if (!names_interval) {
    sets.push_back(fmt::format("output.interval={}", before.interval));
  }
  if (!names_history) {
    sets.push_back(fmt::format("output.history_interval={}", before.history_interval));
  }
}

Diagnostics unfit_changes(const Scene &before, const Scene &after) {
  Diagnostics faults;
  compare_settings(before.run, after.run, faults);
  compare_materials(before.materials, after.materials, faults);
  compare_joints(before.joints, after.joints, faults);
  compare_blocks(before, after, faults);
  compare_bolts(before, after, faults);
  compare_liners(before, after, faults);
  const auto in_situ = [](const Scene &scene) {
    const InSituStress &stress = scene.in_situ;
    return std::tuple(stress.present, stress.at_level, stress.growth, stress.down, stress.level);
  };
  const auto ground = [](const Scene &scene) {
    const Earthquake &quake = scene.earthquake;
    return std::tuple(quake.shakes(), quake.quantity, quake.baseline, quake.scale, quake.start, quake.stage,
                      quake.viscous.size(), quake.is_compliant);
  };
  const auto speeds = [](const Earthquake &quake) {
    return std::pair(quake.p_wave_speed, quake.s_wave_speed);
  };
  if (ground(before) != ground(after) || speeds(before.earthquake) != speeds(after.earthquake)) {
    faults.push_back(refused(after.earthquake.where, "[earthquake]", belongs_to_state));
  }
  if (in_situ(before) != in_situ(after)) {
    faults.push_back(refused(after.in_situ.where, "[in_situ]", "blocks have their shapes by it"));
  }
  const Diagnostics of_shapes = changes_of_shapes(before, after);
  faults.insert(faults.end(), of_shapes.begin(), of_shapes.end());
  return faults;
}

ExitCode restart_scene(const Communicator &communicator, const Scene &before, const Scene &after,
                       const std::filesystem::path &directory, RunOptions run) {
  if (const Diagnostics faults = unfit_changes(before, after); !faults.empty()) {
    throw SceneError(faults);
  }
  if (before.resolved == after.resolved && is_finished(communicator, directory)) {
    if (communicator.is_root()) {
      std::cerr << "the run in " << directory.string() << " is finished, there is nothing to do\n";
    }
    return exit_code::done;
  }
  run.directory = directory;
  run.restart = true;
  run.computed_with = &before;
  return run_scene(communicator, after, run);
}

} // namespace gcpdda
