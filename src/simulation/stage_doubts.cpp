#include "simulation/stage_doubts.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <fmt/format.h>
#include <string>
#include <vector>

namespace gcpdda {

namespace {

void append_change(std::string &list, const std::string &more) {
  list += (list.empty() ? "" : ", ") + more;
}

/// By material, whether deformable blocks have it. Collective.
std::vector<std::int64_t> materials_that_deform(const RunState &run) {
  std::vector<std::int64_t> deforms(run.scene.materials.size(), 0);
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    if (run.blocks.is_deformable(row)) {
      deforms[static_cast<std::size_t>(run.blocks.properties[row].material)] = 1;
    }
  }
  run.communicator.max(deforms);
  return deforms;
}

/// A law that the reader has made, such as that of rollers, is at no place of the scene.
bool is_of_user(const Scene &scene, const JointLaw &law) {
  const std::string path = "joint." + law.name;
  const auto place = scene.places.lower_bound(path);
  return scene.places.empty() || (place != scene.places.end() && place->first.starts_with(path));
}

/// By law of the user, whether contacts may have it.
std::vector<bool> laws_in_use(const Scene &scene) {
  const JointLaws &joints = scene.joints;
  std::vector<bool> used;
  for (std::int32_t law = 0; law < std::ssize(joints.laws); ++law) {
    const bool is_named = is_of_user(scene, joints.laws[static_cast<std::size_t>(law)]);
    used.push_back(is_named && (joints.laws[static_cast<std::size_t>(law)].is_on_edges ||
                                std::find(joints.of_material.begin(), joints.of_material.end(), law) !=
                                    joints.of_material.end()));
  }
  return used;
}

std::string changed_joints(const Scene &before, const Scene &after, const std::vector<bool> &used) {
  std::string changes;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const JointLaw &old = before.joints.laws[i];
    const JointLaw &now = after.joints.laws[i];
    if (used[i] && now.allowed_overlap == 0.0 && old.normal_stiffness != now.normal_stiffness) {
      append_change(changes,
                    fmt::format("k_n of [joint.{}] from {:.6g} to {:.6g} Pa/m{}", now.name,
                                old.normal_stiffness, now.normal_stiffness,
                                now.rock_mass_modulus > 0.0
                                    ? fmt::format(" (of rock_mass_modulus {:g} Pa in intact rock of {:g} Pa)",
                                                  now.rock_mass_modulus, now.intact_modulus)
                                    : ""));
    }
  }
  return changes;
}

std::string changed_materials(const Scene &before, const Scene &after,
                              const std::vector<std::int64_t> &deforms) {
  std::string changes;
  for (std::size_t i = 0; i < deforms.size(); ++i) {
    const Material &old = before.materials[i];
    const Material &now = after.materials[i];
    if (deforms[i] > 0 && old.youngs_modulus != now.youngs_modulus) {
      append_change(changes, fmt::format("E of [material.{}] from {:.6g} to {:.6g} Pa", now.name,
                                         old.youngs_modulus, now.youngs_modulus));
    }
    if (deforms[i] > 0 && old.poissons_ratio != now.poissons_ratio) {
      append_change(changes, fmt::format("poissons_ratio of [material.{}] from {:g} to {:g}", now.name,
                                         old.poissons_ratio, now.poissons_ratio));
    }
  }
  return changes;
}

} // namespace

void doubt_stiffness(RunState &run) {
  const std::vector<std::int64_t> deforms = materials_that_deform(run);
  const std::vector<bool> used = laws_in_use(run.scene);
  const Scene *before = &run.scene;
  for (const Stage &stage : run.clock.stages) {
    if (!stage.after) {
      continue;
    }
    std::string changes = changed_joints(*before, *stage.after, used);
    if (const std::string more = changed_materials(*before, *stage.after, deforms); !more.empty()) {
      append_change(changes, more);
    }
    if (!changes.empty()) {
      run.notes.push_back({Severity::warning, stage.where,
                           fmt::format("stage '{}' changes {}", stage.name, changes),
                           "overlaps and strains stay, so that the stress that these joints and blocks carry "
                           "changes with the stiffness at once, in-situ stress included",
                           "give the stiffness from the start, or change strengths alone"});
    }
    before = stage.after.get();
  }
}

void doubt_stretch_of_bonds(RunState &run) {
  const auto stretch_of = [](const JointLaw &law) {
    return law.has_bonds && law.normal_stiffness > 0.0 ? law.tension / law.normal_stiffness : 0.0;
  };
  const Scene *before = &run.scene;
  for (const Stage &stage : run.clock.stages) {
    if (!stage.after) {
      continue;
    }
    const std::vector<JointLaw> &laws = stage.after->joints.laws;
    for (std::size_t i = 0; i < laws.size(); ++i) {
      const double stretch = stretch_of(laws[i]);
      if (stretch > 0.5 * run.neighbours.base_skin && stretch > stretch_of(before->joints.laws[i])) {
        run.notes.push_back(
            {Severity::warning, stage.where,
             fmt::format("from stage '{}' on bonds of [joint.{}] open by {:.3g} m before they "
                         "break",
                         stage.name, laws[i].name, stretch),
             fmt::format("that is tension/normal_stiffness, more than {:.3g} m, a twentieth of "
                         "the smallest block's size",
                         0.5 * run.neighbours.base_skin),
             "raise normal_stiffness from the start, or lower tension"});
      }
    }
    before = stage.after.get();
  }
}

} // namespace gcpdda
