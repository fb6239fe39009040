// Every fault of one scene line, with the exact message a person reads.

#include "bad_scene.hpp"

#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

namespace gcpdda::bad_scenes_test {
namespace {

using testing::messages;
using testing::scene_text;

/// The good scene with one line replaced.
struct BadScene {
  const char *name;
  std::size_t line; ///< from 1
  const char *replacement;
  std::vector<std::string> expected; ///< without the file name
};

std::ostream &operator<<(std::ostream &stream, const BadScene &scene) {
  return stream << scene.name;
}

// clang-format off
const std::vector<BadScene> bad_scenes{
    {"SyntaxError", 2, R"(duration = 2.0 s)",
     {R"(2:16: error: not valid TOML, Error while parsing key-value pair: expected a comment or whitespace, saw 's', check quotes, brackets and = up to this place)"}},
    {"SyntaxErrorBeforeAControlCharacter", 2, "run = t\nru",
     {"2:8: error: not valid TOML, Error while parsing boolean: expected 'true', saw 't ', check quotes, brackets and = up to this place"}},
    {"BrokenHeader", 3, R"([material.granite)",
     {R"(3:18: error: not valid TOML, Error while parsing table header: expected ']', saw '\n', check quotes, brackets and = up to this place)"}},
    {"HeaderWithoutKey", 3, R"([.granite])",
     {R"(3:2: error: not valid TOML, Error while parsing key: expected bare key starting character or string delimiter, saw '.', check quotes, brackets and = up to this place)"}},
    {"TableTwice", 5, R"([material.granite])",
     {R"(5:1: error: not valid TOML, Error while parsing table header: cannot redefine existing table 'material.granite', check quotes, brackets and = up to this place)"}},
    {"KeyTwice", 2, R"(duration = 2.0
duration = 3.0)",
     {R"(3:12: error: not valid TOML, Error while parsing key-value pair: cannot redefine existing floating-point 'duration', check quotes, brackets and = up to this place)"}},
    {"UnknownKey", 2, R"(duration = 2.0
saftey = 0.2)",
     {R"(3:1: error: unknown key 'saftey' in [run], did you mean 'safety'?)"}},
    {"UnknownKeyNothingNear", 4, R"(density = 2600.0
colour = "red")",
     {R"(5:1: error: unknown key 'colour' in [material.granite], known here: density youngs_modulus poissons_ratio)"}},
    {"UnknownTable", 3, R"([outputs]
[material.granite])",
     {R"(3:2: error: unknown key 'outputs', did you mean 'output'?)"}},
    {"KeyOfAnotherTable", 4, R"(density = 2600.0
friction_angle_deg = 30)",
     {R"(5:1: error: unknown key 'friction_angle_deg' in [material.granite], it belongs to [joint.*])"}},
    {"TableKeyOfTopLevel", 2, R"(duration = 2.0
material = "granite")",
     {R"(3:1: error: unknown key 'material' in [run], 'material' belongs to the top level)"}},
    {"UnknownKeyInBlock", 15, R"(name = "slider"
velocty = [0, 0, 0])",
     {R"(16:1: error: unknown key 'velocty' in block 'slider', did you mean 'velocity'?)"}},
    {"MissingRun", 1, R"([output])",
     {R"(1:1: error: 'run' is missing, it is required, write [run])",
      R"(2:1: error: unknown key 'duration' in [output], it belongs to [run])"}},
    {"MissingDuration", 2, R"()",
     {R"(1:1: error: 'duration' in [run] is missing, it is required, for example duration = 2.0)"}},
    {"MissingDensity", 4, R"()",
     {R"(3:1: error: 'density' in [material.granite] is missing, it is required, for example density = 2600.0)"}},
    {"MissingBlockMaterial", 16, R"()",
     {R"(14:1: error: 'material' in block 'slider' is missing, it is required, for example material = "granite")"}},
    {"MissingVertices", 17, R"()",
     {R"(14:1: error: 'vertices' in block 'slider' is missing, it is required, for example vertices = [[0, 0], [1, 0], [1, 1], [0, 1]])"}},
    {"MissingDefaultLaw", 7, R"([joint.soft])",
     {R"(7:1: error: 'default' in [joint] is missing, pairs of materials without a law of their own take it, write [joint.default])",
      R"(7:1: error: 'materials' in [joint.soft] is missing, a law other than default is for one pair of materials, or for edges that name it, for example materials = ["granite", "clay"])"}},
    {"DurationString", 2, R"(duration = "2 s")",
     {R"(2:12: error: 'duration' in [run] is a string, it must be a number, for example duration = 2.0)"}},
    {"DurationZero", 2, R"(duration = 0)",
     {R"(2:12: error: 'duration' in [run] is 0, it must be above 0 and at most 1e+12, for example duration = 2.0)"}},
    {"DurationInf", 2, R"(duration = inf)",
     {R"(2:12: error: 'duration' in [run] is inf, it must be finite, for example duration = 2.0)"}},
    {"DensityNan", 4, R"(density = nan)",
     {R"(4:11: error: 'density' in [material.granite] is nan, it must be finite, for example density = 2600.0)"}},
    {"DensityNegative", 4, R"(density = -2600)",
     {R"(4:11: error: 'density' in [material.granite] is -2600, it must be above 0 and at most 1e+12, for example density = 2600.0)"}},
    {"DensityDate", 4, R"(density = 2024-01-01)",
     {R"(4:11: error: 'density' in [material.granite] is a date or time, it must be a number, for example density = 2600.0)"}},
    {"GravityNumber", 2, R"(duration = 2.0
gravity = -9.81)",
     {R"(3:11: error: 'gravity' in [run] is a real number, it must be an array of 2 numbers, for example gravity = [0.0, -9.81])"}},
    {"GravityThree", 2, R"(duration = 2.0
gravity = [0, 0, -9.81])",
     {R"(3:11: error: 'gravity' in [run] has length 3, it must have length 2, for example gravity = [0.0, -9.81])"}},
    {"GravityEntry", 2, R"(duration = 2.0
gravity = [0.0, "down"])",
     {R"(3:17: error: entry 1 of 'gravity' in [run] is a string, it must be a number, for example gravity = [0.0, -9.81])"}},
    {"TimeStepWord", 2, R"(duration = 2.0
time_step = "fast")",
     {R"(3:13: error: 'time_step' in [run] is 'fast', it must be a number or "auto", for example time_step = 1e-4)"}},
    {"TimeStepZero", 2, R"(duration = 2.0
time_step = 0.0)",
     {R"(3:13: error: 'time_step' in [run] is 0, it must be above 0 and at most 1e+12, for example time_step = 1e-4)"}},
    {"NoStages", 1, R"(stage = []
[run]
gravity = [0, 0]
[output]
interval = 1.0
[fos])",
     {R"(2:1: error: 'duration' in [run] is missing, it is required, for example duration = 2.0)",
      R"(7:1: error: unknown key 'duration' in [fos], it belongs to [run])"}},
    {"SafetyAboveOne", 2, R"(duration = 2.0
safety = 1.5)",
     {R"(3:10: error: 'safety' in [run] is 1.5, it must be above 0 and at most 1, for example safety = 0.55)"}},
    {"SpectralRadius", 2, R"(duration = 2.0
spectral_radius = 1.01)",
     {R"(3:19: error: 'spectral_radius' in [run] is 1.01, it must be at least 0 and at most 1, for example spectral_radius = 0.5)"}},
    {"SchemeUnknown", 2, R"(duration = 2.0
scheme = "newmark")",
     {R"(3:10: error: 'scheme' in [run] is 'newmark', it must be one of generalized-alpha newmark-dda central-difference explicit-generalized-alpha, did you mean 'newmark-dda'?)"}},
    {"SchemeNumber", 2, R"(duration = 2.0
scheme = 3)",
     {R"(3:10: error: 'scheme' in [run] is an integer, it must be a string, for example scheme = "generalized-alpha")"}},
    {"PoissonsRatioHalf", 4, R"(density = 2600.0
poissons_ratio = 0.5)",
     {R"(5:18: error: 'poissons_ratio' in [material.granite] is 0.5, it must be at least 0 and below 0.5, for example poissons_ratio = 0.25)"}},
    {"YoungsModulusZero", 4, R"(density = 2600.0
youngs_modulus = 0)",
     {R"(5:18: error: 'youngs_modulus' in [material.granite] is 0, it must be above 0 and at most 1e+20, for example youngs_modulus = 40e9)"}},
    {"FrictionNinety", 8, R"(normal_stiffness = 1e9
friction_angle_deg = 90)",
     {R"(9:22: error: 'friction_angle_deg' in [joint.default] is 90, it must be at least 0 and below 90, for example friction_angle_deg = 35.0)"}},
    {"CohesionNegative", 8, R"(normal_stiffness = 1e9
cohesion = -1.0)",
     {R"(9:12: error: 'cohesion' in [joint.default] is -1, it must be at least 0 and at most 1e+20, for example cohesion = 0.0)"}},
    {"FixedWord", 13, R"(fixed = "yes")",
     {R"(13:9: error: 'fixed' in block 'base' is a string, it must be true or false, for example fixed = true)"}},
    {"RunAsList", 1, R"([[run]])",
     {R"(1:1: error: 'run' is an array, it must be a table, write [run])"}},
    {"MaterialNumber", 3, R"([material]
sand = 3
[material.granite])",
     {R"(4:8: error: 'sand' in [material] is an integer, it must be a table, write [material.granite])"}},
    {"MaterialName", 3, R"([material."gran ite"])",
     {R"(3:11: error: 'gran ite' in [material] is no name, a name holds 1 to 100 letters, digits, _ . and -, choose another name)",
      R"(11:12: error: no material is named 'granite', did you mean 'gran ite'?)"}},
    {"BlockName", 15, R"(name = "slider/1")",
     {R"(15:8: error: 'name' in block 'b1' is 'slider/1', a name holds 1 to 100 letters, digits, _ . and -, for example name = "slider")"}},
    {"BlockNameEmpty", 15, R"(name = "")",
     {R"(15:8: error: 'name' in block 'b1' is '', a name holds 1 to 100 letters, digits, _ . and -, for example name = "slider")"}},
    {"BlockNameTwice", 15, R"(name = "base")",
     {R"(15:8: error: two blocks are named 'base', the first is at line 9, names are unique, and unnamed blocks are b<n> from 0 in file order)"}},
    {"BlockNameOfUnnamed", 10, R"(name = "b1"
material = "granite"
vertices = [[8, 0], [9, 0], [9, 1]]
[[block]])",
     {R"(13:1: error: two blocks are named 'b1', the first is at line 9, names are unique, and unnamed blocks are b<n> from 0 in file order)"}},
    {"UnknownMaterial", 16, R"(material = "caly")",
     {R"(16:12: error: no material is named 'caly', did you mean 'clay'?)"}},
    {"UnknownMaterialNothingNear", 16, R"(material = "basalt")",
     {R"(16:12: error: no material is named 'basalt', add a table [material.basalt])"}},
    {"TwoVertices", 17, R"(vertices = [[1, 1], [2, 1]])",
     {R"(17:12: error: 'vertices' in block 'slider' has 2 points, a block has at least 3, for example vertices = [[0, 0], [1, 0], [1, 1], [0, 1]])"}},
    {"VertexWithThreeCoordinates", 17, R"(vertices = [[1, 1], [2, 1, 0], [2, 2]])",
     {R"(17:21: error: vertex 1 of 'vertices' in block 'slider' has 3 coordinates, the scene is plane, write [x, y])"}},
    {"VertexNotAPoint", 17, R"(vertices = [[1, 1], 2, [2, 2]])",
     {R"(17:21: error: vertex 1 of 'vertices' in block 'slider' is an integer, it must be a point [x, y], for example vertices = [[0, 0], [1, 0], [1, 1], [0, 1]])"}},
    {"VertexInf", 17, R"(vertices = [[1, 1], [2, 1], [2, -inf]])",
     {R"(17:33: error: vertex 2 of 'vertices' in block 'slider': y is -inf, it must be finite, for example vertices = [[0, 0], [1, 0], [1, 1], [0, 1]])"}},
    {"VertexString", 17, R"(vertices = [[1, 1], [2, 1], ["2", 2]])",
     {R"(17:30: error: vertex 2 of 'vertices' in block 'slider': x is a string, it must be a number, for example vertices = [[0, 0], [1, 0], [1, 1], [0, 1]])"}},
    {"VertexTwice", 17, R"(vertices = [[1, 1], [2, 1], [2, 1], [2, 2]])",
     {R"(17:29: error: vertex 2 of block 'slider' equals vertex 1, an edge needs a length, leave one of them out)"}},
    {"OutlineClosed", 17, R"(vertices = [[1, 1], [2, 1], [2, 2], [1, 1]])",
     {R"(17:37: error: vertex 3 of block 'slider' equals vertex 0, the outline closes by itself, leave one of them out)"}},
    {"ZeroArea", 17, R"(vertices = [[0.1, 0.3], [0.2, 0.6], [0.3, 0.9]])",
     {R"(17:12: error: block 'slider' has zero area, all its vertices lie on one line, check the vertices)"}},
    {"SelfCrossing", 17, R"(vertices = [[1, 1], [2, 2], [2, 1], [1, 2]])",
     {R"(17:12: error: block 'slider' crosses itself, two of its edges meet away from a common vertex, list the vertices in order around the block)"}},
    {"TwiceAround", 17, R"(vertices = [[10, 0], [-8, 6], [3, -10], [3, 10], [-8, -6]])",
     {R"(17:12: error: block 'slider' crosses itself, two of its edges meet away from a common vertex, list the vertices in order around the block)"}},
    {"FixedWithVelocity", 13, R"(fixed = true
velocity = [1, 0, 0])",
     {R"(14:12: error: block 'base' is fixed but has a velocity, a fixed block never moves, leave one of fixed and velocity out)"}},
    {"ContactTimeOfAnotherScheme", 2, R"(duration = 2.0
scheme = "newmark-dda"
contact_time = "start")",
     {R"(4:16: error: 'contact_time' in [run] has no meaning for this scheme, it belongs to generalized-alpha, leave it out)"}},
    {"SpectralRadiusOfAnotherScheme", 2, R"(duration = 2.0
scheme = "central-difference"
spectral_radius = 0.5)",
     {R"(4:19: error: 'spectral_radius' in [run] has no meaning for this scheme, it belongs to generalized-alpha and explicit-generalized-alpha, leave it out)"}},
    {"NeitherStiffness", 8, R"()",
     {R"(7:1: error: [joint.default] gives none of normal_stiffness, allowed_overlap and rock_mass_modulus, exactly one of them is needed, for example normal_stiffness = 1e9)"}},
    {"BothStiffnesses", 8, R"(allowed_overlap = 0.001
normal_stiffness = 1e9)",
     {R"(9:20: error: [joint.default] gives both normal_stiffness and allowed_overlap, one follows from the other, leave one of them out)"}},
    {"StiffnessAndModulus", 8, R"(normal_stiffness = 1e9
rock_mass_modulus = 1e10)",
     {R"(9:21: error: [joint.default] gives normal_stiffness and keys of rock_mass_modulus, one follows from the other, keep normal_stiffness, or rock_mass_modulus with spacing)"}},
    {"ModulusWithoutItsCompanions", 8, R"(rock_mass_modulus = 1e10)",
     {R"(7:1: error: 'spacing' in [joint.default] is missing, the stiffness follows from rock_mass_modulus, spacing and the modulus of intact rock, for example spacing = 0.5)",
      R"(7:1: error: 'intact_modulus' in [joint.default] is missing, [material.clay] has no youngs_modulus, for example intact_modulus = 40e9)"}},
    {"MassStifferThanRock", 8, R"(rock_mass_modulus = 4e10
intact_modulus = 4e10
spacing = 1)",
     {R"(8:21: error: [joint.default] has a rock mass of 4e+10 Pa and intact rock of 4e+10 Pa, joints make rock softer, and the stiffness E_m E_i/(s (E_i - E_m)) would not be positive, use a rock_mass_modulus below 4e+10)"}},
    {"AllowedOverlapWithoutGravity", 1, R"([joint.soft]
materials = ["clay", "clay"]
allowed_overlap = 0.001
[run]
gravity = [0, 0])",
     {R"(3:19: error: 'allowed_overlap' in [joint.soft] has no meaning without gravity, the stiffness follows from the weight of the blocks, give normal_stiffness instead)"}},
    {"DefaultWithMaterials", 8, R"(normal_stiffness = 1e9
materials = ["granite", "clay"])",
     {R"(9:13: error: 'materials' in [joint.default] has no meaning, the default law is for all pairs without their own, leave it out)"}},
    {"LawWithoutMaterials", 8, R"(normal_stiffness = 1e9
[joint.fault]
cohesion = 0)",
     {R"(9:1: error: 'materials' in [joint.fault] is missing, a law other than default is for one pair of materials, or for edges that name it, for example materials = ["granite", "clay"])"}},
    {"UnknownJointOfAnEdge", 17, R"(vertices = [[1, 1], [2, 1], [2, 2], [1, 2]]
edge_joints = ["", "defalt", "", "default"])",
     {R"(18:20: error: no joint is named 'defalt', did you mean 'default'?)"}},
    {"TooFewEdgeJoints", 17, R"(vertices = [[1, 1], [2, 1], [2, 2], [1, 2]]
edge_joints = ["default"])",
     {R"(18:15: error: 'edge_joints' in block 'slider' has 1 entries, the block has 4 edges, write one name for each edge, "" for the law of the materials)"}},
    {"EdgeJointsOfNumbers", 17, R"(vertices = [[1, 1], [2, 1], [2, 2], [1, 2]]
edge_joints = [1, "", "", ""])",
     {R"(18:16: error: entry 0 of 'edge_joints' in block 'slider' is an integer, it must be a string, for example edge_joints = ["bedding", "", "fault", ""])"}},
    {"ResidualAbovePeak", 8, R"(normal_stiffness = 1e9
cohesion = 1e5
friction_angle_deg = 30
residual_friction_angle_deg = 31
residual_cohesion = 2e5)",
     {R"(11:31: error: [joint.default] has a residual friction angle above friction_angle_deg, what is left when a bond breaks is less than before, exchange them)",
      R"(12:21: error: [joint.default] has a residual cohesion above its cohesion, what is left when a bond breaks is less than before, exchange them)"}},
    {"TensionBeyondTheApex", 8, R"(normal_stiffness = 1e9
cohesion = 1e5
friction_angle_deg = 45
tension = 2e5)",
     {R"(11:11: error: [joint.default] has a tension of 200000 Pa, Coulomb's line with a cohesion of 100000 Pa ends at cohesion/tan(friction angle) = 100000 Pa, lower tension or raise cohesion)"}},
    {"TensionWithoutCohesion", 8, R"(normal_stiffness = 1e9
tension = 2e5)",
     {R"(9:11: error: [joint.default] has a tension of 200000 Pa, Coulomb's line with a cohesion of 0 Pa ends at cohesion/tan(friction angle) = 0 Pa, lower tension or raise cohesion)"}},
    {"DilationWithoutLimit", 8, R"(normal_stiffness = 1e9
friction_angle_deg = 30
dilation_angle_deg = 8)",
     {R"(10:22: error: 'dilation_limit' in [joint.default] is missing, no joint opens for ever: its roughness ends where the slip is as long as an asperity, for example dilation_limit = 0.01)"}},
    {"DilationAboveFriction", 8, R"(normal_stiffness = 1e9
friction_angle_deg = 30
cohesion = 1e5
residual_friction_angle_deg = 20
dilation_angle_deg = 21
dilation_limit = 0.01)",
     {R"(12:22: error: [joint.default] has a dilation angle above its residual friction angle, slip would do more work against the pressure than friction takes, lower it)"}},
    {"RoughnessWithoutStrength", 8, R"(normal_stiffness = 1e9
law = "barton-bandis"
jrc = 8)",
     {R"(7:1: error: 'jcs' in [joint.default] is missing, barton-bandis needs jrc and jcs, for example jcs = 50e6)"}},
    {"RoughnessOfCoulomb", 8, R"(normal_stiffness = 1e9
jrc = 8)",
     {R"(9:7: error: 'jrc' in [joint.default] has no meaning for Coulomb's law, it belongs to barton-bandis, write law = "barton-bandis", or leave it out)"}},
    {"BondsOfBartonBandis", 8, R"(normal_stiffness = 1e9
law = "barton-bandis"
jrc = 8
jcs = 1e8
tension = 1e5)",
     {R"(12:11: error: 'tension' in [joint.default] has no meaning for barton-bandis, its friction angle follows from residual_friction_angle_deg, jrc, jcs and the pressure, and it has no bonds, leave it out)"}},
    {"LawWithOneMaterial", 8, R"(normal_stiffness = 1e9
[joint.fault]
materials = ["clay"])",
     {R"(10:13: error: 'materials' in [joint.fault] has length 1, it must have length 2, for example materials = ["granite", "clay"])"}},
    {"LawWithUnknownMaterial", 8, R"(normal_stiffness = 1e9
[joint.fault]
materials = ["clay", "granit"])",
     {R"(10:22: error: no material is named 'granit', did you mean 'granite'?)"}},
    {"TwoLawsForOnePair", 8, R"(normal_stiffness = 1e9
[joint.a]
materials = ["clay", "granite"]
[joint.b]
materials = ["granite", "clay"])",
     {R"(12:13: error: [joint.b] is a second law for 'granite' and 'clay', [joint.a] at line 9 is for them too, keep one of them)"}},
    {"HistoryInterval", 13, R"(fixed = true
[output]
interval = 0.02
history_interval = 0.03)",
     {R"(16:20: error: 'history_interval' in [output] is 0.03, it must divide interval (0.02) or be a multiple of it, for example history_interval = 0.02)"}},
    {"HistoryIntervalOfDefault", 13, R"(fixed = true
[output]
history_interval = 0.03)",
     {R"(15:20: error: 'history_interval' in [output] is 0.03, it must divide interval (0.02) or be a multiple of it, for example history_interval = 0.02)"}},
    {"HistoryIntervalWithoutRatio", 13, R"(fixed = true
[output]
interval = 1
history_interval = 5e-324)",
     {R"(16:20: error: 'history_interval' in [output] is 5e-324, it must divide interval (1) or be a multiple of it, for example history_interval = 1)"}},
    {"DurationWithoutHundredth", 2, R"(duration = 5e-324)",
     {R"(2:12: error: 'duration' in [run] is 5e-324, a hundredth of it, which interval is by default, is 0, use a longer one)"}},
    {"TooManyFrames", 13, R"(fixed = true
[output]
interval = 1e-6)",
     {R"(15:12: error: 'interval' in [output] makes 2000000 frames, frame numbers have six digits, use at least 4e-06)"}},
    {"MonitorOfNothing", 13, R"(fixed = true
[[monitor]]
block = "slidr")",
     {R"(15:9: error: no block is named 'slidr', did you mean 'slider'?)"}},
    {"ProfileWithFaults", 1, R"([[monitor]]
along = [[0, 0], [1, 1]]
[[monitor]]
name = "a"
along = [[0, 0], [1, 1], [2, 2]]
[[monitor]]
name = "b"
along = [[1, 1], [1, 1]]
[[monitor]]
name = "c"
along = [[0, 0], [1, 1]]
point = [0, 0]
[[monitor]]
name = "d"
points = 9
[[monitor]]
name = "energy"
along = [[0, 0], [1, 1]]
[run])",
     {R"(1:1: error: 'name' in [[monitor]] is missing, a profile has name and along, for example name = "wall")",
      R"(5:9: error: 'along' in [[monitor]] has 3 points, a profile is a straight line between two points, for example along = [[0.0, 2.0], [8.0, 2.0]])",
      R"(8:9: error: 'along' in [[monitor]] has the same point twice, a profile is a straight line between two points, for example along = [[0.0, 2.0], [8.0, 2.0]])",
      R"(12:9: error: [[monitor]] gives both along and point, a profile is a line of points, each of which follows the block that holds it, leave point out, or write another [[monitor]] for it)",
      R"(15:10: error: 'points' in [[monitor]] has no meaning without along, it is the number of points of a profile, add along = [[0.0, 2.0], [8.0, 2.0]], or write point = [0.0, 2.0])",
      R"(17:8: error: a profile named 'energy' cannot be monitored, history/energy.csv holds the energies of the scene, choose another name)"}},
    {"MonitorTwice", 13, R"(fixed = true
[[monitor]]
block = "slider"
[[monitor]]
block = "slider")",
     {R"(17:9: error: block 'slider' is monitored twice, keep one of them)"}},
    {"LocalDampingOne", 2, R"(duration = 2.0
local_damping = 1)",
     {R"(3:17: error: 'local_damping' in [run] is 1, it must be at least 0 and below 1, for example local_damping = 0.0)"}},
    {"GravityRampNegative", 2, R"(duration = 2.0
gravity_ramp = -1)",
     {R"(3:16: error: 'gravity_ramp' in [run] is -1, it must be at least 0 and at most 1e+12, for example gravity_ramp = 0.0)"}},
    {"MonitorEnergy", 13, R"(fixed = true
[[monitor]]
block = "energy"
[[block]]
name = "energy"
material = "clay"
vertices = [[7, 1], [8, 1], [8, 2]])",
     {R"(15:9: error: a block named 'energy' cannot be monitored, history/energy.csv holds the energies of the scene, choose another name for the block)"}},
    {"VertexFarAway", 17, R"(vertices = [[1, 1], [2, 1], [2, 1e300]])",
     {R"(17:33: error: vertex 2 of 'vertices' in block 'slider': y is 1e+300, it must be at least -1e+09 and at most 1e+09, for example vertices = [[0, 0], [1, 0], [1, 1], [0, 1]])"}},
    {"VelocityOfTwo", 15, R"(velocity = [1, 2])",
     {R"(15:12: error: 'velocity' in block 'b1' has length 2, it must have length 3, for example velocity = [0.0, 0.0, 0.0])"}},
    {"MonitorAsTable", 13, R"(fixed = true
[monitor]
block = "slider")",
     {R"(14:1: error: 'monitor' is a table, it must be a list of tables, write [[monitor]])"}},
    {"OutputNumber", 1, R"(output = 3
[run])",
     {R"(1:10: error: 'output' is an integer, it must be a table, write [output])"}},
    {"ControlCharacters", 15, R"(name = "a\u001bb"
"x\ny" = 1)",
     {R"(15:8: error: 'name' in block 'b1' is 'a b', a name holds 1 to 100 letters, digits, _ . and -, for example name = "slider")",
      R"(16:1: error: unknown key 'x y' in block 'b1', known here: name material vertices edge_joints velocity fixed fidelity fixed_points prescribed_velocity velocity_table load)"}},
};
// clang-format on

class EveryBadScene : public ::testing::TestWithParam<BadScene> {};

TEST_P(EveryBadScene, SayWhatIsWrong) {
  std::vector<std::string> expected;
  for (const std::string &message : GetParam().expected) {
    expected.push_back("s.toml:" + message);
  }
  EXPECT_EQ(messages(scene_text(GetParam().line, GetParam().replacement)), expected);
}

INSTANTIATE_TEST_SUITE_P(Table, EveryBadScene, ::testing::ValuesIn(bad_scenes),
                         [](const auto &scene) { return std::string(scene.param.name); });

TEST(BadScene, TheSceneTheyAreMadeFromIsGood) {
  EXPECT_EQ(messages(scene_text(0, "")), std::vector<std::string>{});
}

} // namespace
} // namespace gcpdda::bad_scenes_test
