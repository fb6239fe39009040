#include "model/fingerprint.hpp"

#include <initializer_list>
#include <iterator>
#include <type_traits>

namespace gcpdda {

namespace {

/// A chain in which the order counts.
class Chain {
public:
  explicit Chain(std::uint64_t start) : value_(scattered(start)) {}
  void add(std::uint64_t x) { value_ = scattered(value_ ^ x); }
  void add(std::initializer_list<double> values) {
    for (const double x : values) {
      add(std::bit_cast<std::uint64_t>(x));
    }
  }
  void add(Vec2 x) { add({x.x, x.y}); }
  void add(const std::array<double, 3> &x) { add({x[0], x[1], x[2]}); }
  /// How many there are, then each of them.
  template <class T> void add(const std::vector<T> &values) {
    add(std::uint64_t{values.size()});
    for (const T &value : values) {
      add(value);
    }
  }
  void add(const VelocityRow &row) {
    add({row.time});
    add(row.velocity);
  }
  void add(const LoadRow &row) { add({row.time, row.factor}); }
  void add(const RecordRow &row) { add({row.time, row.value.x, row.value.y}); }
  void add(const Mat2 &x) { add({x.xx, x.xy, x.yx, x.yy}); }
  void add(const Boundary &side) { add({side.normal.x, side.normal.y, side.reach}); }
  void add(std::int64_t x) { add(static_cast<std::uint64_t>(x)); }
  void add(std::int32_t x) { add(std::int64_t{x}); }
  template <class Enum>
  requires std::is_enum_v<Enum>
  void add(Enum x) { add(static_cast<std::uint64_t>(x)); }
  [[nodiscard]] std::uint64_t value() const { return value_; }

private:
  std::uint64_t value_;
};

// A field that is added to one of these must join its function below, or the words over fingerprints().
static_assert(sizeof(RunSettings) == 136);
static_assert(sizeof(PointLoad) == 72);
static_assert(sizeof(Water) == 96);
static_assert(sizeof(SupportType) == 200);
static_assert(sizeof(InSituStress) == 160);
static_assert(sizeof(Earthquake) == 176);
static_assert(sizeof(Stage) == 312);

void add(Chain &chain, const RunSettings &run) {
  chain.add({run.gravity.x, run.gravity.y, run.gravity_ramp, run.spectral_radius, run.contact_damping,
             run.rayleigh.mass_damping, run.rayleigh.stiffness_damping, run.local_damping});
  chain.add(run.scheme);
  chain.add(run.contact_time);
  chain.add(run.potential);
  chain.add(run.initial_friction);
  chain.add(run.elasticity);
  chain.add(std::uint64_t{run.plane_strain});
}

void add(Chain &chain, const JointLaws &joints) {
  for (const JointLaw &law : joints.laws) {
    for (const auto number : JointLaw::numbers()) {
      chain.add({law.*number});
    }
    for (const auto choice : JointLaw::choices()) {
      chain.add(std::uint64_t{law.*choice});
    }
  }
  chain.add(joints.of_material);
}

void add(Chain &chain, const std::vector<SceneBlock> &blocks) {
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    for (const PointLoad &load : blocks[i].loads) {
      chain.add(std::uint64_t{i});
      chain.add(load.point);
      chain.add(load.force);
      chain.add({load.ramp});
      chain.add(load.table);
    }
    chain.add(std::uint64_t{blocks[i].fixed});
    chain.add(std::uint64_t{blocks[i].driven});
  }
}

void add(Chain &chain, const std::vector<Water> &water) {
  for (const Water &w : water) {
    chain.add(w.phreatic);
    chain.add(w.joints);
    chain.add({w.density});
    chain.add(std::uint64_t{w.active});
  }
}

void add(Chain &chain, const SupportType &type) {
  chain.add(type.kind);
  chain.add({type.axial_stiffness, type.axial_rigidity, type.axial_yield, type.shear_stiffness,
             type.shear_yield, type.rupture_strain, type.pretension, type.active_length, type.bond_strength,
             type.spacing, type.thickness, type.youngs_modulus, type.poissons_ratio,
             type.compressive_strength, type.tensile_strength, type.residual_tensile_strength,
             type.shear_strength, type.adhesion, type.bond_width});
  chain.add(std::uint64_t{type.plate});
}

// Further ones may come later.
void add_bolts_in_place(Chain &chain, const Scene &scene) {
  for (std::size_t i = 0; i < scene.bolts.size(); ++i) {
    const Bolt &bolt = scene.bolts[i];
    if (bolt.active) {
      chain.add(std::uint64_t{i});
      chain.add(bolt.from);
      chain.add(bolt.to);
      add(chain, scene.supports[static_cast<std::size_t>(bolt.support)]);
    }
  }
}

void add_liners_in_place(Chain &chain, const Scene &scene) {
  for (std::size_t i = 0; i < scene.liners.size(); ++i) {
    const Liner &liner = scene.liners[i];
    if (liner.active) {
      chain.add(std::uint64_t{i});
      chain.add(liner.path);
      chain.add(std::uint64_t{liner.is_closed});
      chain.add(std::uint64_t{liner.has_rock_on_right});
      add(chain, scene.supports[static_cast<std::size_t>(liner.support)]);
    }
  }
}

void add(Chain &chain, const InSituStress &stress) {
  chain.add(std::uint64_t{stress.present});
  chain.add(stress.at_level);
  chain.add(stress.growth);
  chain.add(stress.down);
  chain.add({stress.level});
  chain.add(stress.boundaries);
}

void add(Chain &chain, const Earthquake &quake) {
  chain.add(quake.quantity);
  chain.add(quake.baseline);
  chain.add({quake.scale, quake.start, quake.p_wave_speed, quake.s_wave_speed});
  chain.add(quake.stage);
  chain.add(quake.record);
  chain.add(quake.viscous);
  chain.add(std::uint64_t{quake.is_compliant});
}

void add(Chain &chain, const Stage &stage) {
  chain.add(stage.kind);
  chain.add({stage.local_damping, stage.relax, stage.ramp});
  chain.add(std::uint64_t{stage.mass_scaling});
  chain.add(std::uint64_t{stage.kinetic_damping});
  chain.add(stage.solver);
  chain.add(static_cast<std::uint64_t>(stage.increments));
  chain.add(std::uint64_t{stage.changes_stress});
  chain.add(stage.excavated.blocks);
  chain.add(stage.excavated.region);
  for (const std::size_t opening : stage.excavated.openings) {
    chain.add(std::uint64_t{opening});
  }
}

} // namespace

ScenePrints fingerprints(const Scene &start, std::span<const Stage> stages) {
  std::vector<Chain> chains;
  for (std::size_t part = 0; part < scene_parts.size(); ++part) {
    chains.emplace_back(part);
  }
  auto &run = chains[0], &joint = chains[1], &material = chains[2], &block = chains[3], &water = chains[4],
       &bolt = chains[5], &stress = chains[6], &ground = chains[7], &stage = chains[8], &liner = chains[9];
  const auto add_scene = [&](const Scene &scene) {
    add(run, scene.run);
    add(joint, scene.joints);
    material.add(fingerprint(scene.materials));
    add(block, scene.blocks);
    add(water, scene.water);
    add_bolts_in_place(bolt, scene);
    add_liners_in_place(liner, scene);
    add(stress, scene.in_situ);
  };
  add_scene(start);
  // One that has not begun has done nothing.
  if (start.earthquake.shakes() && start.earthquake.stage < std::ssize(stages)) {
    add(ground, start.earthquake);
  }
  for (const Stage &next : stages) {
    add(stage, next);
    if (next.after) {
      add_scene(*next.after);
    }
  }
  ScenePrints prints{};
  for (std::size_t part = 0; part < prints.size(); ++part) {
    prints[part] = chains[part].value();
  }
  return prints;
}

std::uint64_t fingerprint(const ScenePrints &prints) {
  Chain chain(prints.size());
  for (const std::uint64_t print : prints) {
    chain.add(print);
  }
  return chain.value();
}

std::uint64_t fingerprint(std::int64_t id, const SceneBlock &block) {
  Chain chain(static_cast<std::uint64_t>(id));
  chain.add(static_cast<std::uint64_t>(block.material));
  chain.add(std::uint64_t{block.fixed});
  chain.add(std::uint64_t{block.driven});
  chain.add(block.vertices);
  for (const std::int32_t joint : block.edge_joint) {
    chain.add(static_cast<std::uint64_t>(joint));
  }
  chain.add(block.velocity);
  chain.add(block.velocity_table);
  chain.add(block.fixed_points);
  return chain.value();
}

std::uint64_t fingerprint(std::span<const Material> materials) {
  Chain chain(materials.size());
  for (const Material &material : materials) {
    chain.add({material.density, material.youngs_modulus, material.poissons_ratio});
  }
  return chain.value();
}

} // namespace gcpdda
