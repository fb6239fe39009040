#include "model/block_system.hpp"

#include "geometry/polygon.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace gcpdda {

namespace {

/// Entries of all lists for one more row: none, until they are appended.
void close_lists(BlockSystem &system) {
  std::apply(
      [&](auto... list) {
        ((system.*std::get<0>(list))
             .push_back(static_cast<std::uint32_t>((system.*std::get<1>(list)).size())),
         ...);
      },
      BlockSystem::lists());
}

/// Every field with one entry a row gets a default one.
void open_row(BlockSystem &system) {
  std::apply([&](auto... field) { ((system.*field).emplace_back(), ...); }, BlockSystem::row_fields());
}

void append_shape(BlockSystem &system, std::span<const Vec2> vertices, Vec2 centroid) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec2 edge = vertices[(i + 1) % vertices.size()] - vertices[i];
    const double length = norm(edge);
    system.reference_vertex.push_back(vertices[i] - centroid);
    system.reference_normal.push_back({edge.y / length, -edge.x / length});
  }
}

void append_deformation(BlockSystem &system, const Moments &moments, const Material &material, double spin,
                        bool plane_strain) {
  Deformation d;
  d.second_moment = material.density * Mat2{moments.xx, moments.xy, moments.xy, moments.yy};
  d.rate = {0.0, -spin, spin, 0.0};
  set_elasticity(d, moments.area, material, plane_strain);
  system.deformation.push_back(d);
}

void append_attachments(BlockSystem &system, const SceneBlock &block, Vec2 centroid) {
  for (const PointLoad &load : block.loads) {
    system.load.push_back({load.point - centroid, load.force, load.course});
  }
  for (const Vec2 point : block.fixed_points) {
    system.anchor.push_back({point - centroid, 0.0, {}});
  }
  if (!block.loads.empty() || !block.fixed_points.empty() || block.driven) {
    system.applied.emplace_back();
  }
}

/// Owned rows of which needs(row) holds have an entry of a list, with what they had in it; others have none.
template <class Entry, class Needs>
void list_rows(const BlockSystem &system, Needs &&needs, RowOffsets &begin, std::vector<Entry> &list) {
  const std::vector<Entry> before = std::exchange(list, {});
  const RowOffsets begin_before = std::exchange(begin, {});
  for (std::size_t row = 0; row < system.num_rows(); ++row) {
    if (row < system.num_owned && needs(row)) {
      const std::uint32_t first = begin_before[row];
      list.push_back(first < begin_before[row + 1] ? before[first] : Entry{});
    }
    begin.push_back(static_cast<std::uint32_t>(list.size()));
  }
}

} // namespace

// [std] plane strain or plane stress, times the area.
void set_elasticity(Deformation &deformation, double area, const Material &material, bool plane_strain) {
  const double e = material.youngs_modulus;
  const double nu = material.poissons_ratio;
  const double factor = area * (plane_strain ? e / ((1.0 + nu) * (1.0 - 2.0 * nu)) : e / (1.0 - nu * nu));
  deformation.stiffness_direct = factor * (plane_strain ? 1.0 - nu : 1.0);
  deformation.stiffness_cross = factor * nu;
  deformation.stiffness_shear = 0.5 * area * e / (1.0 + nu);
}

void append_block(BlockSystem &system, BlockId id, const SceneBlock &block, const Material &material,
                  BlockKind kind, bool plane_strain) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const Moments moments = polygon_moments(block.vertices);
  open_row(system);
  BlockProperties &p = system.properties.back();
  p.id = id;
  p.material = block.material;
  p.kind = kind;
  p.area = moments.area;
  const bool heavy = kind == BlockKind::fixed || block.driven;
  p.mass = heavy ? infinite : material.density * moments.area;
  p.inertia = heavy ? infinite : material.density * (moments.xx + moments.yy);
  p.width = narrowest_width(block.vertices);
  p.is_convex = is_convex(block.vertices);
  p.centroid = moments.centroid;
  for (const Vec2 v : block.vertices) {
    p.radius = std::max(p.radius, norm(v - moments.centroid));
  }
  if (kind != BlockKind::fixed) {
    system.velocity.back() = {{block.velocity[0], block.velocity[1]}, block.velocity[2]};
    append_attachments(system, block, moments.centroid);
  }
  if (kind == BlockKind::deformable) {
    append_deformation(system, moments, material, system.velocity.back().r, plane_strain);
    system.velocity.back().r = 0.0;
  }
  append_shape(system, block.vertices, moments.centroid);
  p.has_edge_joints = std::any_of(block.edge_joint.begin(), block.edge_joint.end(),
                                  [](std::int32_t joint) { return joint >= 0; });
  append_edge_joints(system, p.has_edge_joints ? block.edge_joint : std::span<const std::int32_t>());
  close_lists(system);
}

void append_block(BlockSystem &system, BlockId id, const SceneBlock &block, const Material &material) {
  append_block(system, id, block, material, block.fixed ? BlockKind::fixed : BlockKind::rigid);
}

void part_sides(BlockSystem &system, const JointLaws &joints) {
  const std::size_t row = system.num_rows() - 1;
  const auto normal = system.of_row(system.reference_normal, row);
  const std::span<const std::int32_t> joint = system.edge_joints(row);
  const bool has_bonds =
      std::any_of(joints.laws.begin(), joints.laws.end(), [](const JointLaw &law) { return law.has_bonds; });
  BlockProperties &block = system.properties[row];
  for (std::size_t e = 0; e < normal.size(); ++e) {
    const std::size_t next = e + 1 == normal.size() ? 0 : e + 1;
    const bool changes = has_bonds || (!joint.empty() && joint[e] != joint[next]);
    block.has_parted_sides = block.has_parted_sides || (changes && are_in_one_side(normal[e], normal[next]));
  }
  block.is_convex = block.is_convex && !block.has_parted_sides;
}

void append_edge_joints(BlockSystem &system, std::span<const std::int32_t> joints) {
  if (joints.empty() && system.edge_joint.empty()) {
    return;
  }
  system.edge_joint.resize(system.reference_vertex.size() - joints.size(), -1);
  system.edge_joint.insert(system.edge_joint.end(), joints.begin(), joints.end());
}

void reserve_rows(BlockSystem &system, std::size_t rows, std::size_t vertices) {
  std::apply([&](auto... field) { ((system.*field).reserve(rows), ...); }, BlockSystem::row_fields());
  std::apply([&](auto... list) { ((system.*std::get<0>(list)).reserve(rows + 1), ...); },
             BlockSystem::lists());
  system.reference_vertex.reserve(vertices);
  system.reference_normal.reserve(vertices);
}

namespace {

/// Joints of edges as append_edge_joints() leaves them.
std::vector<std::int32_t> edge_joints_of_runs(const BlockSystem &system, const BlockSystem &joining,
                                              std::span<const RowRun> runs) {
  std::vector<std::int32_t> taken;
  if (system.edge_joint.empty() && joining.edge_joint.empty()) {
    return taken;
  }
  for (const RowRun &run : runs) {
    const BlockSystem &from = run.joins ? joining : system;
    for (std::size_t k = from.vertex_begin[run.first]; k < from.vertex_begin[run.last]; ++k) {
      taken.push_back(from.edge_joint.empty() ? -1 : from.edge_joint[k]);
    }
  }
  return taken;
}

} // namespace

void take_rows(BlockSystem &system, const BlockSystem &joining, std::span<const RowRun> runs,
               std::size_t spare) {
  std::vector<std::int32_t> edge_joint = edge_joints_of_runs(system, joining, runs);
  const auto take_field = [&](auto field, const auto &place_of, std::size_t room) {
    auto &old = system.*field;
    std::decay_t<decltype(old)> taken;
    taken.reserve(room);
    for (const RowRun &run : runs) {
      const auto begin = (run.joins ? joining.*field : old).begin();
      taken.insert(taken.end(), begin + place_of(run, run.first), begin + place_of(run, run.last));
    }
    old = std::move(taken);
  };
  std::size_t num_rows = 0;
  for (const RowRun &run : runs) {
    num_rows += run.last - run.first;
  }
  const auto row_itself = [](const RowRun &, std::size_t row) { return static_cast<std::ptrdiff_t>(row); };
  std::apply([&](auto... field) { (take_field(field, row_itself, num_rows + spare), ...); },
             BlockSystem::row_fields());
  const auto take_list = [&](auto begins, auto... fields) {
    const auto begin_of = [&](const RowRun &run, std::size_t row) {
      return static_cast<std::ptrdiff_t>((run.joins ? joining.*begins : system.*begins)[row]);
    };
    auto offsets = BlockSystem{}.*begins; // of no rows
    offsets.reserve(num_rows + spare + 1);
    std::size_t length = 0;
    for (const RowRun &run : runs) {
      for (std::size_t row = run.first; row < run.last; ++row) {
        length += static_cast<std::size_t>(begin_of(run, row + 1) - begin_of(run, row));
        offsets.push_back(static_cast<std::uint32_t>(length));
      }
    }
    const std::size_t room = num_rows == 0 ? 0 : length + length * spare / num_rows;
    (take_field(fields, begin_of, room), ...);
    system.*begins = std::move(offsets);
  };
  std::apply([&](auto... list) { (std::apply(take_list, list), ...); }, BlockSystem::lists());
  system.edge_joint = std::move(edge_joint);
}

void append_row(BlockSystem &to, const BlockSystem &from, std::size_t row) {
  append_rows(to, from, row, row + 1);
}

void append_rows(BlockSystem &to, const BlockSystem &from, std::size_t first, std::size_t last) {
  const auto append = [](auto &to_field, const auto &from_field, std::size_t begin, std::size_t end) {
    to_field.insert(to_field.end(), from_field.begin() + static_cast<std::ptrdiff_t>(begin),
                    from_field.begin() + static_cast<std::ptrdiff_t>(end));
  };
  std::apply([&](auto... field) { (append(to.*field, from.*field, first, last), ...); },
             BlockSystem::row_fields());
  const auto append_lists = [&](auto begins, auto... fields) {
    const std::uint32_t begin = (from.*begins)[first];
    const std::uint32_t already = (to.*begins).back();
    (append(to.*fields, from.*fields, begin, (from.*begins)[last]), ...);
    for (std::size_t row = first; row < last; ++row) {
      (to.*begins).push_back(already + (from.*begins)[row + 1] - begin);
    }
  };
  std::apply([&](auto... list) { (std::apply(append_lists, list), ...); }, BlockSystem::lists());
  const bool has_edge_joints = std::any_of(from.properties.begin() + static_cast<std::ptrdiff_t>(first),
                                           from.properties.begin() + static_cast<std::ptrdiff_t>(last),
                                           [](const BlockProperties &p) { return p.has_edge_joints; });
  const std::span<const std::int32_t> joints(from.edge_joint);
  append_edge_joints(to, has_edge_joints ? joints.subspan(from.vertex_begin[first],
                                                          from.vertex_begin[last] - from.vertex_begin[first])
                                         : joints.first(0));
}

std::span<BlockMark> mark_rows(BlockSystem &system) {
  if (system.mark_begin[system.num_owned] != system.num_owned) {
    list_rows(
        system, [](std::size_t) { return true; }, system.mark_begin, system.mark);
  }
  return {system.mark.data(), system.num_owned};
}

std::span<Vec2> unshaken_rows(BlockSystem &system) {
  if (system.unshaken_begin[system.num_owned] != system.num_owned) {
    list_rows(
        system, [](std::size_t) { return true; }, system.unshaken_begin, system.unshaken);
  }
  return {system.unshaken.data(), system.num_owned};
}

std::span<PseudoMotion> pseudo_rows(BlockSystem &system) {
  if (system.pseudo_begin[system.num_owned] != system.num_owned) {
    list_rows(
        system, [](std::size_t) { return true; }, system.pseudo_begin, system.pseudo);
  }
  return {system.pseudo.data(), system.num_owned};
}

void drop_pseudo_rows(BlockSystem &system) {
  list_rows(
      system, [](std::size_t) { return false; }, system.pseudo_begin, system.pseudo);
}

void list_applied(BlockSystem &system, bool all) {
  const auto has_any = [](const RowOffsets &begin, std::size_t row) { return begin[row] < begin[row + 1]; };
  const auto needs = [&](std::size_t row) {
    return all || has_any(system.load_begin, row) || has_any(system.anchor_begin, row) ||
           has_any(system.dashpot_begin, row) || system.properties[row].keeps_its_velocity();
  };
  list_rows(system, needs, system.applied_begin, system.applied);
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    if (system.is_deformable(row) && system.applied_to(row) == nullptr) {
      system.deformation_of(row).load_force = {};
      system.deformation_of(row).anchor_force = {};
    }
  }
}

void set_trial(BlockSystem &system, std::size_t row, const TrialConfiguration &trial) {
  BlockMotion &motion = system.motion[row];
  motion.set_increment(trial.motion - system.trial[row]);
  system.trial[row] = trial.motion;
  if (system.is_deformable(row)) {
    Deformation &d = system.deformation_of(row);
    const Mat2 turn = (trial.gradient - d.trial) * inverse(trial.gradient);
    d.trial = trial.gradient;
    motion.turn = {Vec2{turn.xx, turn.xy}, Vec2{turn.yx, turn.yy}};
  }
}

void set_to_rest(BlockSystem &system, std::size_t row) {
  system.velocity[row] = {};
  system.acceleration[row] = {};
  if (system.is_deformable(row)) {
    system.deformation_of(row).rate = {};
    system.deformation_of(row).acceleration = {};
  }
}

bool is_still(const BlockSystem &system, std::size_t row) {
  const BlockMotion &motion = system.motion[row];
  if (motion.increment() != RigidDof{} || system.velocity[row] != RigidDof{}) {
    return false;
  }
  return !system.is_deformable(row) ||
         (motion.turn == std::array<Vec2, 2>{} && system.deformation_of(row).rate == Mat2{});
}

void forget_increments(BlockSystem &system) {
  for (std::size_t row = 0; row < system.num_rows(); ++row) {
    system.motion[row].set_increment({});
    if (system.is_deformable(row)) {
      system.motion[row].turn = {};
    }
  }
}

void keep_rows(BlockSystem &system, std::size_t count) {
  std::apply([&](auto... field) { ((system.*field).resize(count), ...); }, BlockSystem::row_fields());
  const auto keep_list = [&](auto begins, auto... fields) {
    (system.*begins).resize(count + 1);
    ((system.*fields).resize((system.*begins).back()), ...);
  };
  std::apply([&](auto... list) { (std::apply(keep_list, list), ...); }, BlockSystem::lists());
  if (!system.edge_joint.empty()) {
    system.edge_joint.resize(system.reference_vertex.size());
  }
}

namespace {

/// A Vec2 in one register.
using Packed = double __attribute__((vector_size(2 * sizeof(double))));
Packed packed(const Vec2 &a) {
  return Packed{a.x, a.y};
}
Vec2 unpacked(const Packed &a) {
  return {a[0], a[1]};
}

void pose_rigid(BlockSystem &system, std::size_t row) {
  const Packed centre = packed(system.motion[row].centroid);
  const Rotation turn = Rotation::of(system.trial[row].r);
  const auto turned = [&](const Vec2 &a) { return turn.c * packed(a) + turn.s * Packed{-a.y, a.x}; };
  const Aabb none;
  Packed low = packed(none.low);
  Packed high = packed(none.high);
  const std::size_t begin = system.vertex_begin[row];
  for (std::size_t k = begin; k < system.vertex_begin[row + 1]; ++k) {
    const Packed vertex = centre + turned(system.reference_vertex[k]);
    if (!system.deformed_edge.empty()) {
      system.vertex[k] = unpacked(vertex);
      system.deformed_edge[k] = {unpacked(turned(system.reference_normal[k])),
                                 reference_length(system, row, k - begin), 1.0};
    }
    low = vertex < low ? vertex : low;
    high = high < vertex ? vertex : high;
  }
  system.motion[row].turn[1] = {turn.c, turn.s};
  system.motion[row].box = {unpacked(low), unpacked(high)};
}

void pose_deformable(BlockSystem &system, std::size_t row) {
  const Vec2 centre = system.motion[row].centroid;
  const Mat2 &gradient = system.deformation_of(row).trial;
  const Mat2 inverted = inverse(gradient);
  const Mat2 of_slopes = determinant(inverted) * transposed(inverted);
  system.trial_inverse[system.deformation_begin[row]] = inverted;
  Aabb box;
  const std::size_t begin = system.vertex_begin[row];
  const std::size_t end = system.vertex_begin[row + 1];
  for (std::size_t k = begin; k < end; ++k) {
    const std::size_t next = k + 1 == end ? begin : k + 1;
    const Vec2 edge = gradient(system.reference_vertex[next] - system.reference_vertex[k]);
    system.vertex[k] = centre + gradient(system.reference_vertex[k]);
    const Vec2 slope = of_slopes(system.reference_normal[k]);
    const double unit = 1.0 / norm(slope);
    system.deformed_edge[k] = {slope, dot(edge, perp(unit * slope)), unit};
    box.include(system.vertex[k]);
  }
  system.motion[row].box = box;
}

} // namespace

void pose(BlockSystem &system, std::size_t first, std::size_t last) {
  system.motion.resize(system.num_rows());
  system.trial_inverse.resize(system.deformation.size());
  system.vertex.resize(system.deformation.empty() ? 0 : system.reference_vertex.size());
  system.deformed_edge.resize(system.vertex.size());
  for (std::size_t row = first; row < last; ++row) {
    system.motion[row].centroid = system.properties[row].centroid + system.trial[row].u;
    if (system.is_deformable(row)) {
      pose_deformable(system, row);
    } else {
      pose_rigid(system, row);
    }
  }
}

void TrialOutline::find(const BlockSystem &system, std::size_t row) {
  vertex.clear();
  normal.clear();
  length.clear();
  const std::size_t begin = system.vertex_begin[row];
  const bool is_deformable = system.is_deformable(row);
  const BlockMotion &motion = system.motion[row];
  for (std::size_t k = begin; k < system.vertex_begin[row + 1]; ++k) {
    if (is_deformable) {
      const DeformedEdge &edge = system.deformed_edge[k];
      vertex.push_back(system.vertex[k]);
      normal.push_back(edge.unit * edge.slope);
      length.push_back(edge.length);
    } else {
      const Rotation turn = motion.rotation();
      vertex.push_back(motion.centroid + turn(system.reference_vertex[k]));
      normal.push_back(turn(system.reference_normal[k]));
      length.push_back(reference_length(system, row, k - begin));
    }
  }
}

double reference_length(const BlockSystem &system, std::size_t row, std::size_t k) {
  const std::span<const Vec2> vertex = system.of_row(system.reference_vertex, row);
  const Vec2 edge = vertex[k + 1 == vertex.size() ? 0 : k + 1] - vertex[k];
  return dot(edge, perp(system.of_row(system.reference_normal, row)[k]));
}

void append_current_vertices(const BlockSystem &system, std::size_t row, std::vector<Vec2> &vertices) {
  if (system.is_deformable(row)) {
    const Mat2 &gradient = system.deformation_of(row).gradient;
    for (const Vec2 x : system.of_row(system.reference_vertex, row)) {
      vertices.push_back(system.centroid(row) + gradient(x));
    }
    return;
  }
  const Rotation turn = Rotation::of(system.displacement[row].r);
  for (const Vec2 x : system.of_row(system.reference_vertex, row)) {
    vertices.push_back(system.centroid(row) + turn(x));
  }
}

std::vector<Vec2> current_vertices(const BlockSystem &system, std::size_t row) {
  std::vector<Vec2> vertices;
  append_current_vertices(system, row, vertices);
  return vertices;
}

} // namespace gcpdda
