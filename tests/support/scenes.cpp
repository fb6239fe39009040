#include "scenes.hpp"

#include "gcpdda/io/scene_reader.hpp"

#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <numbers>
#include <random>
#include <sstream>
#include <stdexcept>

namespace gcpdda::testing {

namespace {

Scene checked(SceneReading reading) {
  if (has_errors(reading.diagnostics)) {
    std::string text;
    for (const Diagnostic &d : reading.diagnostics) {
      text += to_string(d) + "\n";
    }
    throw std::runtime_error(text);
  }
  return reading.scene;
}

std::string path_of_shipped(const std::string &name) {
  return std::string(GCPDDA_SOURCE_DIR) + "/run/scenes/" + name + ".toml";
}

// The standard distributions differ between libraries; the engine does not.
double uniform(std::mt19937 &engine, double low, double high) {
  return low + (high - low) * (static_cast<double>(engine()) / 4294967296.0);
}

} // namespace

Scene scene_of(const std::string &toml, const std::vector<std::string> &sets) {
  return checked(read_scene(toml, "test.toml", sets));
}

std::string shipped_toml(const std::string &name) {
  const std::string path = path_of_shipped(name);
  std::ifstream file(path);
  if (!file) {
    throw std::runtime_error("no scene " + path);
  }
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

Scene shipped_scene(const std::string &name, const std::vector<std::string> &sets) {
  return checked(read_scene(shipped_toml(name), path_of_shipped(name), sets));
}

std::string walked_slope_toml() {
  return R"([run]
fidelity = "rigid"
[material.granite]
density = 2650.0
[joint.default]
normal_stiffness = 1e9
friction_angle_deg = 45.0
[joint.bedding]
friction_angle_deg = 38.0
[joint.cross]
friction_angle_deg = 40.0
[region]
material = "granite"
fixed = ["bottom", "left", "right"]
azimuth = 90.0
min_width = 0.5
[region.slope]
toe_length = 10.0
crest_length = 25.0
depth = 6.0
[[region.slope.bench]]
height = 20.0
face_angle_deg = 65.0
[[joint_set]]
name = "bedding"
joint = "bedding"
dip = 32.0
dip_direction = 255.0
spacing = 2.5
origin = [1.4, 3.0]
[[joint_set]]
name = "cross"
joint = "cross"
dip = 78.0
dip_direction = 80.0
spacing = 4.0
[water.ground]
phreatic = [[-10.0, -1.0], [0.0, 0.0], [6.0, 6.8], [34.0, 18.0]]
[output]
interval = 0.5
[[stage]]
name = "weight"
kind = "settle"
limit = 30.0
)";
}

std::string block_toml(const std::string &name, const std::vector<Vec2> &vertices, const std::string &extra) {
  std::string points;
  for (const Vec2 v : vertices) {
    points += fmt::format("[{:.17g}, {:.17g}], ", v.x, v.y);
  }
  return fmt::format("[[block]]\nname = \"{}\"\nmaterial = \"rock\"\nvertices = [{}]\n{}\n", name, points,
                     extra);
}

std::vector<Vec2> placed(const std::vector<Vec2> &points, double angle, Vec2 offset) {
  std::vector<Vec2> moved;
  for (const Vec2 p : points) {
    moved.push_back(Rotation::of(angle)(p) + offset);
  }
  return moved;
}

std::vector<Vec2> rectangle(Vec2 low, Vec2 high) {
  return {low, {high.x, low.y}, high, {low.x, high.y}};
}

std::vector<Vec2> random_polygon(unsigned seed, int num_vertices, double radius, Vec2 centre) {
  std::mt19937 engine(seed);
  std::vector<Vec2> vertices;
  const double first = uniform(engine, 0.0, 2.0 * std::numbers::pi);
  for (int k = 0; k < num_vertices; ++k) {
    const double angle = first + (k + uniform(engine, -0.3, 0.3)) * 2.0 * std::numbers::pi / num_vertices;
    vertices.push_back(centre + radius * Vec2{std::cos(angle), std::sin(angle)});
  }
  return vertices;
}

std::string rock_toml(double duration, double interval, const std::string &monitored) {
  return fmt::format(R"([run]
duration = {}
fidelity = "rigid"
[material.rock]
density = 2600.0
[joint.default]
normal_stiffness = 2e8
friction_angle_deg = 30.0
[output]
interval = {}
[[monitor]]
block = "{}"
)",
                     duration, interval, monitored);
}

std::string falling_pile_toml(int num_blocks, double duration) {
  const int columns = static_cast<int>(std::sqrt(num_blocks)) + 1;
  const double spacing = 1.15;
  const double width = columns * spacing;
  std::string toml = rock_toml(duration, duration / 4.0, "grain5");
  toml += block_toml("floor", rectangle({-3.0, -2.0}, {width + 2.0, 0.0}), "fixed = true");
  toml += block_toml("left", rectangle({-3.0, 0.0}, {-0.8, 2.0 * width}), "fixed = true");
  toml += block_toml("right", rectangle({width, 0.0}, {width + 2.0, 2.0 * width}), "fixed = true");
  std::mt19937 engine(20261121);
  for (int k = 0; k < num_blocks; ++k) {
    const Vec2 centre{spacing * (k % columns) + uniform(engine, -0.05, 0.05),
                      0.6 + spacing * static_cast<double>(k / columns) + uniform(engine, -0.05, 0.05)};
    const int num_vertices = 3 + static_cast<int>(engine() % 6);
    const auto seed = static_cast<unsigned>(engine());
    const std::vector<Vec2> shape = random_polygon(seed, num_vertices, uniform(engine, 0.38, 0.5), centre);
    toml += block_toml(fmt::format("grain{}", k), shape,
                       fmt::format("velocity = [{:.6g}, {:.6g}, {:.6g}]", uniform(engine, -2.0, 2.0),
                                   uniform(engine, -2.0, 0.0), uniform(engine, -3.0, 3.0)));
  }
  return toml;
}

std::string falling_block_toml(const std::string &fidelity, int rows, int columns, const std::string &output,
                               const std::string &stage) {
  const double top = 0.5 * rows;
  const double end = columns + 0.5; // of every second row
  return fmt::format("[run]\nfidelity = \"{}\"\n[material.rock]\ndensity = 2600.0\nyoungs_modulus = 2e9\n"
                     "poissons_ratio = 0.25\n[joint.default]\nnormal_stiffness = 1e9\n"
                     "friction_angle_deg = 30.0\n[output]\n{}",
                     fidelity, output) +
         block_toml("floor", rectangle({-1.0, -1.0}, {end + 20.0, 0.0}), "fixed = true") +
         block_toml("shelf", rectangle({end - 0.4, top + 0.1}, {end + 1.5, top + 0.3}), "fixed = true") +
         block_toml("falls", rectangle({end - 1.0, top + 0.3}, {end + 1.0, top + 1.3})) +
         fmt::format("[[wall]]\nname = \"w\"\nmaterial = \"rock\"\norigin = [0, 0]\nrows = {}\ncolumns = {}\n"
                     "block_size = [1.0, 0.5]\n",
                     rows, columns) +
         "[[stage]]\nkind = \"settle\"\nlimit = 40.0\nsolver = \"static\"\ntolerance = 1e-10\n"
         "[[stage]]\nkind = \"excavate\"\nblocks = [\"shelf\"]\n"
         "[[stage]]\nkind = \"settle\"\nlimit = 40.0\nsolver = \"dynamic\"\n" +
         stage;
}

std::string fall_from_shelf_toml(const std::string &fidelity, int rows, int columns,
                                 const std::string &output) {
  const double x = columns + 16.0;
  return fmt::format("[run]\nfidelity = \"{}\"\n[material.rock]\ndensity = 2600.0\nyoungs_modulus = 2e9\n"
                     "poissons_ratio = 0.25\n[joint.default]\nnormal_stiffness = 1e9\n"
                     "friction_angle_deg = 30.0\n[output]\n{}",
                     fidelity, output) +
         block_toml("floor", rectangle({-1.0, -1.0}, {x + 5.0, 0.0}), "fixed = true") +
         block_toml("falls", rectangle({x, 0.5}, {x + 1.0, 1.5})) +
         block_toml("shelf", rectangle({x - 1.0, 0.4}, {x + 2.0, 0.5}), "fixed = true") +
         fmt::format("[[wall]]\nname = \"w\"\nmaterial = \"rock\"\norigin = [0, 0]\nrows = {}\ncolumns = {}\n"
                     "block_size = [1.0, 0.5]\n",
                     rows, columns) +
         "[[stage]]\nkind = \"settle\"\nlimit = 40.0\nsolver = \"static\"\ntolerance = 1e-10\n"
         "[[stage]]\nkind = \"excavate\"\nblocks = [\"shelf\"]\n"
         "[[stage]]\nkind = \"settle\"\nlimit = 40.0\nsolver = \"static\"\ntolerance = 1e-8\n"
         "failure_motion = 10.0\n";
}

std::string mixed_wall_toml(int rows, int columns, double duration) {
  const double squeeze = 0.002;
  std::string toml = fmt::format("[run]\nduration = {}\n[material.rock]\ndensity = 2600.0\n"
                                 "youngs_modulus = 2e9\npoissons_ratio = 0.25\n[joint.default]\n"
                                 "normal_stiffness = 1e9\nfriction_angle_deg = 30.0\n"
                                 "[output]\ninterval = {}\n[[monitor]]\nblock = \"l2_2\"\n[[monitor]]\n"
                                 "name = \"tip\"\npoint = [7.9, 3.2]\n",
                                 duration, duration / 2.0);
  toml += block_toml("floor", rectangle({-2.0, -1.0}, {2.0 * columns + 3.0, squeeze}),
                     "velocity_table = [[0, 3, 0, 0], [0.007, 4, 0.5, 0], [0.011, 2, 0, 0.1]]");
  std::mt19937 random(5);
  const auto speed = [&](double most) { return most * (static_cast<double>(random()) / 2147483648.0 - 1.0); };
  const auto add = [&](const std::string &name, const std::vector<Vec2> &vertices, bool deformable) {
    toml +=
        block_toml(name, vertices,
                   fmt::format("velocity = [{:.6g}, {:.6g}, {:.6g}]\nfidelity = \"{}\"", 12.0 + speed(1.0),
                               1.0 + speed(1.0), speed(0.3), deformable ? "deformable" : "rigid"));
  };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double x = 2.0 * column + 0.5 * (row % 2);
      const double y = row;
      const double right = x + 2.0 + squeeze;
      const double top = y + 1.0 + squeeze;
      add(fmt::format("l{}_{}", row, column),
          {{x, y}, {right, y}, {right, y + 0.5}, {x + 1.0, y + 0.5}, {x + 1.0, top}, {x, top}},
          (row + column) % 2 == 0);
      add(fmt::format("b{}_{}", row, column), rectangle({x + 1.0 - squeeze, y + 0.5 - squeeze}, {right, top}),
          (row + column) % 3 == 0);
    }
  }
  return toml;
}

std::string settling_pyramid_toml(std::int64_t rows, double duration, const std::string &fidelity) {
  return fmt::format(R"([run]
duration = {}
fidelity = "{}"
local_damping = 0.8
[material.rock]
density = 2600.0
youngs_modulus = 40e9
poissons_ratio = 0.25
[joint.default]
allowed_overlap = 1e-3
friction_angle_deg = {:.17g}
[[pyramid]]
material = "rock"
origin = [0.0, 0.0]
rows = {}
block_size = [1.0, 1.0]
)",
                     duration, fidelity, std::atan(0.6) * 180.0 / std::numbers::pi, rows) +
         block_toml("floor", rectangle({-2.0, -2.0}, {static_cast<double>(rows) + 2.0, 0.0}), "fixed = true");
}

} // namespace gcpdda::testing
