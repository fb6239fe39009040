#pragma once

// What stands where in a checkpoint; shared by its writer and its reader.

#include "base/check.hpp"
#include "io/checkpoint/checkpoint.hpp"
#include "model/fingerprint.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace gcpdda::checkpoint {

/// Of the lists below and of the seal: it rises with every change of them.
inline constexpr std::int64_t version = 20;

inline std::filesystem::path folder(const std::filesystem::path &directory) {
  return directory / "checkpoints";
}

/// A number of RunFacts and the name of its dataset. Integers are written as such.
struct RealFact {
  const char *name;
  double RunFacts::*value;
};
inline constexpr std::array real_facts{RealFact{"/clock/time", &RunFacts::time},
                                       RealFact{"/clock/time_step", &RunFacts::time_step},
                                       RealFact{"/run/total_at_start", &RunFacts::total_at_start},
                                       RealFact{"/run/stick_at_start", &RunFacts::stick_at_start},
                                       RealFact{"/run/max_overlap", &RunFacts::max_overlap},
                                       RealFact{"/run/max_overlap_share", &RunFacts::max_overlap_share},
                                       RealFact{"/run/fastest_turn", &RunFacts::fastest_turn},
                                       RealFact{"/run/gravity_x", &RunFacts::gravity_x},
                                       RealFact{"/run/gravity_y", &RunFacts::gravity_y},
                                       RealFact{"/run/shaking_x", &RunFacts::shaking_x},
                                       RealFact{"/run/shaking_y", &RunFacts::shaking_y}};

/// A list of RunFacts.
template <class T> struct ListFact {
  const char *name;
  std::vector<T> RunFacts::*values;
};
inline constexpr std::array real_lists{ListFact<double>{"/run/frame_times", &RunFacts::frame_times},
                                       ListFact<double>{"/run/ledger", &RunFacts::ledger},
                                       ListFact<double>{"/stage/numbers", &RunFacts::stage_numbers},
                                       ListFact<double>{"/bolt/numbers", &RunFacts::bolt_numbers},
                                       ListFact<double>{"/statics/numbers", &RunFacts::static_numbers}};
inline constexpr std::array whole_lists{ListFact<std::int64_t>{"/stage/counts", &RunFacts::stage_counts},
                                        ListFact<std::int64_t>{"/bolt/counts", &RunFacts::bolt_counts},
                                        ListFact<std::int64_t>{"/statics/counts", &RunFacts::static_counts}};

/// RunFacts::results, a row for each file.
struct ResultLists {
  std::vector<std::uint8_t> names; ///< each with a line end behind it
  std::vector<std::int64_t> bytes;
  std::vector<std::int64_t> rows;
};
inline constexpr const char *result_names = "/result/names";
inline constexpr const char *result_bytes = "/result/bytes";
inline constexpr const char *result_rows = "/result/rows";
inline ResultLists to_lists(const std::vector<ResultFile> &results) {
  ResultLists lists;
  for (const ResultFile &file : results) {
    lists.names.insert(lists.names.end(), file.name.begin(), file.name.end());
    lists.names.push_back('\n');
    lists.bytes.push_back(file.bytes);
    lists.rows.push_back(file.rows);
  }
  return lists;
}

struct WholeFact {
  const char *name;
  std::int64_t value;
};
/// In the order of the file.
inline std::array<WholeFact, 6> whole_facts(const RunFacts &facts) {
  return {{{"/clock/step", facts.step},
           {"/run/contact_steps", facts.contact_steps},
           {"/scene/num_blocks", facts.scene.num_blocks},
           {"/scene/num_mobile", facts.scene.num_mobile},
           {"/scene/blocks", static_cast<std::int64_t>(facts.scene.blocks)},
           {"/scene/materials", static_cast<std::int64_t>(facts.scene.materials)}}};
}

inline constexpr const char *scene_parts = "/scene/parts"; ///< i64, in the order of gcpdda::scene_parts

inline constexpr const char *block_ids = "/block/id";
inline constexpr const char *block_kinds = "/block/kind";
inline constexpr const char *deformation_ids = "/deformation/id";

/// Doubles of a row: `columns` of them.
template <class Owner> struct Field {
  const char *name;
  std::size_t columns;
  void (*get)(const Owner &, std::size_t row, double *to);
  void (*set)(Owner &, std::size_t row, const double *from);
};

namespace detail {

template <class T> inline constexpr std::size_t doubles_of = sizeof(T) / sizeof(double);

inline void put(double x, double *to) {
  *to = x;
}
inline void put(const Vec2 &x, double *to) {
  to[0] = x.x, to[1] = x.y;
}
inline void put(const RigidDof &x, double *to) {
  to[0] = x.u.x, to[1] = x.u.y, to[2] = x.r;
}
inline void put(const Mat2 &x, double *to) {
  to[0] = x.xx, to[1] = x.xy, to[2] = x.yx, to[3] = x.yy;
}
inline void take(double &x, const double *from) {
  x = *from;
}
inline void take(Vec2 &x, const double *from) {
  x = {from[0], from[1]};
}
inline void take(RigidDof &x, const double *from) {
  x = {{from[0], from[1]}, from[2]};
}
inline void take(Mat2 &x, const double *from) {
  x = {from[0], from[1], from[2], from[3]};
}

/// Reach(owner, row) is what the field holds of the row.
template <class Owner, auto Reach> constexpr Field<Owner> field(const char *name) {
  using Value = std::remove_cvref_t<decltype(Reach(std::declval<Owner &>(), 0))>;
  return {name, doubles_of<Value>,
          [](const Owner &owner, std::size_t row, double *to) { put(Reach(owner, row), to); },
          [](Owner &owner, std::size_t row, const double *from) { take(Reach(owner, row), from); }};
}

template <auto Member> constexpr Field<BlockSystem> of_row(const char *name) {
  return field < BlockSystem, [](auto &system, std::size_t row) -> auto & {
    return (system.*Member)[row];
  }
  > (name);
}
template <auto Member> constexpr Field<BlockSystem> of_ledger(const char *name) {
  return field < BlockSystem, [](auto &system, std::size_t row) -> auto & {
    return system.ledger[row].*Member;
  }
  > (name);
}
template <auto Member> constexpr Field<BlockSystem> of_contact(const char *name) {
  return field < BlockSystem, [](auto &system, std::size_t row) -> auto & {
    return system.contact[row].*Member;
  }
  > (name);
}
template <auto Member> constexpr Field<BlockSystem> of_applied(const char *name) {
  using Value = std::remove_cvref_t<decltype(std::declval<AppliedForces &>().*Member)>;
  return {name, doubles_of<Value>,
          [](const BlockSystem &system, std::size_t row, double *to) {
            put(applied_forces(system, row).*Member, to);
          },
          [](BlockSystem &system, std::size_t row, const double *from) {
            if (AppliedForces *applied = system.applied_to(row)) { // else it follows from BlockSystem::body
              take(applied->*Member, from);
            }
          }};
}
template <auto Member> constexpr Field<BlockSystem> of_mark(const char *name) {
  return {
      name, doubles_of<RigidDof>,
      [](const BlockSystem &system, std::size_t row, double *to) { put(system.mark_of(row).*Member, to); },
      [](BlockSystem &system, std::size_t row, const double *from) {
        RigidDof value;
        take(value, from);
        if (value != RigidDof{}) { // no mark says the same
          mark_rows(system)[row].*Member = value;
        }
      }};
}
template <auto Member> constexpr Field<std::vector<Deformation>> of_deformation(const char *name) {
  return field < std::vector<Deformation>, [](auto &deformations, std::size_t row) -> auto & {
    return deformations[row].*Member;
  }
  > (name);
}
template <auto Member> constexpr Field<std::vector<Deformation>> of_gradient_sum(const char *name) {
  return field < std::vector<Deformation>, [](auto &deformations, std::size_t row) -> auto & {
    return deformations[row].contact.*Member;
  }
  > (name);
}
template <std::size_t number> constexpr Field<std::vector<RegionRecord>> of_region() {
  return field < std::vector<RegionRecord>, [](auto &records, std::size_t row) -> auto & {
    return records[row].memory.*(std::get<number>(RegionMemory::fields()).member);
  }
  > (std::get<number>(RegionMemory::fields()).name);
}
template <std::size_t... numbers> constexpr auto of_all_regions(std::index_sequence<numbers...> /*of*/) {
  return std::array{of_region<numbers>()...};
}

} // namespace detail

// Left out: what the scene says (properties, shapes, stiffness, loads, anchors, initial strain), what follows
// from it and the time step (matrices), where blocks were at the last refresh, since a restart begins with
// one, and what acts on them in all, since a step begins without it.
inline constexpr std::array block_fields{
    detail::of_row<&BlockSystem::displacement>("/block/displacement"),
    detail::of_row<&BlockSystem::velocity>("/block/velocity"),
    detail::of_row<&BlockSystem::acceleration>("/block/acceleration"),
    detail::of_row<&BlockSystem::trial>("/block/trial"),
    detail::of_contact<&BlockContactSum::shear>("/block/shear_force"),
    detail::of_contact<&BlockContactSum::damping>("/block/damping_force"),
    detail::of_applied<&AppliedForces::load>("/block/load_force"),
    detail::of_applied<&AppliedForces::anchor>("/block/anchor_force"),
    detail::of_applied<&AppliedForces::gravity>("/block/gravity_force"),
    detail::of_ledger<&BlockLedger::shear>("/block/shear_work"),
    detail::of_ledger<&BlockLedger::damping>("/block/damping_work"),
    detail::of_ledger<&BlockLedger::load>("/block/load_work"),
    detail::of_ledger<&BlockLedger::gravity>("/block/gravity_work"),
    detail::of_mark<&BlockMark::stage>("/block/at_stage_begin"),
    detail::of_mark<&BlockMark::look>("/block/at_last_look"),
    detail::of_mark<&BlockMark::water>("/block/in_water")};
/// Of blocks in a stage after the one with which the ground began to shake; not in other files. A file
/// without them leaves open how far blocks have moved since then.
inline constexpr std::array unshaken_fields{
    Field<BlockSystem>{"/block/at_shaking_begin", detail::doubles_of<Vec2>,
                       [](const BlockSystem &system, std::size_t row, double *to) {
                         detail::put(system.unshaken[system.unshaken_begin[row]], to);
                       },
                       [](BlockSystem &system, std::size_t row, const double *from) {
                         detail::take(unshaken_rows(system)[row], from);
                       }}};
inline constexpr std::array deformation_fields{
    detail::of_deformation<&Deformation::gradient>("/deformation/gradient"),
    detail::of_deformation<&Deformation::rate>("/deformation/rate"),
    detail::of_deformation<&Deformation::acceleration>("/deformation/acceleration"),
    detail::of_deformation<&Deformation::trial>("/deformation/trial"),
    detail::of_deformation<&Deformation::internal>("/deformation/internal"),
    detail::of_gradient_sum<&BlockGradientSum::shear>("/deformation/shear_force"),
    detail::of_gradient_sum<&BlockGradientSum::damping>("/deformation/damping_force"),
    detail::of_deformation<&Deformation::load_force>("/deformation/load_force"),
    detail::of_deformation<&Deformation::anchor_force>("/deformation/anchor_force")};
inline constexpr auto region_fields =
    detail::of_all_regions(std::make_index_sequence<std::tuple_size_v<decltype(RegionMemory::fields())>>());
inline constexpr const char *region_blocks = "/region/blocks"; ///< i64 (n, 2): lower, higher
inline constexpr const char *region_stretches =
    "/region/stretches";                                         ///< i32 (n, 2): of the lower, of the higher
inline constexpr const char *region_states = "/region/state";    ///< u8
inline constexpr const char *region_laws = "/region/law";        ///< i32
inline constexpr const char *region_seen_at = "/region/seen_at"; ///< i32

// A field that is added to the state must join one of the lists above, or the words over them.
static_assert(std::tuple_size_v<decltype(BlockSystem::row_fields())> == 8);
static_assert(sizeof(BlockMark) == 9 * sizeof(double));
static_assert(sizeof(BlockContactSum) == 9 * sizeof(double));
static_assert(sizeof(BlockLedger) == 4 * sizeof(double));
static_assert(sizeof(AppliedForces) == 8 * sizeof(double));
static_assert(sizeof(Deformation) == std::size_t{7} * 64);
static_assert(sizeof(PseudoMotion) == 21 * sizeof(double)); // simulation/static_state.cpp, all but `moved`

inline constexpr std::array<const char *, 10> groups{"/clock",       "/run",   "/stage",  "/bolt",
                                                     "/statics",     "/scene", "/result", "/block",
                                                     "/deformation", "/region"};
inline constexpr const char *checksum = "/checksum";

/// A checksum of numbers in named places: summed modulo 2^64, so that it may be summed over ranks in any
/// order. It is made of what a run hands over, and tells of a write that went wrong unnoticed; the seal is
/// made of the written file.
class ContentSum {
public:
  /// @param first  place of the first value in its dataset
  template <class T> void add(std::string_view dataset, std::int64_t first, std::span<const T> values) {
    std::uint64_t name = 0;
    for (const char c : dataset) {
      name = scattered(name ^ static_cast<unsigned char>(c));
    }
    auto place = static_cast<std::uint64_t>(first);
    for (const T value : values) {
      std::uint64_t bits = 0;
      if constexpr (std::is_same_v<T, double>) {
        bits = std::bit_cast<std::uint64_t>(value);
      } else {
        bits = static_cast<std::uint64_t>(value);
      }
      sum_ += scattered(scattered(name + place++) ^ bits);
    }
  }

  /// Of all ranks. Collective.
  [[nodiscard]] std::uint64_t total(const Communicator &communicator) const {
    return agreed_sum(communicator, sum_);
  }

  /// Sum modulo 2^64, in halves that cannot overflow.
  static std::uint64_t agreed_sum(const Communicator &communicator, std::uint64_t mine) {
    std::array<std::int64_t, 2> halves{static_cast<std::int64_t>(mine & 0xffffffffU),
                                       static_cast<std::int64_t>(mine >> 32)};
    communicator.sum(halves);
    return static_cast<std::uint64_t>(halves[0]) + (static_cast<std::uint64_t>(halves[1]) << 32);
  }

private:
  std::uint64_t sum_ = 0;
};

} // namespace gcpdda::checkpoint
