#pragma once

// The fields of frames: one table for blocks and one for contacts. A table drives the datasets of the HDF5
// files, the lines of run.xdmf, the reader, and the tables of run/guide/09_results_and_pictures.md, which a
// test compares with it. Datasets are made in the order of a table, and the bytes of a file depend on it.

#include "gcpdda/io/frame_rows.hpp"
#include "io/results/frame_reader.hpp"
#include "io/results/hdf5_vtk_layout.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace gcpdda {

/// A field: its dataset has a row for each block or contact, of one or several numbers.
template <class Row, class Content, class Value> struct FrameField {
  const char *name;
  Value (*of)(const Row &);
  std::vector<Value> Content::*column; ///< where the reader puts it
  const char *meaning;                 ///< in the guide
};
template <class Value> using BlockField = FrameField<FrameRow, FrameContent, Value>;
template <class Value> using ContactField = FrameField<ContactRow, ContactFrameContent, Value>;

/// What a value consists of.
template <class Value> struct FieldValue {
  using Number = Value;
  static constexpr int size = 1;
  static Number *put(Number *place, Value value) {
    *place = value;
    return place + size;
  }
};
template <class T, std::size_t N> struct FieldValue<std::array<T, N>> {
  using Number = T;
  static constexpr int size = static_cast<int>(N);
  static Number *put(Number *place, const std::array<T, N> &value) {
    for (const T number : value) {
      *place++ = number;
    }
    return place;
  }
};

using Triple = std::array<double, 3>;
using IdPair = std::array<std::int64_t, 2>;

// clang-format off
/// Fields of blocks that never change, in the topology file.
inline constexpr std::tuple constant_block_fields{
    BlockField<std::int64_t>{"block", [](const FrameRow &row) { return row.block; }, &FrameContent::block, "number of the block"},
    BlockField<std::int32_t>{"material", [](const FrameRow &row) { return row.material; }, &FrameContent::material, "number of its material"}};

/// Fields of blocks in each frame.
inline constexpr std::tuple changing_block_fields{
    BlockField<std::uint8_t>{"kind", [](const FrameRow &row) { return row.kind; }, &FrameContent::kind, "0 fixed, 1 rigid, 2 deformable"},
    BlockField<double>{"rotation", [](const FrameRow &row) { return row.rotation; }, &FrameContent::rotation, "since the start, rad, counter-clockwise"},
    BlockField<Triple>{"displacement", [](const FrameRow &row) { return Triple{row.displacement.x, row.displacement.y, 0.0}; }, &FrameContent::displacement, "of the centroid since the start, m"},
    BlockField<Triple>{"velocity", [](const FrameRow &row) { return row.velocity; }, &FrameContent::velocity, "m/s, m/s, and the angular velocity in rad/s as third component"},
    BlockField<Triple>{"stress", [](const FrameRow &row) { return row.stress; }, &FrameContent::stress, "mean Cauchy stress xx, yy, xy in Pa, tension positive"},
    BlockField<Triple>{"contact_force", [](const FrameRow &row) { return row.contact_force; }, &FrameContent::contact_force, "sum of the contact forces on the block in N/m, and their moment in N as third component"}};

inline constexpr std::tuple contact_fields{
    ContactField<IdPair>{"blocks", [](const ContactRow &row) { return IdPair{row.lower, row.higher}; }, &ContactFrameContent::blocks, "numbers of the two blocks"},
    ContactField<std::int32_t>{"joint", [](const ContactRow &row) { return row.joint; }, &ContactFrameContent::joint, "number of the joint law"},
    ContactField<std::uint8_t>{"state", [](const ContactRow &row) { return row.state; }, &ContactFrameContent::state, "1 stick, 2 slip, 3 bond, which has the shear and the tension of its joint; what presses on its edges is in a row of state 1"},
    ContactField<double>{"normal_force", [](const ContactRow &row) { return row.normal_force; }, &ContactFrameContent::normal_force, "N/m, of a bond minus its tension"},
    ContactField<double>{"shear_force", [](const ContactRow &row) { return row.shear_force; }, &ContactFrameContent::shear_force, "N/m"},
    ContactField<double>{"overlap", [](const ContactRow &row) { return row.overlap; }, &ContactFrameContent::overlap, "thickness along the normal of the contact, m: its largest depth, and up to half more beside a corner"},
    ContactField<double>{"slip", [](const ContactRow &row) { return row.slip; }, &ContactFrameContent::slip, "so far, m"}};
// clang-format on

inline constexpr std::tuple block_fields = std::tuple_cat(constant_block_fields, changing_block_fields);

template <class Fields, class Visit> void for_each_field(Fields &fields, Visit &&visit) {
  std::apply([&](auto &...field) { (visit(field), ...); }, fields);
}

/// Dataset of one field, and the buffer that its pieces are made in.
template <class Row, class Content, class Value> class FieldDataset {
public:
  using Field = FrameField<Row, Content, Value>;

  FieldDataset(CollectiveFile &file, const Field &field, std::int64_t num_rows)
      : of_(field.of),
        table_(file.table<Number>(vtk::cell_data(field.name), num_rows, FieldValue<Value>::size)) {}

  void start(std::size_t num_rows) {
    values_.resize(FieldValue<Value>::size * num_rows);
    next_ = values_.data();
  }
  void add(const Row &row) { next_ = FieldValue<Value>::put(next_, of_(row)); }
  /// Collective.
  void write(CollectiveFile &file, std::int64_t first) const {
    file.write(table_, first, std::span<const Number>(values_));
  }

private:
  using Number = typename FieldValue<Value>::Number;

  Value (*of_)(const Row &);
  CollectiveFile::Table table_;
  std::vector<Number> values_;
  Number *next_ = nullptr;
};

/// Datasets of all fields of a table, made in its order.
template <class Fields> class FieldDatasets;
template <class Row, class Content, class... Values>
class FieldDatasets<const std::tuple<FrameField<Row, Content, Values>...>> {
public:
  FieldDatasets(CollectiveFile &file, const std::tuple<FrameField<Row, Content, Values>...> &fields,
                std::int64_t num_rows)
      : datasets_(std::apply(
            [&](const auto &...field) {
              return std::tuple<FieldDataset<Row, Content, Values>...>{
                  FieldDataset<Row, Content, Values>(file, field, num_rows)...};
            },
            fields)) {}

  void start(std::size_t num_rows) {
    for_each_field(datasets_, [&](auto &dataset) { dataset.start(num_rows); });
  }
  /// One row of all fields: rows are longer than what a field takes of them.
  void add(const Row &row) {
    for_each_field(datasets_, [&](auto &dataset) { dataset.add(row); });
  }
  /// The rows that were added after start(). Collective.
  void write(CollectiveFile &file, std::int64_t first) {
    for_each_field(datasets_, [&](auto &dataset) { dataset.write(file, first); });
  }

private:
  std::tuple<FieldDataset<Row, Content, Values>...> datasets_;
};

} // namespace gcpdda
