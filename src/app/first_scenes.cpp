#include "app/first_scenes.hpp"

#include "app/root_file.hpp"
#include "base/check.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>

namespace gcpdda {

namespace {

struct FirstScene {
  const char *name;
  const char *text;
};

const std::array<FirstScene, 3> first_scenes{{
    {"slope",
     R"toml(# A rock slope of two benches, 20 m high, cut by bedding that dips out of it and by steep cross joints.
#
# It settles under its weight. Then the friction angle of the bedding is lowered below its dip, and what lies above the
# bedding plane through the toe slides: the last stage ends with the verdict "failed".
#
#     gcpdda inspect slope.toml --svg slope.svg     checks and draws the blocks without a run
#     gcpdda run slope.toml                         results in results/slope
#     gcpdda fos slope.toml                         factor of safety, from the state after the first stage
#
# Units are SI: m, kg, s, N, Pa. x points to the right, y upwards; the toe is the origin. The model is 1 m thick.

[run]
fidelity = "auto"             # blocks deform where that matters; "rigid" and "deformable" hold for all blocks
gravity = [0.0, -9.81]        # m/s2
gravity_ramp = 0.5            # s, in which gravity rises from 0: nothing slips while the rock takes up its weight

[material.rock]
density = 2600.0              # kg/m3
youngs_modulus = 10e9         # Pa; this and the next are needed where blocks may deform
poissons_ratio = 0.25

[joint.default]               # the law of every joint that names no other; other laws take missing keys from it
normal_stiffness = 1e9        # Pa/m
friction_angle_deg = 45.0
cohesion = 0.0                # Pa

[joint.bedding]
friction_angle_deg = 40.0

[joint.cross]
friction_angle_deg = 40.0

[region]                      # the rock that joints cut into blocks
material = "rock"
fixed = ["bottom", "left", "right"]
min_width = 0.4               # m; narrower blocks join a neighbour: the smallest block decides about the time step

[region.slope]                # its surface, from the ground before the toe to the crest
toe_length = 10.0             # m, of the ground before the toe
crest_length = 25.0           # m, of the ground behind the crest
depth = 6.0                   # m, below the toe

[[region.slope.bench]]        # benches from the toe upwards
height = 10.0                 # m
face_angle_deg = 70.0
width = 4.0                   # m, of the berm above it

[[region.slope.bench]]
height = 10.0
face_angle_deg = 70.0

[[joint_set]]
name = "bedding"
joint = "bedding"             # its law
dip_deg = 35.0                # a positive dip rises to the right
origin = [0.0, 0.0]           # one joint of the set goes through this point
spacing = 2.0                 # m

[[joint_set]]
name = "cross"
joint = "cross"
dip_deg = 85.0
spacing = 3.0
spacing_scatter = {kind = "normal", deviation = 0.4}

[[monitor]]                   # history/crest.csv has the motion of this point
name = "crest"
point = [11.5, 19.5]

[output]
interval = 0.25               # s, between frames

[[stage]]
name = "weight"
kind = "settle"               # damped, until the blocks are at rest or have failed
limit = 20.0                  # s

[[stage]]
name = "weaker"
kind = "settle"
limit = 20.0
set = { "joint.bedding.friction_angle_deg" = 30.0 }

[fos]
families = ["bedding"]        # laws whose strength is lowered
)toml"},
    {"tunnel",
     R"toml(# A horseshoe tunnel, 6 m wide and high, in rock with two joint sets, its axis 100 m below the surface.
#
# The rock begins under its in-situ stress. The tunnel is excavated while its forces on the rock fall to zero, and the rock
# settles around it.
#
#     gcpdda inspect tunnel.toml --svg tunnel.svg     checks and draws the blocks without a run
#     gcpdda run tunnel.toml                          results in results/tunnel
#     gcpdda run tunnel.toml --out results/loose --set joint.default.cohesion=0
#
# Units are SI: m, kg, s, N, Pa. x points to the right, y upwards; the axis is the origin. The model is 1 m thick.

[run]
fidelity = "auto"             # blocks deform where that matters; "rigid" and "deformable" hold for all blocks
gravity = [0.0, -9.81]        # m/s2

[material.rock]
density = 2600.0              # kg/m3
youngs_modulus = 20e9         # Pa; this and the next are needed where blocks may deform
poissons_ratio = 0.25

[joint.default]               # the law of every joint that names no other
normal_stiffness = 2e10       # Pa/m
friction_angle_deg = 40.0
cohesion = 5e4                # Pa

[in_situ]
level = 100.0                 # m, the surface
k0 = 0.7                      # horizontal to vertical stress

[region]                      # the rock that joints cut into blocks
material = "rock"
polygon = [[-15, -15], [15, -15], [15, 15], [-15, 15]]
fixed = ["bottom", "left", "right", "top"]
min_width = 0.2               # m; narrower blocks join a neighbour: the smallest block decides about the time step

[[joint_set]]
name = "steep"
dip_deg = 65.0                # a positive dip rises to the right
origin = [0.3, 0.0]           # one joint of the set goes through this point
spacing = 1.5                 # m

[[joint_set]]
name = "flat"
dip_deg = -15.0
spacing = 1.5

[[opening]]
name = "tunnel"
shape = "horseshoe"           # or circle, rectangle, polygon
centre = [0.0, 0.0]
width = 6.0                   # m
height = 6.0

[[monitor]]                   # history/roof.csv has the motion of this point
name = "roof"
point = [0.0, 3.3]

[[monitor]]
name = "wall"
point = [3.4, -0.5]

[output]
interval = 0.05               # s, between frames

[[stage]]
name = "in_situ"
kind = "settle"               # damped, until the blocks are at rest or have failed
limit = 5.0                   # s

[[stage]]
name = "excavation"
kind = "excavate"
openings = ["tunnel"]
relax = 0.2                   # s, in which the forces of the excavated rock fall to zero

[[stage]]
name = "around_it"
kind = "settle"
limit = 10.0
)toml"},
    {"wall", R"toml(# A wall of bricks in running bond, 0.8 m wide and 2.4 m high, that stands on a table.
#
# It settles under its weight. Then gravity turns by 20 degrees, as if the table were tilted, and the wall overturns: the
# last stage ends with the verdict "failed".
#
#     gcpdda inspect wall.toml --svg wall.svg     checks and draws the blocks without a run
#     gcpdda run wall.toml                        results in results/wall
#
# Units are SI: m, kg, s, N, Pa. x points to the right, y upwards. The model is 1 m thick.

[run]
fidelity = "auto"             # blocks deform where that matters; "rigid" and "deformable" hold for all blocks
gravity = [0.0, -9.81]        # m/s2
gravity_ramp = 0.2            # s, in which gravity rises from 0

[material.brick]
density = 2000.0              # kg/m3
youngs_modulus = 5e9          # Pa; this and the next are needed where blocks may deform
poissons_ratio = 0.2

[joint.default]               # the law of every joint that names no other
normal_stiffness = 1e10       # Pa/m
friction_angle_deg = 35.0
cohesion = 0.0                # Pa

[[block]]                     # a single block with its corners
name = "table"
material = "brick"
fixed = true
vertices = [[-1.5, -0.3], [2.3, -0.3], [2.3, 0.0], [-1.5, 0.0]]

[[wall]]                      # bricks w.ROW.COLUMN, counted from 0 at the lower left
name = "w"
material = "brick"
origin = [0.0, 0.0]           # m, lower left corner
rows = 12
columns = 2
block_size = [0.4, 0.2]       # m

[[monitor]]                   # history/w.11.0.csv has its motion, stress and force
block = "w.11.0"

[output]
interval = 0.1                # s, between frames

[[stage]]
name = "weight"
kind = "settle"               # damped, until the blocks are at rest or have failed
limit = 10.0                  # s

[[stage]]
name = "tilted"
kind = "settle"
limit = 10.0
set = { "run.gravity" = [-3.355, -9.218] }
)toml"},
}};

/// Why the file could not be written; empty if it has been.
std::string trouble_of_new_file(const std::string &path, const char *text) {
  std::FILE *file = std::fopen(path.c_str(), "wx"); // x: an error where something has this name
  if (file == nullptr) {
    return errno == EEXIST ? "it exists and is not overwritten, give another name"
                           : std::string(std::strerror(errno)) + ", check path and rights";
  }
  const bool written = std::fputs(text, file) >= 0;
  const bool closed = std::fclose(file) == 0;
  return written && closed ? std::string() : "cannot be written, make room on the disk";
}

} // namespace

std::vector<std::string> first_scene_names() {
  std::vector<std::string> names;
  for (const FirstScene &scene : first_scenes) {
    names.emplace_back(scene.name);
  }
  return names;
}

void write_first_scene(const Communicator &world, const std::string &name, const std::string &path) {
  const auto *const scene = std::find_if(first_scenes.begin(), first_scenes.end(),
                                         [&](const FirstScene &each) { return each.name == name; });
  expect(scene != first_scenes.end(), "the command line takes the names of the list only");
  std::string trouble;
  if (world.is_root()) {
    trouble = trouble_of_new_file(path, scene->text);
  }
  world.broadcast(trouble);
  if (!trouble.empty()) {
    throw FileError(path + ": error: no scene is written here, " + trouble);
  }
  if (world.is_root()) {
    std::cout << path << " is written; check it with 'gcpdda inspect " << path
              << "', run it with 'gcpdda run " << path << "'\n"
              << std::flush;
  }
}

} // namespace gcpdda
