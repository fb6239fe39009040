#pragma once

// Each table of a scene has one function that reads it; each is in the file scene_TABLE.cpp.

#include "gcpdda/model/scene.hpp"
#include "io/scene/scene_section.hpp"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace gcpdda::scene_text {

/// What the parts of a scene are put together from.
struct SceneSource {
  const toml::table &root;
  const FaultyNodes &faulty;
  Faults &faults;
};

using MaterialIndex = std::map<std::string, std::int32_t>;

/// The materials while the scene is read.
class Materials {
public:
  explicit Materials(const SceneSource &source);

  [[nodiscard]] const std::vector<Material> &all() const { return materials_; }
  [[nodiscard]] const MaterialIndex &index() const { return index_; }

  /// Index of the material that a section names; -1 where it names none, with a fault where it is unknown.
  std::int32_t find(const Section &section);
  /// Where `who` deforms, its material must say how: one fault per material.
  void expect_elastic(std::int32_t material, const std::string &who, const toml::node &where);
  /// The blocks of a file may be of any material.
  void expect_all_elastic();

private:
  void report_missing(std::int32_t material, const toml::source_region &where, const std::string &what,
                      const std::string &why);

  SceneSource source_;
  std::vector<Material> materials_;
  std::vector<NamedSection> sections_;
  MaterialIndex index_;
  std::set<std::int32_t> reported_;
};

/// Names of blocks, walls and pyramids: each is given once.
class Names {
public:
  explicit Names(Faults &faults) : faults_(&faults) {}
  /// @param label  "block 'slider'"
  void add(const Section &section, const std::string &label, const std::string &name);

private:
  struct First {
    std::string label;
    toml::source_region where;
  };
  Faults *faults_;
  std::map<std::string, First> first_of_name_;
};

/// Index of a material, -1 (and a fault at `where`) where no material has that name.
std::int32_t find_material(const MaterialIndex &materials, const std::string &name,
                           const toml::source_region &where, Faults &faults);

RunSettings read_run(const SceneSource &source);
OutputSettings read_output(const SceneSource &source, double duration);
StrengthReduction read_reduction(const SceneSource &source, const JointLaws &joints);
/// @param scene  with joints and stages
Ensemble read_ensemble(const SceneSource &source, const Scene &scene);
/// Number of the law that a name stands for; nothing, and a fault, where no joint is named so.
std::optional<std::int32_t> find_joint(const SceneSource &source, const toml::node &name,
                                       const JointLaws &joints);
/// The same of a list of names, ascending.
std::vector<std::int32_t> find_joints(const SceneSource &source, const Section &section, std::string_view key,
                                      const JointLaws &joints);

JointLaws read_joint_laws(const SceneSource &source, const MaterialIndex &materials);

/// The water of [water.NAME]; the faulty ones lack their faulty parts.
std::vector<Water> read_water(const SceneSource &source, const JointLaws &joints);

/// [support.NAME]; the faulty ones lack their faulty parts.
std::vector<SupportType> read_supports(const SceneSource &source);
/// Every [[bolt]], then those of each [[bolt_pattern]]; none where it cannot be placed.
/// @param scene  with supports and region
std::vector<Bolt> read_bolts(const SceneSource &source, const Scene &scene);

/// One SceneBlock per [[block]]; the faulty ones lack their faulty parts.
std::vector<SceneBlock> read_blocks(const SceneSource &source, Materials &materials, Names &names,
                                    Fidelity of_run, const JointLaws &joints);

/// Walls and pyramids that can be built, in the order of the file. Blocks whose name is that of a brick are
/// faults, and more blocks than ids.
std::vector<BrickGenerator> read_generators(const SceneSource &source, Materials &materials, Names &names,
                                            Fidelity of_run, const std::vector<SceneBlock> &blocks);

/// @param scene_file  as the user gave it: the block file's path starts from its folder
BlockFile read_block_file_table(const SceneSource &source, Materials &materials, Fidelity of_run,
                                const std::string &scene_file);

/// [region] and everything that lies in it. Joint maps are named, not read.
/// @param scene_file  as the user gave it: the paths of joint maps start from its folder
RockRegion read_region(const SceneSource &source, Materials &materials, const JointLaws &joints,
                       const std::string &scene_file);

/// The fixed blocks along the region's rollers, behind the blocks of the scene, and their law.
/// @param scene  with laws, blocks and region
void add_rollers(const SceneSource &source, Scene &scene);

/// The sides of the region where the in-situ stress, which has been read, acts from outside.
void read_stressed_sides(const SceneSource &source, Scene &scene);

/// What a stage makes of the stress on sides of the region, which has been read: it must push, and act
/// somewhere before or after.
/// @param where  what the stage sets of it
void check_changed_stress(const SceneSource &source, const toml::source_region &where, const Scene &scene,
                          const InSituStress &before);

/// The viscous sides of [earthquake], the rest of which has been read.
void read_viscous_sides(const SceneSource &source, Scene &scene);

/// @param scene  with run and materials
InSituStress read_in_situ(const SceneSource &source, const Scene &scene);

/// [earthquake] without its record, which is in a file.
/// @param scene  with its stages
/// @param scene_file  as the user gave it: the record's path starts from its folder
Earthquake read_earthquake(const SceneSource &source, const Scene &scene, const std::string &scene_file);

/// @param scene  with all its blocks
std::vector<Monitor> read_monitors(const SceneSource &source, const Scene &scene);

/// The stages, each without what it sets (scene_changes.hpp).
/// @param scene  with all its blocks
std::vector<Stage> read_stages(const SceneSource &source, const Scene &scene);

/// Scene::places. Blocks, monitors, stages and members of an ensemble have none: they know their own.
std::map<std::string, SourcePosition> places_of(const SceneSource &source);

/// Longest time all stages may take together, s.
double duration_of_stages(const SceneSource &source);

} // namespace gcpdda::scene_text
