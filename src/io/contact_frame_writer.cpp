#include "gcpdda/io/result_files.hpp"

#include "frame_strips.hpp"
#include "hdf5_vtk_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <tuple>

namespace gcpdda {

namespace {

/// Regions on their way to the ranks that write them: those that own the slab of the lower id.
class ContactStrips {
public:
  ContactStrips(const Communicator &communicator, const Strips &strips, const ContactSource &source)
      : communicator_(communicator), strips_(strips), source_(source),
        leaving_(static_cast<std::size_t>(communicator.size())) {}

  [[nodiscard]] int size() const { return strips_.size(); }

  /// Regions in each strip of this rank's slab. Collective.
  [[nodiscard]] std::vector<std::int64_t> count() const {
    std::vector<std::vector<std::int64_t>> counts(leaving_.size());
    for (std::size_t rank = 0; rank < counts.size(); ++rank) {
      for (int number = 0; number < size(); ++number) {
        const IdRange ids = strips_.of(static_cast<int>(rank), number);
        counts[rank].push_back(source_.count(ids.first, ids.last));
      }
    }
    std::vector<std::int64_t> sums(static_cast<std::size_t>(size()));
    for (const std::vector<std::int64_t> &theirs : communicator_.all_to_all(std::move(counts))) {
      std::transform(sums.begin(), sums.end(), theirs.begin(), sums.begin(), std::plus<>());
    }
    return sums;
  }

  /// Every rank gets the regions of its strip of this number, in the order of the file. Collective.
  void bring(int number) {
    for (std::size_t rank = 0; rank < leaving_.size(); ++rank) {
      const IdRange ids = strips_.of(static_cast<int>(rank), number);
      source_.append(ids.first, ids.last, leaving_[rank]);
    }
    communicator_.all_to_all(leaving_, arrived_);
    const auto in_file = [](const ContactRow *a, const ContactRow *b) {
      return std::tie(a->lower, a->higher, a->position) < std::tie(b->lower, b->higher, b->position);
    };
    rows_.clear();
    for (const std::vector<ContactRow> &part : arrived_) {
      const auto num_before = std::ssize(rows_);
      for (const ContactRow &row : part) {
        rows_.push_back(&row);
      }
      std::inplace_merge(rows_.begin(), rows_.begin() + num_before, rows_.end(), in_file);
    }
  }

  [[nodiscard]] const std::vector<const ContactRow *> &rows() const { return rows_; }

private:
  Communicator communicator_;
  Strips strips_;
  const ContactSource &source_;
  std::vector<std::vector<ContactRow>> leaving_; ///< by rank
  std::vector<std::vector<ContactRow>> arrived_;
  std::vector<const ContactRow *> rows_;
};

/// Datasets of a frame's contacts, and the buffers that their pieces are made in.
class ContactTables {
public:
  ContactTables(CollectiveFile &file, std::int64_t num_regions)
      : file_(file), cells_(file, num_regions, 2 * num_regions, vtk::CellType::line),
        points_(file.table<double>(vtk::at("Points"), 2 * num_regions, 3)),
        blocks_(file.table<std::int64_t>(vtk::cell_data("blocks"), num_regions, 2)),
        joint_(file.table<std::int32_t>(vtk::cell_data("joint"), num_regions)),
        state_(file.table<std::uint8_t>(vtk::cell_data("state"), num_regions)),
        normal_force_(file.table<double>(vtk::cell_data("normal_force"), num_regions)),
        shear_force_(file.table<double>(vtk::cell_data("shear_force"), num_regions)),
        overlap_(file.table<double>(vtk::cell_data("overlap"), num_regions)),
        slip_(file.table<double>(vtk::cell_data("slip"), num_regions)) {}

  /// Collective.
  void write(std::int64_t first, const std::vector<const ContactRow *> &rows) {
    cells_.write(first, 2 * first, std::vector<std::int32_t>(rows.size(), 2));
    columns(points_, 2 * first, rows, real_, [](const ContactRow &row) {
      return std::array{row.begin.x, row.begin.y, 0.0, row.end.x, row.end.y, 0.0};
    });
    columns(blocks_, first, rows, long_, [](const ContactRow &row) {
      return std::array{row.lower, row.higher};
    });
    columns(joint_, first, rows, int_, [](const ContactRow &row) { return std::array{row.joint}; });
    columns(state_, first, rows, small_, [](const ContactRow &row) { return std::array{row.state}; });
    columns(normal_force_, first, rows, real_,
            [](const ContactRow &row) { return std::array{row.normal_force}; });
    columns(shear_force_, first, rows, real_,
            [](const ContactRow &row) { return std::array{row.shear_force}; });
    columns(overlap_, first, rows, real_, [](const ContactRow &row) { return std::array{row.overlap}; });
    columns(slip_, first, rows, real_, [](const ContactRow &row) { return std::array{row.slip}; });
  }

private:
  /// @param get  the values of one region, as an array
  template <class T, class Get>
  void columns(const CollectiveFile::Table &table, std::int64_t first,
               const std::vector<const ContactRow *> &rows, std::vector<T> &values, Get get) {
    values.clear();
    for (const ContactRow *row : rows) {
      const auto of_row = get(*row);
      values.insert(values.end(), of_row.begin(), of_row.end());
    }
    file_.write(table, first, std::span<const T>(values));
  }

  CollectiveFile &file_;
  vtk::CellTables cells_;
  CollectiveFile::Table points_;
  CollectiveFile::Table blocks_;
  CollectiveFile::Table joint_;
  CollectiveFile::Table state_;
  CollectiveFile::Table normal_force_;
  CollectiveFile::Table shear_force_;
  CollectiveFile::Table overlap_;
  CollectiveFile::Table slip_;
  std::vector<double> real_;
  std::vector<std::int64_t> long_;
  std::vector<std::int32_t> int_;
  std::vector<std::uint8_t> small_;
};

/// False on a rank whose regions are not as many as were counted; it writes none of them. Collective.
bool write_regions(CollectiveFile &file, ContactStrips &strips, const std::vector<std::int64_t> &counts,
                   const RowRange &slab) {
  ContactTables tables(file, slab.total);
  std::int64_t first = slab.first;
  bool as_counted = true;
  for (int number = 0; number < strips.size(); ++number) {
    strips.bring(number);
    const std::int64_t count = counts[static_cast<std::size_t>(number)];
    as_counted = as_counted && std::ssize(strips.rows()) == count;
    tables.write(first, as_counted ? strips.rows() : std::vector<const ContactRow *>());
    first += count;
  }
  return as_counted;
}

} // namespace

void FrameWriter::write_contacts(int index, double time, const ContactSource &source) {
  ContactStrips strips(communicator_, {num_blocks_, communicator_.size(), ids_per_strip_}, source);
  const std::vector<std::int64_t> counts = strips.count();
  const RowRange slab =
      rows_in_rank_order(communicator_, std::accumulate(counts.begin(), counts.end(), std::int64_t{0}));
  CollectiveFile file(communicator_, directory_ / "frames" / fmt::format("contacts_{:06}.hdf", index));
  vtk::write_header(file, time);
  expect_on_all_ranks(communicator_, write_regions(file, strips, counts, slab),
                      "as many contacts as the source has counted");
  file.publish();
  all_writes_collective_ = all_writes_collective_ && file.all_writes_collective();
}

} // namespace gcpdda
