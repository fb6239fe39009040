#include "io/scene/scene_keys.hpp"

#include "io/scene/joint_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <sstream>
#include <vector>

namespace gcpdda::scene_text {

namespace {

// Upper bounds without a physical reason are there so that no product of input numbers overflows.
// clang-format off
constexpr Key keys_before_joints[] = {
  {"run", Kind::table, required, any, "", "", "[run]", "How the run goes."},
  {"run.duration", Kind::number, optional, above_to(0, 1e12), "", "<required without [[stage]]>", "2.0", "[s] Simulated time; with [[stage]] the stages say how long they last."},
  {"run.gravity", Kind::vector2, optional, from_to(-1e6, 1e6), "", "[0.0, -9.81]", "[0.0, -9.81]", "[m/s2] Acceleration of gravity."},
  {"run.gravity_ramp", Kind::number, optional, from_to(0, 1e12), "", "0.0", "0.0", "[s] Time over which gravity rises smoothly from zero."},
  {"run.time_step", Kind::number_or_auto, optional, above_to(0, 1e12), "", "\"auto\"", "1e-4", "[s] Time step, used as given, or \"auto\" for the largest one that meets the stability bound and in which blocks with a given velocity move by less than a quarter of the narrowest block width."},
  {"run.safety", Kind::number, optional, above_to(0, 1), "", "0.55", "0.55", "Fraction of the stability bound that \"auto\" takes. Settle stages take 0.9, unless safety is below 0.55."},
  {"run.scheme", Kind::choice, optional, any, "generalized-alpha newmark-dda central-difference explicit-generalized-alpha", "\"generalized-alpha\"", "\"generalized-alpha\"", "Time integration."},
  {"run.spectral_radius", Kind::number, optional, from_to(0, 1), "", "0.5", "0.5", "Spectral radius at infinite frequency of generalized-alpha and explicit-generalized-alpha: 1 keeps all high frequencies, 0 removes them in one step."},
  {"run.contact_time", Kind::choice, optional, any, "leapfrog start predictor predictor-end", "\"leapfrog\"", "\"leapfrog\"", "Where within the step generalized-alpha takes the contact force."},
  {"run.potential", Kind::choice, optional, any, "exact linear", "\"exact\"", "\"exact\"", "Contact potential. The forces of `linear` work on closed paths: no energy belongs to them, the residual of energy.csv holds their work, and impacts are not watched."},
  {"run.fidelity", Kind::choice, optional, any, "auto rigid deformable", "\"auto\"", "\"auto\"", "How blocks deform; auto decides for each block by its stiffness and that of its joints."},
  {"run.accepted_error", Kind::number, optional, above_to(0, 1), "", "0.01", "0.01", "Relative error up to which fidelity \"auto\" computes a block as rigid."},
  {"run.initial_friction", Kind::choice, optional, any, "consistent zero", "\"consistent\"", "\"consistent\"", "Shear force of the contacts that exist at the start. Bonds begin without any under the static solver."},
  {"run.contact_damping", Kind::number, optional, from_to(0, 100), "", "0.05", "0.05", "Damping ratio of the contact dashpots: the share of critical damping with which two blocks swing on a contact as wide as the root L of the smaller block's area. On a contact of width w the ratio is sqrt(w/L) times that."},
  {"run.rayleigh", Kind::table, optional, any, "", "", "rayleigh = { ratio = 0.02, frequency = 2.0 }", "Rayleigh damping C = alpha M + beta K of blocks, joints and the rock of deformable blocks, instead of contact_damping. It shortens the step; gcpdda inspect says by how much."},
  {"run.rayleigh.ratio", Kind::number, required, above_to(0, 10), "", "", "0.02", "Damping ratio at that frequency, where it is least: alpha = 2 pi frequency ratio, beta = ratio/(2 pi frequency)."},
  {"run.rayleigh.frequency", Kind::number, required, above_to(0, 1e9), "", "", "2.0", "[Hz] That frequency."},
  {"run.local_damping", Kind::number, optional, from_below(0, 1), "", "0.0", "0.0", "Share of the net force that is taken away against the motion; for static problems only."},
  {"run.elasticity", Kind::choice, optional, any, "implicit explicit", "\"implicit\"", "\"implicit\"", "Where the elastic force of deformable blocks is taken."},
  {"run.plane", Kind::choice, optional, any, "strain stress", "\"strain\"", "\"strain\"", "Plane strain or plane stress."},

  {"material", Kind::named_tables, required, any, "", "", "[material.granite]", "The rocks of the scene, one table each, in this order."},
  {"material.*", Kind::table, optional, any, "", "", "[material.granite]", "One rock."},
  {"material.*.density", Kind::number, required, above_to(0, 1e12), "", "", "2600.0", "[kg/m3] Density."},
  {"material.*.youngs_modulus", Kind::number, optional, above_to(0, 1e20), "", "<none>", "40e9", "[Pa] Young's modulus; needed only where a block may deform."},
  {"material.*.poissons_ratio", Kind::number, optional, from_below(0, 0.5), "", "<none>", "0.25", "Poisson's ratio; needed only where a block may deform."},
};
constexpr Key keys_after_joints[] = {
  {"block[]", Kind::table_list, optional, any, "", "", "[[block]]", "Single blocks; they have the first ids, walls and pyramids in the order of the file the next."},
  {"block[].name", Kind::name, optional, any, "", "<b and the position of the block, from 0>", "\"slider\"", "Name, unique in the scene."},
  {"block[].material", Kind::name, required, any, "", "", "\"granite\"", "One of the materials."},
  {"block[].vertices", Kind::polygon, required, from_to(-1e9, 1e9), "", "", "[[0, 0], [1, 0], [1, 1], [0, 1]]", "[m] Corners in order around the block, either way round."},
  {"block[].edge_joints", Kind::names_or_blanks, optional, any, "", "<by the materials>", "[\"bedding\", \"\", \"fault\", \"\"]", "Contact laws [joint.NAME] of the edges, one a vertex: the edge from each vertex to the next one; \"\" for the law of the materials. Where two edges with a law meet, the weaker one holds: smaller friction angle, then smaller cohesion, then first in the scene."},
  {"block[].velocity", Kind::vector3, optional, from_to(-1e9, 1e9), "", "[0.0, 0.0, 0.0]", "[0.0, 0.0, 0.0]", "[m/s, m/s, rad/s] Initial velocity of the centroid and angular velocity, counter-clockwise positive."},
  {"block[].fixed", Kind::boolean, optional, any, "", "false", "true", "A fixed block never moves."},
  {"block[].fidelity", Kind::choice, optional, any, "auto rigid deformable", "<run.fidelity>", "\"rigid\"", "How this block deforms; auto is as run.fidelity says."},
  {"block[].fixed_points", Kind::points, optional, from_to(-1e9, 1e9), "", "<none>", "[[0, 0], [1, 0]]", "[m] Points in or on the block that are held where they are at the start."},
  {"block[].prescribed_velocity", Kind::vector3, optional, from_to(-1e9, 1e9), "", "<none>", "[1.0, 0.0, 0.0]", "[m/s, m/s, rad/s] Velocity that the block keeps whatever acts on it; not together with fixed, velocity or fixed_points."},
  {"block[].velocity_table", Kind::velocity_table, optional, from_to(-1e9, 1e9), "", "<none>", "[[0, 0, 0, 0], [0.5, 1.0, 0, 0]]", "[s, m/s, m/s, rad/s] Velocity that the block follows whatever acts on it: rows of time, velocity of the centroid and angular velocity, linear between rows, the last one kept; times rise from 0; not together with fixed, velocity, prescribed_velocity or fixed_points."},
  {"block[].load[]", Kind::table_list, optional, any, "", "", "[[block.load]]", "Forces on the block above them, constant unless ramp or table says otherwise."},
  {"block[].load[].point", Kind::vector2, required, from_to(-1e9, 1e9), "", "", "[0.5, 1.0]", "[m] Where the force acts at the start, in or on the block; it goes with the block."},
  {"block[].load[].force", Kind::vector2, required, from_to(-1e20, 1e20), "", "", "[0.0, -1e5]", "[N/m] Force per metre of thickness; it keeps its direction."},
  {"block[].load[].ramp", Kind::number, optional, from_to(0, 1e12), "", "<0.0>", "0.5", "[s] Time over which the force rises smoothly from zero, as gravity does with run.gravity_ramp, from the start of the run or of the stage that sets the load."},
  {"block[].load[].table", Kind::factor_table, optional, from_to(-1e20, 1e20), "", "<none: the force is constant>", "[[0, 0.0], [0.5, 1.0], [2.0, 1.0], [2.1, 0.0]]", "[s, 1] What the force is multiplied by, instead of ramp: rows of time and factor, linear between rows, the last factor kept; times rise from 0, which is the start of the run or of the stage that sets the load. Two loads at one point with a table each turn the force."},

  {"wall[]", Kind::table_list, optional, any, "", "", "[[wall]]", "Walls of equal bricks, named <wall>.<row>.<column> from 0, rows from below, bricks from the left; with bond, every second row begins and ends with a cut brick."},
  {"wall[].name", Kind::name, optional, any, "", "<wall and its position among the walls, from 0>", "\"wall\"", "Name, unique among blocks, walls and pyramids."},
  {"wall[].material", Kind::name, required, any, "", "", "\"granite\"", "One of the materials."},
  {"wall[].origin", Kind::vector2, required, from_to(-1e9, 1e9), "", "", "[0.0, 0.0]", "[m] Lower left corner."},
  {"wall[].rows", Kind::count, required, from_to(1, 1e6), "", "", "10", "Number of rows."},
  {"wall[].columns", Kind::count, required, from_to(1, 1e6), "", "", "20", "Whole bricks in the lowest row."},
  {"wall[].block_size", Kind::vector2, required, above_to(0, 1e9), "", "", "[0.4, 0.2]", "[m] Width and height of a brick."},
  {"wall[].bond", Kind::number, optional, from_below(0, 1), "", "0.5", "0.5", "Shift of every second row, in brick widths; 0 for none."},
  {"wall[].gap", Kind::number, optional, from_to(0, 1e9), "", "0.0", "0.0", "[m] Gap between neighbours of a row."},

  {"pyramid[]", Kind::table_list, optional, any, "", "", "[[pyramid]]", "Pyramids of equal bricks, each row one brick shorter than the one below; named as those of a wall."},
  {"pyramid[].name", Kind::name, optional, any, "", "<pyramid and its position among the pyramids, from 0>", "\"pyramid\"", "Name, unique among blocks, walls and pyramids."},
  {"pyramid[].material", Kind::name, required, any, "", "", "\"granite\"", "One of the materials."},
  {"pyramid[].origin", Kind::vector2, required, from_to(-1e9, 1e9), "", "", "[0.0, 0.0]", "[m] Lower left corner."},
  {"pyramid[].rows", Kind::count, required, from_to(1, 1e6), "", "", "100", "Number of rows, and of bricks in the lowest row."},
  {"pyramid[].block_size", Kind::vector2, required, above_to(0, 1e9), "", "", "[0.4, 0.2]", "[m] Width and height of a brick."},
  {"pyramid[].gap", Kind::number, optional, from_to(0, 1e9), "", "0.0", "0.0", "[m] Gap between neighbours of a row."},

  {"blocks", Kind::table, optional, any, "", "", "[blocks]", "Blocks from an HDF5 file, named b<id>; their ids follow those of the scene file."},
  {"blocks.file", Kind::text, required, any, "", "", "\"blocks.h5\"", "Path of the file, from the folder of the scene file."},

  {"region", Kind::table, optional, any, "", "", "[region]", "Rock that joints cut into blocks, named b<id>; their ids follow those of all other blocks. gcpdda blocks cuts, checks and draws them without a run."},
  {"region.polygon", Kind::polygon, optional, from_to(-1e9, 1e9), "", "<exactly one of this and slope>", "[[0, 0], [20, 0], [20, 10], [0, 10]]", "[m] Outline of the region, either way round."},
  {"region.material", Kind::name, required, any, "", "", "\"granite\"", "One of the materials, where no layer says otherwise."},
  {"region.azimuth", Kind::number, optional, from_to(-360, 360), "", "<required by joint sets with dip_direction>", "90.0", "[degrees] Direction of the x axis of the section, clockwise from north."},
  {"region.min_width", Kind::number, optional, from_to(0, 1e9), "", "<1/50 of the smallest mean spacing or cell, 1/20 with [in_situ]>", "0.02", "[m] A block of a smaller mean width (area over the longest way across) is a sliver."},
  {"region.min_area", Kind::number, optional, from_to(0, 1e18), "", "<the square of min_width>", "4e-4", "[m2] A block of a smaller area is a sliver."},
  {"region.slivers", Kind::choice, optional, any, "merge refuse keep", "<merge>", "\"refuse\"", "A sliver becomes part of the neighbour of its material and opening that shares most of its boundary, up to three times over; or it is a fault; or it stays."},
  {"region.max_blocks", Kind::count, optional, from_to(1, 2147483647), "", "<2000000>", "500000", "A scene whose joints would cut about more blocks than this is a fault."},
  {"region.fixed", Kind::words, optional, any, "bottom left right top", "<none>", "[\"bottom\", \"left\"]", "Sides of the region's bounding box along which a fixed block lies."},
  {"region.roller", Kind::words, optional, any, "bottom left right top", "<none>", "[\"left\", \"right\"]", "Sides along which a fixed block named roller.<side> lies that holds the normal direction only: the law of its edges is [joint.roller], or where the scene has none the default one without friction and cohesion."},
  {"region.stress", Kind::words, optional, any, "bottom left right top", "<none>", "[\"top\"]", "Sides on which the stress of [in_situ] acts from outside, on the edges that lie on the side at the start, the same whatever moves; a stage can change the stress and the sides."},
  {"region.fixed_thickness", Kind::number, optional, above_to(0, 1e9), "", "<1/20 of the square root of the region's area>", "1.0", "[m] Thickness of the blocks along fixed sides and rollers."},

  {"region.slope", Kind::table, optional, any, "", "", "[region.slope]", "A slope that rises to the right, instead of polygon: level ground, benches, level crest."},
  {"region.slope.toe", Kind::vector2, optional, from_to(-1e8, 1e8), "", "<[0.0, 0.0]>", "[0.0, 0.0]", "[m] Foot of the lowest face."},
  {"region.slope.toe_length", Kind::number, required, above_to(0, 1e8), "", "", "30.0", "[m] Level ground left of the toe."},
  {"region.slope.crest_length", Kind::number, required, above_to(0, 1e8), "", "", "50.0", "[m] Level ground behind the highest face."},
  {"region.slope.depth", Kind::number, required, above_to(0, 1e8), "", "", "20.0", "[m] Rock below the toe."},
  {"region.slope.bench[]", Kind::table_list, required, any, "", "", "[[region.slope.bench]]", "Faces from below, at least one, each with the level berm above it."},
  {"region.slope.bench[].height", Kind::number, required, above_to(0, 1e8), "", "", "15.0", "[m] Height of the face."},
  {"region.slope.bench[].face_angle_deg", Kind::number, required, above_to(0, 90), "", "", "70.0", "[degrees] Angle of the face against the horizontal."},
  {"region.slope.bench[].width", Kind::number, optional, from_to(0, 1e8), "", "<0.0>", "6.0", "[m] Width of the berm above the face; above the highest one it adds to the crest."},

  {"joint_set[]", Kind::table_list, optional, any, "", "", "[[joint_set]]", "Parallel joints through the region. Every quantity of a joint depends on the seed, the position of its set in the file and the number of the joint alone."},
  {"joint_set[].name", Kind::name, optional, any, "", "<joint_set and its position, from 0>", "\"bedding\"", "Name, for messages and --set."},
  {"joint_set[].joint", Kind::name, optional, any, "", "<by the materials>", "\"bedding\"", "Contact law of these joints, one of [joint.NAME]."},
  {"joint_set[].dip_deg", Kind::number, optional, from_to(-360, 360), "", "<exactly one of this and dip with dip_direction>", "-35.0", "[degrees] Angle of the traces against the x axis, counter-clockwise: the apparent dip in the section."},
  {"joint_set[].dip", Kind::number, optional, from_to(0, 90), "", "<exactly one of this and dip_deg>", "40.0", "[degrees] Dip of the planes in space below the horizontal, together with dip_direction and region.azimuth. The traces have the angle -atan(tan(dip) cos(dip_direction - azimuth)) against the x axis, and the joints lie farther apart in the section than across the planes."},
  {"joint_set[].dip_direction", Kind::number, optional, from_to(-360, 360), "", "<required with dip>", "120.0", "[degrees] Direction in which the planes dip, clockwise from north."},
  {"joint_set[].fisher_k", Kind::number, optional, above_to(0, 1e9), "", "<all planes parallel>", "200.0", "Fisher's constant of the scatter of the planes in space, with dip and dip_direction: the pole of each joint is drawn about the mean pole, and its trace in the section taken; planes oblique to the section are met as seldom as they would be in rock."},
  {"joint_set[].dip_scatter", Kind::table, optional, any, "", "", "dip_scatter = {kind = \"fisher\", concentration = 200}", "Scatter of the dip; a joint is turned about its middle."},
  {"joint_set[].dip_scatter.kind", Kind::choice, required, any, "none normal fisher", "", "\"normal\"", "Distribution: normal with deviation_deg, or fisher with concentration (angle between two directions on the sphere, to either side)."},
  {"joint_set[].dip_scatter.deviation_deg", Kind::number, optional, above_to(0, 90), "", "<required with normal>", "5.0", "[degrees] Standard deviation."},
  {"joint_set[].dip_scatter.concentration", Kind::number, optional, above_to(0, 1e9), "", "<required with fisher>", "200.0", "Fisher's constant."},
  {"joint_set[].spacing", Kind::number, optional, above_to(0, 1e9), "", "<exactly one of this and p21>", "2.0", "[m] Mean distance of neighbouring joints, across the dip; with dip and dip_direction that of the planes in space."},
  {"joint_set[].p21", Kind::number, optional, from_to(1e-9, 1e9), "", "<exactly one of this and spacing>", "0.5", "[m/m2] Intensity instead of spacing: mean length of traces per area of the section. The distance of neighbouring joints in it is trace_length/(trace_length + gap)/p21."},
  {"joint_set[].spacing_scatter", Kind::table, optional, any, "", "", "spacing_scatter = {kind = \"exponential\"}", "Scatter of the spacing; values below 1/100 and above 100 times the mean are drawn again, here and for traces and gaps. The mean of those that stay is a little larger: 1 % of exponential ones."},
  {"joint_set[].spacing_scatter.kind", Kind::choice, required, any, "none normal lognormal exponential", "", "\"lognormal\"", "Distribution about the mean; exponential has none but the mean."},
  {"joint_set[].spacing_scatter.deviation", Kind::number, optional, above_to(0, 1e9), "", "<required with normal and lognormal>", "0.5", "[m] Standard deviation."},
  {"joint_set[].trace_length", Kind::number, optional, above_to(0, 1e9), "", "<through-going; that of a power law follows>", "10.0", "[m] Mean length of a joint between two gaps; together with gap."},
  {"joint_set[].trace_scatter", Kind::table, optional, any, "", "", "trace_scatter = {kind = \"exponential\"}", "Scatter of the trace length."},
  {"joint_set[].trace_scatter.kind", Kind::choice, required, any, "none normal lognormal exponential power-law", "", "\"lognormal\"", "As for the spacing; or power-law: density ~ length^-exponent from min to max, instead of trace_length, which follows."},
  {"joint_set[].trace_scatter.deviation", Kind::number, optional, above_to(0, 1e9), "", "<required with normal and lognormal>", "2.0", "[m] Standard deviation."},
  {"joint_set[].trace_scatter.exponent", Kind::number, optional, from_to(0, 20), "", "<required with power-law>", "2.5", "Exponent of the power law."},
  {"joint_set[].trace_scatter.min", Kind::number, optional, from_to(1e-9, 1e9), "", "<required with power-law>", "1.0", "[m] Smallest length."},
  {"joint_set[].trace_scatter.max", Kind::number, optional, from_to(1e-9, 1e9), "", "<required with power-law>", "50.0", "[m] Largest length."},
  {"joint_set[].gap", Kind::number, optional, above_to(0, 1e9), "", "<through-going>", "5.0", "[m] Mean length of intact rock between two joints in line; persistence is trace_length/(trace_length + gap)."},
  {"joint_set[].gap_scatter", Kind::table, optional, any, "", "", "gap_scatter = {kind = \"exponential\"}", "Scatter of the gap."},
  {"joint_set[].gap_scatter.kind", Kind::choice, required, any, "none normal lognormal exponential", "", "\"lognormal\"", "As for the spacing."},
  {"joint_set[].gap_scatter.deviation", Kind::number, optional, above_to(0, 1e9), "", "<required with normal and lognormal>", "1.0", "[m] Standard deviation."},
  {"joint_set[].stagger", Kind::number, optional, from_below(0, 1), "", "<drawn for each line>", "0.5", "Shift of the traces of a line against those of the line before, as a share of trace_length + gap."},
  {"joint_set[].origin", Kind::vector2, optional, from_to(-1e9, 1e9), "", "<[0.0, 0.0]>", "[0.0, 1.0]", "[m] A point on one of the joints."},
  {"joint_set[].seed", Kind::count, optional, from_to(0, 9e15), "", "<0>", "7", "Another seed draws another set with the same statistics."},
  {"joint_set[].within", Kind::polygon, optional, from_to(-1e9, 1e9), "", "<everywhere>", "[[0, 0], [10, 0], [10, 5]]", "[m] Joints end at this polygon; its outline is no joint."},

  {"fault[]", Kind::table_list, optional, any, "", "", "[[fault]]", "Single joints and faults in the region."},
  {"fault[].name", Kind::name, optional, any, "", "<fault and its position, from 0>", "\"f1\"", "Name, for messages and --set."},
  {"fault[].points", Kind::points, required, from_to(-1e9, 1e9), "", "", "[[0, 2], [9, 5]]", "[m] Its line, at least two points."},
  {"fault[].joint", Kind::name, optional, any, "", "<by the materials>", "\"fault\"", "Contact law, one of [joint.NAME]."},

  {"joint_map[]", Kind::table_list, optional, any, "", "", "[[joint_map]]", "Mapped joint traces from a file."},
  {"joint_map[].file", Kind::text, required, any, "", "", "\"traces.csv\"", "Path from the folder of the scene file: CSV with rows trace,x,y (rows of one trace follow each other), or .geojson with LineStrings and MultiLineStrings in m, whose heights are left out, or a .dxf drawing in m, which GDAL's ogr2ogr (Debian package gdal-bin) converts at the start of each command but restart."},
  {"joint_map[].layer", Kind::text, optional, any, "", "<all layers>", "\"J1\"", "Layer of the drawing whose lines are read; a table for each layer gives each its contact law. One without lines is a fault."},
  {"joint_map[].joint", Kind::name, optional, any, "", "<by the materials>", "\"mapped\"", "Contact law, one of [joint.NAME]."},

  {"opening[]", Kind::table_list, optional, any, "", "", "[[opening]]", "Named parts of the region, such as tunnels: blocks end at their outlines."},
  {"opening[].name", Kind::name, optional, any, "", "<opening and its position, from 0>", "\"tunnel\"", "Name of the group of its blocks."},
  {"opening[].shape", Kind::choice, required, any, "circle horseshoe d polygon", "", "\"horseshoe\"", "circle of the width; d: flat floor, upright walls, half circle; horseshoe: flat floor, walls that are arcs of the width about the opposite spring line, half circle; polygon."},
  {"opening[].centre", Kind::vector2, optional, from_to(-1e9, 1e9), "", "<required but with polygon>", "[0.0, 5.0]", "[m] Middle of width and height."},
  {"opening[].width", Kind::number, optional, above_to(0, 1e8), "", "<required but with polygon>", "10.0", "[m] Width at the spring line, or diameter."},
  {"opening[].height", Kind::number, optional, above_to(0, 1e8), "", "<width>", "8.0", "[m] From floor to crown, of d and horseshoe; at least half the width, of a horseshoe at most 1.36 widths."},
  {"opening[].chords", Kind::count, optional, from_to(3, 1000), "", "<24>", "32", "Straight pieces a whole circle is made of; arcs take their share."},
  {"opening[].polygon", Kind::polygon, optional, from_to(-1e9, 1e9), "", "<required with polygon>", "[[0, 0], [4, 0], [4, 3], [0, 3]]", "[m] Outline of the shape polygon."},
  {"opening[].joint", Kind::name, optional, any, "", "<by the materials>", "\"intact\"", "Contact law across the outline, one of [joint.NAME]."},
  {"opening[].excavated", Kind::boolean, optional, any, "", "<false>", "true", "Whether its blocks are left out from the start."},

  {"layer[]", Kind::table_list, optional, any, "", "", "[[layer]]", "Parts of the region of another material; of several at a place the last one counts. Blocks end at their outlines."},
  {"layer[].polygon", Kind::polygon, required, from_to(-1e9, 1e9), "", "", "[[0, 0], [20, 0], [20, 3], [0, 3]]", "[m] Outline, either way round; it may reach out of the region."},
  {"layer[].material", Kind::name, required, any, "", "", "\"clay\"", "One of the materials."},
  {"layer[].joint", Kind::name, optional, any, "", "<by the materials>", "\"contact\"", "Contact law along the outline, one of [joint.NAME]."},

  {"voronoi[]", Kind::table_list, optional, any, "", "", "[[voronoi]]", "Irregular polygons in the region, one about a random point in each cell of a square grid."},
  {"voronoi[].size", Kind::number, required, above_to(0, 1e8), "", "", "0.5", "[m] Side of a grid cell, which is the square root of the mean area."},
  {"voronoi[].irregularity", Kind::number, optional, above_to(0, 1), "", "<1.0>", "0.7", "Share of its cell in which a point may lie."},
  {"voronoi[].seed", Kind::count, optional, from_to(0, 9e15), "", "<0>", "7", "Another seed draws other points."},
  {"voronoi[].joint", Kind::name, optional, any, "", "<by the materials>", "\"grain\"", "Contact law, one of [joint.NAME]."},

  {"bricks[]", Kind::table_list, optional, any, "", "", "[[bricks]]", "Masonry in the region: bed joints and head joints."},
  {"bricks[].block_size", Kind::vector2, required, above_to(0, 1e8), "", "", "[0.4, 0.2]", "[m] Width and height of a brick."},
  {"bricks[].origin", Kind::vector2, optional, from_to(-1e9, 1e9), "", "<[0.0, 0.0]>", "[0.0, 0.0]", "[m] Lower left corner of one brick."},
  {"bricks[].bond", Kind::number, optional, from_below(0, 1), "", "<0.5>", "0.5", "Shift of every second row, in brick widths."},
  {"bricks[].joint", Kind::name, optional, any, "", "<by the materials>", "\"mortar\"", "Contact law, one of [joint.NAME]."},

  {"water", Kind::named_tables, optional, any, "", "", "[water.winter]", "Water in joints and around blocks: below its phreatic line it presses on every edge that it wets, so that the contacts carry the effective forces."},
  {"water.*", Kind::table, optional, any, "", "", "[water.winter]", "One water table."},
  {"water.*.phreatic", Kind::points, required, from_to(-1e9, 1e9), "", "", "[[0, 0], [40, 12]]", "[m] Phreatic line, its points from left to right; level to the left and to the right of it. The pressure is density times gravity times the depth below it."},
  {"water.*.joints", Kind::names, optional, any, "", "<all edges>", "[\"bedding\"]", "Laws of the joints that it wets; others stay dry. Both faces of a joint are wet where the contact at the start has a listed law, whichever block names it; laws by materials and \"default\" count. What faces nothing is wet where the edge itself names a listed law."},
  {"water.*.density", Kind::number, optional, above_to(0, 1e12), "", "1000.0", "1000.0", "[kg/m3] Density."},
  {"water.*.active", Kind::boolean, optional, any, "", "true", "false", "Whether it is there; a stage may set this, as all of [water.NAME]."},

  {"in_situ", Kind::table, optional, any, "", "", "[in_situ]", "Stress that is in the rock before anything happens, compression positive: blocks and contacts begin in equilibrium under it. Edges that touch nothing do not bear it."},
  {"in_situ.vertical_stress", Kind::number, optional, from_to(0, 1e15), "", "<0.0 with level>", "2.6e6", "[Pa] Stress along gravity (along y without gravity): at the level if there is one, such as the load on a surface, else everywhere."},
  {"in_situ.k0", Kind::number, optional, from_to(0, 100), "", "<1.0>", "0.7", "Stress across gravity over the stress along it."},
  {"in_situ.principal_stresses", Kind::vector2, optional, from_to(0, 1e15), "", "<none>", "[4e6, 2e6]", "[Pa] Instead of vertical_stress: two stresses at right angles."},
  {"in_situ.principal_angle_deg", Kind::number, optional, from_to(-360, 360), "", "<0.0>", "30.0", "[degrees] Direction of the first of them against the x axis, counter-clockwise."},
  {"in_situ.level", Kind::number, optional, from_to(-1e9, 1e9), "", "<none: the same stress everywhere>", "100.0", "[m] Height against gravity (y) where these stresses are; below it they grow with the weight of the rock, which they bear. A stress that is the same everywhere bears no weight."},
  {"in_situ.density", Kind::number, optional, above_to(0, 1e12), "", "<that of the materials if they have the same>", "2600.0", "[kg/m3] Density the growth with depth is computed with."},

  {"earthquake", Kind::table, optional, any, "", "", "[earthquake]", "How the ground moves. Whatever is held (fixed blocks and sides, rollers, fixed points) moves with it, and all that is written is motion against it: what is left of a displacement is permanent."},
  {"earthquake.record", Kind::text, optional, any, "", "<none: the ground is at rest>", "\"record.csv\"", "CSV file of the motion, its path from the folder of the scene file: rows of time (s), x and, if the ground moves upwards too, y, linear between rows, with a heading or none. Before the first row and after the last one the velocity stays."},
  {"earthquake.quantity", Kind::choice, optional, any, "velocity acceleration", "\"velocity\"", "\"acceleration\"", "What the record holds, in m/s or m/s2."},
  {"earthquake.scale", Kind::number, optional, from_to(-1e9, 1e9), "", "1.0", "9.81", "Factor of the record's motion."},
  {"earthquake.baseline", Kind::choice, optional, any, "none velocity displacement", "\"none\"", "\"displacement\"", "What is taken away from a record of accelerations: a constant, so that the velocity ends at zero, or a straight line, so that the displacement does too."},
  {"earthquake.start", Kind::number, optional, from_to(0, 1e12), "", "0.0", "2.0", "[s] Time of the first row."},
  {"earthquake.stage", Kind::name, optional, any, "", "<none>", "\"shaking\"", "Stage with which the first row comes, instead of start."},
  {"earthquake.viscous", Kind::words, optional, any, "bottom left right top", "<none>", "[\"bottom\", \"left\", \"right\"]", "Sides of the region that let waves out, from that stage on (from the start without one), by dashpots on the edges that lie on the side at the start. Fixed blocks and rollers beyond them are taken away then, and the forces they held with stay. With the bottom among them the record is the upward wave that comes in there, and the motion written is that of the ground; without it the sides stand in for rock at rest against the base. There is no free field."},
  {"earthquake.p_wave_speed", Kind::number, optional, above_to(0, 1e6), "", "<that of rock like the blocks and joints of the region>", "3000.0", "[m/s] Speed of compression waves in the rock beyond viscous sides. Without it the rock there has, along the side's normal, the mean compliance of the whole blocks of [region] of the same material and of their joints, whatever their directions; where no block is whole, as where slabs go through the region, that of a stack of blocks like the one on the side."},
  {"earthquake.s_wave_speed", Kind::number, optional, above_to(0, 1e6), "", "<that of rock like the blocks and joints of the region>", "1700.0", "[m/s] The same of shear waves."},

  {"output", Kind::table, optional, any, "", "", "[output]", "What is written and when."},
  {"output.interval", Kind::number, optional, above_to(0, 1e12), "", "<duration/100>", "0.02", "[s] Time between frames, a whole number of steps: another one changes an automatic time step a little, and so the last digits of results."},
  {"output.history_interval", Kind::number, optional, above_to(0, 1e12), "", "<interval>", "0.02", "[s] Time between rows of the histories; divides interval or is a multiple of it, and changes the step in the same way."},
  {"output.checkpoint_interval", Kind::number, optional, from_to(0, 1e12), "", "0.0", "0.5", "[s] Simulated time between checkpoints, from which gcpdda restart goes on; rounded to whole steps; 0 for none but that of SIGUSR1."},
  {"output.contacts", Kind::boolean, optional, any, "", "true", "true", "Whether contacts are written beside the frames."},

  {"support", Kind::named_tables, optional, any, "", "", "[support.rockbolt]", "Types of bolts, cables and liners. Stiffness and strength of a bolt are those of one bolt; reports too. Those of a liner are of its material; reports are per metre of tunnel."},
  {"support.*", Kind::table, optional, any, "", "", "[support.rockbolt]", "One type of bolts or liners."},
  {"support.*.kind", Kind::choice, required, any, "anchored grouted liner", "", "\"grouted\"", "anchored: a spring between its head and its anchor, free in between and slack in compression; grouted: a spring along and one across the bolt wherever it crosses a joint; liner: a layer of shotcrete or concrete on a face, a beam between each two neighbouring blocks."},
  {"support.*.axial_stiffness", Kind::number, optional, above_to(0, 1e20), "", "<bolts: exactly one of this and axial_rigidity>", "5e7", "[N/m] Axial stiffness, of the whole bolt if anchored, at one joint if grouted."},
  {"support.*.axial_rigidity", Kind::number, optional, above_to(0, 1e20), "", "<bolts: exactly one of this and axial_stiffness>", "1e8", "[N] Young's modulus times cross section: over the free length of an anchored bolt, or the active length of a grouted one, it is the axial stiffness."},
  {"support.*.axial_yield", Kind::number, optional, above_to(0, 1e20), "", "<none>", "2.5e5", "[N] Axial force at which the bolt yields, and stays."},
  {"support.*.shear_stiffness", Kind::number, optional, above_to(0, 1e20), "", "<no shear>", "2e7", "[N/m] Stiffness across a grouted bolt at one joint."},
  {"support.*.shear_yield", Kind::number, optional, above_to(0, 1e20), "", "<none>", "1e5", "[N] Shear force at which it yields, and stays."},
  {"support.*.rupture_strain", Kind::number, optional, above_to(0, 1), "", "<none>", "0.1", "Elongation of the steel over the free or active length, that of the pre-tension included, at which the bolt breaks."},
  {"support.*.pretension", Kind::number, optional, from_to(0, 1e20), "", "0.0", "1e5", "[N] Tension with which it is put in; joints that close under it take some of it."},
  {"support.*.active_length", Kind::number, optional, above_to(0, 1e6), "", "<required for grouted>", "0.3", "[m] Length of a grouted bolt that stretches where it crosses a joint; about 20 diameters."},
  {"support.*.bond_strength", Kind::number, optional, above_to(0, 1e20), "", "<no slip>", "3e5", "[N/m] Force that a metre of grout bears: the bolt slips where the grout on the shorter side of a joint bears less than axial_yield."},
  {"support.*.plate", Kind::boolean, optional, any, "", "false", "true", "A face plate: the head of a grouted bolt with a bond_strength is not drawn into the rock, so only the grout towards the tip counts. An anchored bolt always has one."},
  {"support.*.spacing", Kind::number, optional, above_to(0, 1e6), "", "1.0", "1.5", "[m] Distance of bolts out of plane, by which stiffness and strength are divided."},

  {"support.*.thickness", Kind::number, optional, above_to(0, 1e6), "", "<required for liners>", "0.1", "[m] Thickness t of a liner."},
  {"support.*.youngs_modulus", Kind::number, optional, above_to(0, 1e20), "", "<required for liners>", "15e9", "[Pa] Young's modulus of a liner's material."},
  {"support.*.poissons_ratio", Kind::number, optional, from_below(0, 0.5), "", "0.2", "0.2", "Its Poisson's ratio."},
  {"support.*.compressive_strength", Kind::number, optional, above_to(0, 1e20), "", "<unlimited>", "25e6", "[Pa] Stress at which a liner yields in compression, by its thrust and by thrust and bending together."},
  {"support.*.tensile_strength", Kind::number, optional, above_to(0, 1e20), "", "<unlimited>", "2e6", "[Pa] Tension of an extreme fibre, of thrust and bending, at which a liner cracks."},
  {"support.*.residual_tensile_strength", Kind::number, optional, from_to(0, 1e20), "", "0.0", "1e6", "[Pa] Tension that a cracked liner bears, by its fibres or mesh; at most tensile_strength."},
  {"support.*.shear_strength", Kind::number, optional, above_to(0, 1e20), "", "<unlimited>", "2e6", "[Pa] Shear stress over the thickness at which a block punches through a liner."},
  {"support.*.adhesion", Kind::number, optional, above_to(0, 1e20), "", "<unlimited>", "0.5e6", "[Pa] Tensile strength of the bond between a liner and the rock. Where the shear force beside a joint, less what thrust presses the liner on, exceeds adhesion times bond_width the liner peels off."},
  {"support.*.bond_width", Kind::number, optional, above_to(0, 1e6), "", "0.03", "0.03", "[m] Width beside a joint over which the bond acts when a block pulls at the liner (Barrett and McCreath 1995)."},

  {"bolt[]", Kind::table_list, optional, any, "", "", "[[bolt]]", "Single bolts and cables."},
  {"bolt[].name", Kind::name, optional, any, "", "<bolt and its position, from 0>", "\"cable\"", "Name, unique among bolts, in history/bolts.csv and for --set."},
  {"bolt[].support", Kind::name, required, any, "", "", "\"rockbolt\"", "Its type, one of [support.NAME]."},
  {"bolt[].from", Kind::vector2, required, from_to(-1e9, 1e9), "", "", "[0.0, 5.0]", "[m] Head, at the face."},
  {"bolt[].to", Kind::vector2, required, from_to(-1e9, 1e9), "", "", "[0.0, 9.0]", "[m] Tip, in the rock."},
  {"bolt[].active", Kind::boolean, optional, any, "", "true", "false", "In place from the start. A bolt is put in where the blocks are then, so a stage sets \"bolt.NAME.active\" = true to put one in, false to take it out."},

  {"bolt_pattern[]", Kind::table_list, optional, any, "", "", "[[bolt_pattern]]", "Bolts of one length that stand at right angles on the outline of an opening, named <pattern>.<n> from 0, counter-clockwise."},
  {"bolt_pattern[].name", Kind::name, optional, any, "", "<bolt_pattern and its position, from 0>", "\"roof\"", "Name of the pattern."},
  {"bolt_pattern[].support", Kind::name, required, any, "", "", "\"rockbolt\"", "Type of its bolts, one of [support.NAME]."},
  {"bolt_pattern[].opening", Kind::name, required, any, "", "", "\"tunnel\"", "Name of the [[opening]] they start from."},
  {"bolt_pattern[].length", Kind::number, required, above_to(0, 1e6), "", "", "4.0", "[m] Length of each bolt."},
  {"bolt_pattern[].from_angle_deg", Kind::number, optional, from_to(-360, 360), "", "0.0", "20.0", "[degrees] Angle of the outline's normal against the x axis, counter-clockwise, where the pattern begins: 0 is the right wall, 90 the crown."},
  {"bolt_pattern[].to_angle_deg", Kind::number, optional, from_to(-360, 720), "", "180.0", "160.0", "[degrees] Where it ends, counter-clockwise from there, within one turn."},
  {"bolt_pattern[].count", Kind::count, optional, from_to(1, 10000), "", "<exactly one of this and spacing>", "9", "Number of bolts, evenly spaced along the outline, half a spacing from the ends of the arc."},
  {"bolt_pattern[].spacing", Kind::number, optional, above_to(0, 1e6), "", "<exactly one of this and count>", "1.5", "[m] Distance of bolts along the outline, up to a whole number of them."},
  {"bolt_pattern[].active", Kind::boolean, optional, any, "", "true", "false", "As of a bolt; a stage sets \"bolt_pattern.NAME.active\"."},

  {"liner[]", Kind::table_list, optional, any, "", "", "[[liner]]", "Layers of shotcrete or concrete on faces of the rock."},
  {"liner[].name", Kind::name, optional, any, "", "<liner and its position, from 0>", "\"shotcrete\"", "Name, unique among liners, in history/liners.csv and for --set."},
  {"liner[].support", Kind::name, required, any, "", "", "\"shotcrete\"", "Its type, one of [support.NAME] of kind liner."},
  {"liner[].opening", Kind::name, optional, any, "", "<exactly one of this and points>", "\"tunnel\"", "Name of the [[opening]] whose outline it lies on, all around or on an arc."},
  {"liner[].from_angle_deg", Kind::number, optional, from_to(-360, 360), "", "<all around>", "0.0", "[degrees] Angle of the outline's normal against the x axis, counter-clockwise, where the liner begins: 0 is the right wall, 90 the crown."},
  {"liner[].to_angle_deg", Kind::number, optional, from_to(-360, 720), "", "<all around>", "180.0", "[degrees] Where it ends, counter-clockwise from there, within one turn."},
  {"liner[].points", Kind::points, optional, from_to(-1e9, 1e9), "", "<exactly one of this and opening>", "[[0, 0], [5, 8], [12, 8]]", "[m] Line along a face of the rock; the blocks lie on one side of it."},
  {"liner[].active", Kind::boolean, optional, any, "", "true", "false", "In place from the start. A liner is put in without stress where the blocks are then, so a stage sets \"liner.NAME.active\" = true to spray it, false to take it away."},

  {"stage[]", Kind::table_list, optional, any, "", "", "[[stage]]", "What happens one after the other, in the order of the file; without stages the run is one of run.duration. Every stage that takes steps ends in a checkpoint and a verdict: settled, failed or undecided."},
  {"stage[].name", Kind::name, optional, any, "", "<stage and its position, from 0>", "\"gravity\"", "Name, unique among the stages."},
  {"stage[].kind", Kind::choice, required, any, "run settle excavate change", "", "\"settle\"", "run: dynamics for a duration, or until a verdict and at most for a limit; settle: damped motion until rest, or failure; excavate: blocks are taken away; change: only set. Excavate and change take no time."},
  {"stage[].duration", Kind::number, optional, above_to(0, 1e12), "", "<run: exactly one of this and limit>", "2.0", "[s] How long a run lasts."},
  {"stage[].limit", Kind::number, optional, above_to(0, 1e12), "", "<required for settle>", "10.0", "[s] Longest time until a verdict; a stage that reaches it undecided ends the run with exit code 7, one that has failed ends it with 0. Where the static solver hands over, damped motion has all of it."},
  {"stage[].tolerance", Kind::number, optional, above_to(0, 0.1), "", "1e-5", "1e-5", "Largest unbalanced force over the largest force in the model at which blocks count as settled; of a block with weight, at most 300 times this of the largest force on the block itself."},
  {"stage[].failure_motion", Kind::number, optional, above_to(0, 1e6), "", "0.5", "0.5", "A block that has moved by this share of its size (the root of its area) in the stage, farther than the pile may sag as its joints close, has failed unless the blocks are about to stop."},
  {"stage[].local_damping", Kind::number, optional, from_below(0, 1), "", "<settle: 0.8; run: run.local_damping>", "0.8", "Share of the net force that is taken away against the motion in this stage."},
  {"stage[].kinetic_damping", Kind::boolean, optional, any, "", "false", "true", "Whether a settle stage sets all velocities to zero whenever the kinetic energy has passed a peak; local_damping is then 0 unless given."},
  {"stage[].mass_scaling", Kind::boolean, optional, any, "", "false", "true", "Whether a settle stage makes blocks heavier against acceleration (not against gravity) until all swing as slowly as the slowest one: the step is as long as for that block, for models with a few small blocks. Where joints slip on the way to rest they end elsewhere, because blocks fall at different rates: let gravity rise slowly (run.gravity_ramp)."},
  {"stage[].solver", Kind::choice, optional, any, "dynamic static", "\"static\", or \"dynamic\" of a stage with local_damping, kinetic_damping or mass_scaling", "\"dynamic\"", "How a settle stage looks for equilibrium. static: by an iteration in which the stiffness of contacts stands for the masses and the load comes in increments; it takes some hundred evaluations of the contacts where damped motion takes thousands of steps. Where it stalls the stage goes on as a dynamic one, with a message, and so do stages with velocities that are given or viscous sides; beside solver = \"static\" the keys local_damping, kinetic_damping and mass_scaling say how that motion is damped, and nothing else. dynamic: by damped motion in time."},
  {"stage[].increments", Kind::count, optional, from_to(1, 1e6), "", "50", "200", "Number of parts, one an evaluation of the contacts, in which the static solver lets in the load of the stage. More parts follow the path of slow loading more closely, where joints slip on the way to rest; a stage with solver = \"dynamic\" ignores it."},
  {"stage[].blocks", Kind::names, optional, any, "", "<none>", "[\"wall.0.3\", \"wall.0.4\"]", "Names of the blocks to excavate, also of generated ones or those of the block file."},
  {"stage[].region", Kind::polygon, optional, from_to(-1e9, 1e9), "", "<none>", "[[0, 0], [4, 0], [4, 3], [0, 3]]", "[m] Polygon; blocks whose centroid lies in it when the stage begins are excavated, fixed ones too."},
  {"stage[].openings", Kind::names, optional, any, "", "<none>", "[\"tunnel\"]", "Names of [[opening]] tables whose blocks to excavate."},
  {"stage[].relax", Kind::number, optional, from_to(0, 1e12), "", "0.0", "0.5", "[s] Time over which the forces of excavated blocks, and of bolts and liners on them, on those that stay fall linearly to zero; 0: at once."},
  {"stage[].set", Kind::assignments, optional, any, "", "<none>", "{ \"joint.default.friction_angle_deg\" = 25.0 }", "Values of the scene that change when the stage begins (not the first one, which starts from the scene as it is written), by path as with --set: keys of [run] that can change (gravity, time_step, safety, contact_damping, rayleigh, local_damping, elasticity, potential), any value of a [joint.NAME], [material.NAME], [water.NAME] or (but its kind) [support.NAME], block.NAME.fixed, block.NAME.load, bolt.NAME.active, bolt_pattern.NAME.active, liner.NAME.active, and, for the stress on sides of the region, in_situ.KEY (or in_situ as a whole) and region.stress."},
  {"stage[].ramp", Kind::number, optional, from_to(0, 1e12), "", "0.0", "0.5", "[s] Time over which the loads of blocks and the stress on sides of the region go smoothly from what they were to what 'set' says, through the stages that follow if need be; no verdict falls before that time is over. Everything else changes at once."},

  {"fos", Kind::table, optional, any, "", "", "[fos]", "How gcpdda fos looks for the factor of safety; other commands ignore it."},
  {"fos.families", Kind::names, optional, any, "", "<all>", "[\"bedding\", \"default\"]", "Names of the [joint.NAME] laws whose friction (its tangent), cohesion and tension are divided by the factor, peak and residual ones."},
  {"fos.from", Kind::number, optional, above_to(0, 1e6), "", "0.5", "0.8", "Below it is not searched. A search begins with the strengths of the settled state (1) and comes here where the blocks do not stay at rest with them."},
  {"fos.to", Kind::number, optional, above_to(0, 1e6), "", "4.0", "2.5", "Factor at which they are expected to fail; above it is not searched."},
  {"fos.tolerance", Kind::number, optional, above_to(0, 1), "", "0.01", "0.005", "Width of the bracket at which the search ends, as a share of its lower end."},
  {"fos.limit", Kind::number, optional, above_to(0, 1e12), "", "<that of the last settle stage>", "5.0", "[s] Simulated time of a trial with local damping; one that reaches it without a verdict goes on without (patience)."},
  {"fos.patience", Kind::count, optional, from_to(0, 1e6), "", "8", "0", "How many times limit a trial without a verdict goes on without local damping, which acts as drag on blocks that creep. It is then judged by windows of its motion as well: it fails where its motion goes on at an undiminished rate while the unbalanced ratio stays. 0: such a trial is undecided at its limit."},
  {"fos.failure_motion", Kind::number, optional, above_to(0, 1e6), "", "0.1", "0.1", "A block that has moved by this share of its size (the root of its area) in a trial, farther than the pile may sag as its joints close, has failed unless the blocks are about to stop."},
  {"fos.largest_motion", Kind::number, optional, above_to(0, 1e6), "", "<none: blocks that find hold have not failed>", "0.02", "A trial fails, too, where its blocks come to rest only after one of them has moved by this share of its size (the root of its area). With ignore_area it takes blocks of this area together, with region blocks that begin there."},
  {"fos.local_damping", Kind::number, optional, from_below(0, 1), "", "0.3", "0.8", "Share of the net force that is taken away against the motion in a trial. With 0 blocks that are weakened swing beyond their new balance, and the factor comes out lower."},
  {"fos.ignore_area", Kind::number, optional, from_to(0, 1e18), "", "0.0", "5.0", "[m2] What fails and is smaller together is reported and is no failure of the slope: a trial fails once blocks of this area have moved by failure_motion of their size and go on. Smaller falls are left out wherever they are by then. The search then brackets two factors, that of the first block that fails and that of the first mechanism of this size."},
  {"fos.region", Kind::polygon, optional, from_to(-1e9, 1e9), "", "<all blocks>", "[[0, 0], [40, 0], [40, 30], [0, 30]]", "[m] Polygon; only failure of blocks whose centroid lies in it when a trial begins is failure of the slope. The search then brackets two factors, as with ignore_area."},

  {"ensemble", Kind::table, optional, any, "", "", "[ensemble]", "What the members of gcpdda ensemble differ in and what is found out of each; other commands ignore it. A member draws the same whatever the number of members, ranks and calls."},
  {"ensemble.count", Kind::count, required, from_to(1, 1e6), "", "", "100", "Number of members; a larger one adds members to those that are there."},
  {"ensemble.seed", Kind::count, optional, from_to(0, 9e15), "", "0", "7", "Another seed draws other members."},
  {"ensemble.measure", Kind::choice, optional, any, "verdict factor", "\"factor\"", "\"verdict\"", "verdict: whether each stands, by one run; factor: the factor of safety of each, by a search as [fos] says."},
  {"ensemble.ranks", Kind::count, optional, from_to(1, 1e6), "", "<as few as keep all busy>", "4", "Ranks that work on a member together; for members too large for the memory or the patience of one."},
  {"ensemble.keep", Kind::boolean, optional, any, "", "false", "true", "Whether the result folders of the members stay."},
  {"ensemble.largest_displacement", Kind::number, optional, above_to(0, 1e9), "", "<none: blocks hold wherever they come to rest>", "0.15", "[m] Where the ground shakes: a member fails, too, one of whose blocks comes to rest farther than this from where the shaking found it. Belongs to measure = \"verdict\"."},
  {"ensemble.vary[]", Kind::table_list, required, any, "", "", "[[ensemble.vary]]", "Values of the scene that each member draws."},
  {"ensemble.vary[].key", Kind::name, required, any, "", "", "\"joint.bedding.friction_angle_deg\"", "Path of the value, as with --set; no stage may set it."},
  {"ensemble.vary[].distribution", Kind::choice, required, any, "normal lognormal uniform triangular seed", "", "\"normal\"", "normal and lognormal with mean and deviation, where they are given cut off at min and max; uniform from min to max; triangular with its peak at mode; seed: a whole number for the seed of a joint set, so that each member has other joints."},
  {"ensemble.vary[].mean", Kind::number, optional, from_to(-1e20, 1e20), "", "<required with normal and lognormal>", "35.0", "Mean before it is cut off, in the unit of the value."},
  {"ensemble.vary[].deviation", Kind::number, optional, above_to(0, 1e20), "", "<required with normal and lognormal>", "2.0", "Standard deviation before it is cut off."},
  {"ensemble.vary[].min", Kind::number, optional, from_to(-1e20, 1e20), "", "<none; required with uniform and triangular>", "25.0", "Smallest value."},
  {"ensemble.vary[].max", Kind::number, optional, from_to(-1e20, 1e20), "", "<none; required with uniform and triangular>", "45.0", "Largest value."},
  {"ensemble.vary[].mode", Kind::number, optional, from_to(-1e20, 1e20), "", "<required with triangular>", "36.0", "The most frequent value, between min and max."},
  {"ensemble.correlation[]", Kind::table_list, optional, any, "", "", "[[ensemble.correlation]]", "Pairs of values that do not vary independently, such as cohesion and friction angle."},
  {"ensemble.correlation[].keys", Kind::pair_of_names, required, any, "", "", "[\"joint.bedding.friction_angle_deg\", \"joint.bedding.cohesion\"]", "Two keys that vary."},
  {"ensemble.correlation[].coefficient", Kind::number, required, between(-1, 1), "", "", "-0.5", "Correlation of the normal variables behind the two (Gaussian copula): that of two normal values themselves."},

  {"monitor[]", Kind::table_list, optional, any, "", "", "[[monitor]]", "Blocks, points and profiles whose history is written to history/<name>.csv: a block alone, a point with its name and, if wished, the block it follows, or points along a line with their name."},
  {"monitor[].block", Kind::name, optional, any, "", "<required without point or along>", "\"slider\"", "Name of the block, also of a generated one or one of the block file. Beside name and point it is the block that the point follows, which must hold it."},
  {"monitor[].name", Kind::name, optional, any, "", "<required with point or along>", "\"roof\"", "Name of the monitored point or profile."},
  {"monitor[].point", Kind::vector2, optional, from_to(-1e9, 1e9), "", "<required without block or along>", "[0.0, 1.0]", "[m] Point at the start; it follows the block that holds it. Where several blocks hold it, at a shared edge or vertex, it follows a mobile one, of several the first in the order of the scene, unless block names another."},
  {"monitor[].along", Kind::points, optional, from_to(-1e9, 1e9), "", "<none>", "[[0.0, 2.0], [8.0, 2.0]]", "[m] Both ends of a profile at the start: displacement, velocity and stress at points along the line, each of which follows the block that holds it, as a point does. Points in no block have no rows."},
  {"monitor[].points", Kind::count, optional, from_to(2, 10000), "", "<21>", "41", "Number of points of a profile, both ends among them, evenly spaced."},
};
// clang-format on

} // namespace

std::span<const Key> scene_keys() {
  static const std::vector<Key> keys = [] {
    std::vector<Key> all(std::begin(keys_before_joints), std::end(keys_before_joints));
    for (const JointParameter &parameter : joint_parameters()) {
      all.push_back(parameter.key);
    }
    all.insert(all.end(), std::begin(keys_after_joints), std::end(keys_after_joints));
    return all;
  }();
  return keys;
}

std::string_view parent_of(const Key &key) {
  const std::size_t dot = key.path.rfind('.');
  return dot == std::string_view::npos ? std::string_view() : key.path.substr(0, dot);
}

std::string_view name_of(const Key &key) {
  const std::size_t dot = key.path.rfind('.');
  std::string_view name = dot == std::string_view::npos ? key.path : key.path.substr(dot + 1);
  if (name.ends_with("[]")) {
    name.remove_suffix(2);
  }
  return name;
}

const Key *find_key(std::string_view parent, std::string_view name) {
  for (const Key &key : scene_keys()) {
    if (parent_of(key) == parent && (name_of(key) == name || name_of(key) == "*")) {
      return &key;
    }
  }
  return nullptr;
}

std::vector<std::string> names_below(std::string_view parent) {
  std::vector<std::string> names;
  for (const Key &key : scene_keys()) {
    if (parent_of(key) == parent) {
      names.emplace_back(name_of(key));
    }
  }
  return names;
}

std::string header_of(std::string_view parent) {
  std::string path(parent);
  for (std::size_t at = path.find("[]"); at != std::string::npos; at = path.find("[]")) {
    path.erase(at, 2);
  }
  return parent.ends_with("[]") ? fmt::format("[[{}]]", path) : fmt::format("[{}]", path);
}

std::vector<std::string> words_of(std::string_view choices) {
  std::istringstream stream{std::string(choices)};
  std::vector<std::string> words;
  for (std::string word; stream >> word;) {
    words.push_back(word);
  }
  return words;
}

std::string describe(const Range &range) {
  const std::string low = fmt::format("{} {:g}", range.low_open ? "above" : "at least", range.low);
  return fmt::format("{} and {} {:g}", low, range.high_open ? "below" : "at most", range.high);
}

std::string_view prefix_of_unnamed(std::string_view list) {
  return list == "block" ? "b" : list;
}

bool is_name(std::string_view text) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '.' || c == '-';
  };
  return !text.empty() && text.size() <= longest_name && std::all_of(text.begin(), text.end(), allowed);
}

} // namespace gcpdda::scene_text
