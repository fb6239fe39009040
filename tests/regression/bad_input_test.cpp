// Bad scenes as a table, with the exact words a person reads: blocks and what holds and moves them, walls,
// pyramids, block files, monitors. The other keys are in unit/bad_scenes_test.cpp.

#include "gcpdda/io/scene_reader.hpp"

#include "bad_input.hpp"

#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

namespace gcpdda::bad_input_test {
namespace {

using testing::scene_text;

// clang-format off
/// The good scene with one line replaced.
struct BadScene {
  const char *name;
  std::size_t line; ///< from 1
  const char *replacement;
  std::vector<std::string> expected; ///< without the file name
};

const std::vector<BadScene> bad_scenes{
    {"LocalDampingOne", 2, R"(duration = 2.0
local_damping = 1.0)",
     {R"(3:17: error: 'local_damping' in [run] is 1, it must be at least 0 and below 1, for example local_damping = 0.0)"}},
    {"LocalDampingNegative", 2, R"(duration = 2.0
local_damping = -0.1)",
     {R"(3:17: error: 'local_damping' in [run] is -0.1, it must be at least 0 and below 1, for example local_damping = 0.0)"}},
    {"ElasticityUnknown", 2, R"(duration = 2.0
elasticity = "implict")",
     {R"(3:14: error: 'elasticity' in [run] is 'implict', it must be one of implicit explicit, did you mean 'implicit'?)"}},
    {"ElasticityBoolean", 2, R"(duration = 2.0
elasticity = true)",
     {R"(3:14: error: 'elasticity' in [run] is a boolean, it must be a string, for example elasticity = "implicit")"}},
    {"RunDeformableWithoutModulus", 2, R"(duration = 2.0
fidelity = "deformable")",
     {R"(29:12: error: pyramid 'pyramid0' is deformable but its material 'granite' has neither youngs_modulus nor poissons_ratio, a deformable block has its stiffness from both, for example youngs_modulus = 40e9 and poissons_ratio = 0.25 in [material.granite])"}},
    {"BlockDeformableWithoutModulus", 18, R"(material = "granite"
fidelity = "deformable")",
     {R"(19:12: error: block 'lever' is deformable but its material 'granite' has neither youngs_modulus nor poissons_ratio, a deformable block has its stiffness from both, for example youngs_modulus = 40e9 and poissons_ratio = 0.25 in [material.granite])"}},
    {"BlockDeformableWithoutRatio", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [3, 4], [3, 2], [1, 2]]
[[block]]
material = "chalk"
vertices = [[5, 5], [6, 5], [6, 6]]
fidelity = "deformable"
[material.chalk]
density = 1
youngs_modulus = 1e9)",
     {R"(23:12: error: block 'b2' is deformable but its material 'chalk' has no poissons_ratio, a deformable block has its stiffness from both, for example poissons_ratio = 0.25 in [material.chalk])"}},
    {"DeformableAllOverInTheFile", 2, R"(duration = 2.0
fidelity = "deformable"
[material.chalk]
density = 1
poissons_ratio = 0)",
     {R"(4:1: error: the blocks of the block file are deformable but material 'chalk' has no youngs_modulus, they may be of any material, for example youngs_modulus = 40e9 in [material.chalk])",
      R"(32:12: error: pyramid 'pyramid0' is deformable but its material 'granite' has neither youngs_modulus nor poissons_ratio, a deformable block has its stiffness from both, for example youngs_modulus = 40e9 and poissons_ratio = 0.25 in [material.granite])"}},
    {"UnknownTable", 20, R"([[walls]]
[[wall]])",
     {R"(20:3: error: unknown key 'walls', did you mean 'wall'?)"}},
    {"SelfCrossing", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [2, 0], [1, 2]])",
     {R"(19:12: error: block 'lever' crosses itself, two of its edges meet away from a common vertex, list the vertices in order around the block)"}},
    {"SelfTouching", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [2, 1], [1, 2]])",
     {R"(19:12: error: block 'lever' crosses itself, two of its edges meet away from a common vertex, list the vertices in order around the block)"}},
    {"FoldedBack", 19, R"(vertices = [[1, 1], [4, 1], [2, 1], [2, 4], [1, 4]])",
     {R"(19:12: error: block 'lever' crosses itself, two of its edges meet away from a common vertex, list the vertices in order around the block)"}},
    {"FixedPointOutside", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [3, 4], [3, 2], [1, 2]]
fixed_points = [[1, 1], [2, 3]])",
     {R"(20:25: error: fixed point 1 of block 'lever' is not in the block, [2, 3] lies outside its outline, move it to a place in or on the block)"}},
    {"FixedPointsEmpty", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [3, 4], [3, 2], [1, 2]]
fixed_points = [])",
     {R"(20:16: error: 'fixed_points' in block 'lever' has 0 points, at least one is needed, for example fixed_points = [[0, 0], [1, 0]])"}},
    {"FixedPointsOnePair", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [3, 4], [3, 2], [1, 2]]
fixed_points = [1, 1])",
     {R"(20:17: error: point 0 of 'fixed_points' in block 'lever' is an integer, it must be a point [x, y], for example fixed_points = [[0, 0], [1, 0]])",
      R"(20:20: error: point 1 of 'fixed_points' in block 'lever' is an integer, it must be a point [x, y], for example fixed_points = [[0, 0], [1, 0]])"}},
    {"FixedPointNan", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [3, 4], [3, 2], [1, 2]]
fixed_points = [[1, nan]])",
     {R"(20:21: error: point 0 of 'fixed_points' in block 'lever': y is nan, it must be finite, for example fixed_points = [[0, 0], [1, 0]])"}},
    {"FixedPointsOfFixedBlock", 15, R"(fixed = true
fixed_points = [[0, 0]])",
     {R"(16:16: error: block 'floor' is fixed but has fixed_points, all of it is held, leave one of fixed and fixed_points out)"}},
    {"PrescribedAndFixed", 15, R"(fixed = true
prescribed_velocity = [1, 0, 0])",
     {R"(16:23: error: block 'floor' is fixed but has a prescribed_velocity, a fixed block never moves, leave one of fixed and prescribed_velocity out)"}},
    {"PrescribedAndVelocity", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [3, 4], [3, 2], [1, 2]]
velocity = [0, 0, 0]
prescribed_velocity = [1, 0, 0])",
     {R"(21:23: error: block 'lever' has both velocity and prescribed_velocity, it keeps the prescribed one from the start, leave velocity out)"}},
    {"PrescribedAndFixedPoints", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [3, 4], [3, 2], [1, 2]]
prescribed_velocity = [1, 0, 0]
fixed_points = [[1, 1]])",
     {R"(20:23: error: block 'lever' has both fixed_points and prescribed_velocity, a point cannot be held and move, leave one of them out)"}},
    {"PrescribedOfTwo", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [3, 4], [3, 2], [1, 2]]
prescribed_velocity = [1, 0])",
     {R"(20:23: error: 'prescribed_velocity' in block 'lever' has length 2, it must have length 3, for example prescribed_velocity = [1.0, 0.0, 0.0])"}},
    {"PrescribedAndDeformable", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [3, 4], [3, 2], [1, 2]]
prescribed_velocity = [1, 0, 0]
fidelity = "deformable")",
     {R"(21:12: error: block 'lever' has a prescribed velocity but is deformable, its motion is prescribed as that of a rigid body, leave fidelity out or write "rigid")"}},
    {"TableAndFixed", 15, R"(fixed = true
velocity_table = [[0, 1, 0, 0]])",
     {R"(16:18: error: block 'floor' is fixed but has a velocity_table, a fixed block never moves, leave one of fixed and velocity_table out)"}},
    {"TableAndAllElse", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [3, 4], [3, 2], [1, 2]]
velocity = [0, 0, 0]
prescribed_velocity = [1, 0, 0]
fixed_points = [[1, 1]]
velocity_table = [[0, 1, 0, 0]]
[[block.load]]
point = [2, 2]
force = [0, 1])",
     {R"(23:18: error: block 'lever' has both velocity and velocity_table, it keeps the prescribed one from the start, leave velocity out)",
      R"(23:18: error: block 'lever' has both prescribed_velocity and velocity_table, only one can be followed, leave one of them out)",
      R"(23:18: error: block 'lever' has both fixed_points and velocity_table, a point cannot be held and move, leave one of them out)",
      R"(24:1: error: block 'lever' has a prescribed velocity but has a load, no force changes its motion, leave the load out)"}},
    {"TableAndDeformable", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [3, 4], [3, 2], [1, 2]]
velocity_table = [[0, 1, 0, 0]]
fidelity = "deformable")",
     {R"(21:12: error: block 'lever' has a prescribed velocity but is deformable, its motion is prescribed as that of a rigid body, leave fidelity out or write "rigid")"}},
    {"TableOutOfOrder", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [3, 4], [3, 2], [1, 2]]
velocity_table = [[0.5, 1, 0, 0], [1, 0, 0, 0], [1, 0, 0, 0], [0.75, 0, 0, 0]])",
     {R"(20:20: error: row 0 of 'velocity_table' in block 'lever' has the time 0.5, the table must begin at 0, add a row for the time 0)",
      R"(20:50: error: row 2 of 'velocity_table' in block 'lever' has the time 1, it must be above that of the row before, 1, order the rows by time)",
      R"(20:64: error: row 3 of 'velocity_table' in block 'lever' has the time 0.75, it must be above that of the row before, 1, order the rows by time)"}},
    {"TableOfOtherRows", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [3, 4], [3, 2], [1, 2]]
velocity_table = [[0, 1, 0], 3, [0, 0, 0, "a"], [0, 0, 0, inf]])",
     {R"(20:19: error: row 0 of 'velocity_table' in block 'lever' has length 3, it must have length 4, for example velocity_table = [[0, 0, 0, 0], [0.5, 1.0, 0, 0]])",
      R"(20:30: error: row 1 of 'velocity_table' in block 'lever' is an integer, it must be an array of 4 numbers, for example velocity_table = [[0, 0, 0, 0], [0.5, 1.0, 0, 0]])",
      R"(20:43: error: entry 3 of row 2 of 'velocity_table' in block 'lever' is a string, it must be a number, for example velocity_table = [[0, 0, 0, 0], [0.5, 1.0, 0, 0]])",
      R"(20:59: error: entry 3 of row 3 of 'velocity_table' in block 'lever' is inf, it must be finite, for example velocity_table = [[0, 0, 0, 0], [0.5, 1.0, 0, 0]])"}},
    {"TableEmpty", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [3, 4], [3, 2], [1, 2]]
velocity_table = [])",
     {R"(20:18: error: 'velocity_table' in block 'lever' has 0 rows, it must have 1 to 100000, for example velocity_table = [[0, 0, 0, 0], [0.5, 1.0, 0, 0]])"}},
    {"TableAsNumber", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [3, 4], [3, 2], [1, 2]]
velocity_table = 1)",
     {R"(20:18: error: 'velocity_table' in block 'lever' is an integer, it must be an array of rows [t, vx, vy, omega], for example velocity_table = [[0, 0, 0, 0], [0.5, 1.0, 0, 0]])"}},
    {"LoadOutside", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [3, 4], [3, 2], [1, 2]]
[[block.load]]
point = [2, 2.5]
force = [0, -1])",
     {R"(21:9: error: the point of load 0 of block 'lever' is not in the block, [2, 2.5] lies outside its outline, move it to a place in or on the block)"}},
    {"LoadWithoutForce", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [3, 4], [3, 2], [1, 2]]
[[block.load]]
point = [2, 2])",
     {R"(20:1: error: 'force' in load 0 of block 'lever' is missing, it is required, for example force = [0.0, -1e5])"}},
    {"LoadWithoutPoint", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [3, 4], [3, 2], [1, 2]]
[[block.load]]
force = [0, -1]
[[block.load]]
point = [2, 2]
force = [0])",
     {R"(20:1: error: 'point' in load 0 of block 'lever' is missing, it is required, for example point = [0.5, 1.0])",
      R"(24:9: error: 'force' in load 1 of block 'lever' has length 1, it must have length 2, for example force = [0.0, -1e5])"}},
    {"LoadUnknownKey", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [3, 4], [3, 2], [1, 2]]
[[block.load]]
point = [2, 2]
force = [0, 1]
moment = 3)",
     {R"(23:1: error: unknown key 'moment' in load 0 of block 'lever', known here: point force ramp table)"}},
    {"LoadAsTable", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [3, 4], [3, 2], [1, 2]]
[block.load]
point = [2, 2]
force = [0, 1])",
     {R"(20:1: error: 'load' in block 'lever' is a table, it must be a list of tables, write [[block.load]])"}},
    {"LoadAsNumbers", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [3, 4], [3, 2], [1, 2]]
load = [1, 2])",
     {R"(20:9: error: 'load[0]' is an integer, it must be a table, write [[block.load]])",
      R"(20:12: error: 'load[1]' is an integer, it must be a table, write [[block.load]])"}},
    {"LoadOnFixedBlock", 15, R"(fixed = true
[[block.load]]
point = [0, 0]
force = [0, 1])",
     {R"(16:1: error: block 'floor' is fixed but has a load, no force changes its motion, leave the load out)"}},
    {"LoadOnDrivenBlock", 19, R"(vertices = [[1, 1], [4, 1], [4, 4], [3, 4], [3, 2], [1, 2]]
prescribed_velocity = [1, 0, 0]
[[block.load]]
point = [2, 2]
force = [0, 1])",
     {R"(21:1: error: block 'lever' has a prescribed velocity but has a load, no force changes its motion, leave the load out)"}},
    {"WallWithoutAnything", 20, R"([[wall]]
[[wall]])",
     {R"(20:1: error: 'material' in wall 'wall0' is missing, it is required, for example material = "granite")",
      R"(20:1: error: 'origin' in wall 'wall0' is missing, it is required, for example origin = [0.0, 0.0])",
      R"(20:1: error: 'rows' in wall 'wall0' is missing, it is required, for example rows = 10)",
      R"(20:1: error: 'columns' in wall 'wall0' is missing, it is required, for example columns = 20)",
      R"(20:1: error: 'block_size' in wall 'wall0' is missing, it is required, for example block_size = [0.4, 0.2])"}},
    {"WallUnknownKey", 25, R"(columns = 6
colums = 3)",
     {R"(26:1: error: unknown key 'colums' in wall 'w', did you mean 'columns'?)"}},
    {"WallRowsReal", 24, R"(rows = 4.5)",
     {R"(24:8: error: 'rows' in wall 'w' is 4.5, it must be an integer, for example rows = 10)"}},
    {"WallRowsZero", 24, R"(rows = 0)",
     {R"(24:8: error: 'rows' in wall 'w' is 0, it must be at least 1 and at most 1e+06, for example rows = 10)"}},
    {"WallColumnsText", 25, R"(columns = "six")",
     {R"(25:11: error: 'columns' in wall 'w' is a string, it must be an integer, for example columns = 20)"}},
    {"WallTooManyRows", 24, R"(rows = 1000001)",
     {R"(24:8: error: 'rows' in wall 'w' is 1000001, it must be at least 1 and at most 1e+06, for example rows = 10)"}},
    {"WallTooManyBlocks", 20, R"([[wall]]
name = "big"
material = "clay"
origin = [50, 0]
rows = 1000000.0
columns = 1000000
block_size = [0.4, 0.2]
[[wall]])",
     {R"(20:1: error: wall 'big' makes 1000000500000 blocks, a scene has at most 2147483647 in all, use fewer rows or columns)"}},
    {"WallSizeOfOne", 26, R"(block_size = 0.4)",
     {R"(26:14: error: 'block_size' in wall 'w' is a real number, it must be an array of 2 numbers, for example block_size = [0.4, 0.2])"}},
    {"WallSizeZero", 26, R"(block_size = [0.4, 0])",
     {R"(26:20: error: entry 1 of 'block_size' in wall 'w' is 0, it must be above 0 and at most 1e+09, for example block_size = [0.4, 0.2])"}},
    {"WallBondOne", 26, R"(block_size = [0.4, 0.2]
bond = 1)",
     {R"(27:8: error: 'bond' in wall 'w' is 1, it must be at least 0 and below 1, for example bond = 0.5)"}},
    {"WallBondCutsTooThin", 26, R"(block_size = [0.4, 0.2]
bond = 0.95)",
     {R"(27:8: error: wall 'w' would be cut into bricks 0.02 m wide at its right end, bond 0.95 and gap 0 m leave less than a tenth of the width 0.4 m, use a smaller gap, or a bond nearer to 0.5, or 0)"}},
    {"WallGapCutsTooThin", 26, R"(block_size = [0.4, 0.2]
gap = 0.33)",
     {R"(27:7: error: wall 'w' would be cut into bricks 0.035 m wide at its right end, bond 0.5 and gap 0.33 m leave less than a tenth of the width 0.4 m, use a smaller gap, or a bond nearer to 0.5, or 0)"}},
    {"WallGapLeavesNothing", 26, R"(block_size = [0.4, 0.2]
gap = 0.8
bond = 0.3)",
     {R"(28:8: error: wall 'w' has no room for the bricks at its left end, bond 0.3 and gap 0.8 m leave less than a tenth of the width 0.4 m, use a smaller gap, or a bond nearer to 0.5, or 0)"}},
    {"WallGapNegative", 26, R"(block_size = [0.4, 0.2]
gap = -0.1)",
     {R"(27:7: error: 'gap' in wall 'w' is -0.1, it must be at least 0 and at most 1e+09, for example gap = 0.0)"}},
    {"WallMaterialUnknown", 22, R"(material = "claay")",
     {R"(22:12: error: no material is named 'claay', did you mean 'clay'?)"}},
    {"WallFarAway", 23, R"(origin = [999999999, 0])",
     {R"(20:1: error: wall 'w' reaches to [1000000001.4, 0.8], coordinates are at most 1000000000, use fewer or smaller bricks)"}},
    {"WallLostInRounding", 26, R"(block_size = [1e-14, 0.2])",
     {R"(26:14: error: the bricks of wall 'w' are lost in rounding, its coordinates reach 10 and hold 16 digits, use larger bricks or an origin nearer to [0, 0])"}},
    {"WallNameOfBlock", 21, R"(name = "lever")",
     {R"(21:8: error: wall 'lever' has the name of block 'lever', the first is at line 16, names of blocks, walls and pyramids are unique: choose another one)",
      R"(35:9: error: no block is named 'w.1.6', unnamed blocks are b<n>, from 0 in file order)"}},
    {"WallNameOfPyramid", 21, R"(name = "pyramid0")",
     {R"(27:1: error: pyramid 'pyramid0' has the name of wall 'pyramid0', the first is at line 20, names of blocks, walls and pyramids are unique: choose another one)",
      R"(35:9: error: no block is named 'w.1.6', unnamed blocks are b<n>, from 0 in file order)"}},
    {"WallNameTwice", 20, R"([[wall]]
name = "w"
material = "clay"
origin = [50, 0]
rows = 1
columns = 1
block_size = [1, 1]
[[wall]])",
     {R"(28:8: error: two walls are named 'w', the first is at line 20, names of blocks, walls and pyramids are unique: choose another one)"}},
    {"BlockNameOfBrick", 17, R"(name = "w.0.5")",
     {R"(17:8: error: block 'w.0.5' has the name of a brick, those of walls and pyramids are named <wall>.<row>.<column>, choose another name)"}},
    {"WallName", 21, R"(name = "w/1")",
     {R"(21:8: error: 'name' in wall 'wall0' is 'w/1', a name holds 1 to 100 letters, digits, _ . and -, for example name = "wall")",
      R"(35:9: error: no block is named 'w.1.6', unnamed blocks are b<n>, from 0 in file order)"}},
    {"PyramidGapTooWide", 31, R"(block_size = [0.4, 0.2]
gap = 0.33)",
     {R"(32:7: error: the gap of pyramid 'pyramid0' is 0.33 m, bricks 0.4 m wide would rest on less than a tenth of their width, use a gap of at most 0.32 m)"}},
    {"PyramidWithColumns", 30, R"(rows = 5
columns = 5)",
     {R"(31:1: error: unknown key 'columns' in pyramid 'pyramid0', it belongs to [[wall]])"}},
    {"PyramidDeformable", 2, R"(duration = 2.0
fidelity = "deformable")",
     {R"(29:12: error: pyramid 'pyramid0' is deformable but its material 'granite' has neither youngs_modulus nor poissons_ratio, a deformable block has its stiffness from both, for example youngs_modulus = 40e9 and poissons_ratio = 0.25 in [material.granite])"}},
    {"BlocksWithoutFile", 33, R"()",
     {R"(32:1: error: 'file' in [blocks] is missing, it is required, for example file = "blocks.h5")"}},
    {"BlocksFileEmpty", 33, R"(file = "")",
     {R"(33:8: error: 'file' in [blocks] has 0 characters, it must have 1 to 4096, for example file = "blocks.h5")"}},
    {"BlocksFileNumber", 33, R"(file = 5)",
     {R"(33:8: error: 'file' in [blocks] is an integer, it must be a string, for example file = "blocks.h5")"}},
    {"BlocksFileOfTwoLines", 33, R"(file = "a\nb")",
     {R"(33:8: error: 'file' in [blocks] holds control characters, it must be one line of text, for example file = "blocks.h5")"}},
    {"BlocksAsList", 32, R"([[blocks]])",
     {R"(32:1: error: 'blocks' is an array, it must be a table, write [blocks])"}},
    {"BlocksUnknownKey", 33, R"(file = "blocks.h5"
path = "x.h5")",
     {R"(34:1: error: unknown key 'path' in [blocks], known here: file)"}},
    {"MonitorBrickBeyond", 35, R"(block = "w.1.7")",
     {R"(35:9: error: no block is named 'w.1.7', blocks of 'w' are w.<row>.<column>, from w.0.0 to w.3.6)"}},
    {"MonitorBlockAndPoint", 35, R"(block = "lever"
point = [1, 2])",
     {R"(35:9: error: [[monitor]] gives block and point without name, it is a block alone, or a named point with or without the block it follows, add name, or leave point out)"}},
    {"MonitorBlockAndName", 35, R"(block = "lever"
name = "tip")",
     {R"(35:9: error: [[monitor]] gives block and name without point, it is a block alone, or a named point with or without the block it follows, add point, or leave name out)"}},
    {"MonitorPointOfNoBlock", 37, R"(name = "tip"
block = "levr")",
     {R"(38:9: error: no block is named 'levr', did you mean 'lever'?)"}},
    {"MonitorNothing", 35, R"()",
     {R"(34:1: error: [[monitor]] gives neither block nor name and point, it is either a block or a named point, for example block = "slider")"}},
    {"MonitorPointWithoutName", 37, R"()",
     {R"(36:1: error: 'name' in [[monitor]] is missing, a monitored point has name and point, for example name = "roof")"}},
    {"MonitorNameWithoutPoint", 38, R"()",
     {R"(36:1: error: 'point' in [[monitor]] is missing, a monitored point has name and point, for example point = [0.0, 1.0])"}},
    {"MonitorPointNamedEnergy", 37, R"(name = "energy")",
     {R"(37:8: error: a point named 'energy' cannot be monitored, history/energy.csv holds the energies of the scene, choose another name)"}},
    {"MonitorPointNamedAsBlock", 37, R"(name = "w.1.6")",
     {R"(37:8: error: two monitors are named 'w.1.6', the one at line 35 writes history/w.1.6.csv too, choose another name for the point)"}},
    {"MonitorPointOfThree", 38, R"(point = [1, 2, 3])",
     {R"(38:9: error: 'point' in [[monitor]] has length 3, it must have length 2, for example point = [0.0, 1.0])"}},
    {"MonitorPointTwice", 38, R"(point = [1, 2]
[[monitor]]
name = "roof"
point = [2, 2])",
     {R"(40:8: error: two monitors are named 'roof', the one at line 37 writes history/roof.csv too, choose another name for the point)"}},
    {"MonitorBeforeTheFile", 35, R"(block = "b3")",
     {R"(35:9: error: no block is named 'b3', the blocks of the file begin with b43)"}},
};
// clang-format on

std::vector<std::string> messages(const std::string &text) {
  std::vector<std::string> result;
  for (const Diagnostic &diagnostic : read_scene(text, "s.toml", {}).diagnostics) {
    result.push_back(to_string(diagnostic));
  }
  return result;
}

std::ostream &operator<<(std::ostream &stream, const BadScene &scene) {
  return stream << scene.name;
}

class BadInputScene : public ::testing::TestWithParam<BadScene> {};

TEST_P(BadInputScene, IsRefusedWithTheseWords) {
  std::vector<std::string> expected;
  for (const std::string &message : GetParam().expected) {
    expected.push_back("s.toml:" + message);
  }
  EXPECT_EQ(messages(scene_text(GetParam().line, GetParam().replacement)), expected);
}

INSTANTIATE_TEST_SUITE_P(Table, BadInputScene, ::testing::ValuesIn(bad_scenes),
                         [](const auto &scene) { return std::string(scene.param.name); });

TEST(BadInput, IsMadeFromAGoodScene) {
  EXPECT_EQ(messages(scene_text()), std::vector<std::string>{});
}

} // namespace
} // namespace gcpdda::bad_input_test
