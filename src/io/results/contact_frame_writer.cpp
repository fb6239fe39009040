#include "io/results/contact_frame_writer.hpp"

#include "io/results/frame_fields.hpp"
#include "io/results/hdf5_vtk_layout.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <span>
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
    sort(strips_.of(communicator_.rank(), number));
  }

  [[nodiscard]] const std::vector<const ContactRow *> &rows() const { return rows_; }

private:
  // Each lower id has its place. Regions come in order from each rank, those of a mobile block all from one:
  // where several meet, on a fixed block, they are sorted.
  void sort(IdRange ids) {
    std::vector<std::uint32_t> end(static_cast<std::size_t>(ids.last - ids.first) + 1); // of id i at i + 1
    std::vector<bool> has_several(end.size());
    for_each_id(ids, [&](std::size_t id, std::span<const ContactRow> rows) {
      has_several[id] = end[id + 1] > 0;
      end[id + 1] += static_cast<std::uint32_t>(rows.size());
    });
    std::partial_sum(end.begin(), end.end(), end.begin());
    rows_.resize(end.back());
    for_each_id(ids, [&](std::size_t id, std::span<const ContactRow> rows) {
      for (const ContactRow &row : rows) {
        rows_[end[id]++] = &row;
      }
    });
    // Each id ends where the next one began.
    for (std::size_t id = 0; id + 1 < end.size(); ++id) {
      if (has_several[id]) {
        const auto begin = rows_.begin() + (id == 0 ? 0 : end[id - 1]);
        std::sort(begin, rows_.begin() + end[id], [](const ContactRow *a, const ContactRow *b) {
          return std::tie(a->higher, a->position) < std::tie(b->higher, b->position);
        });
      }
    }
  }

  /// visit(id from the first one on, its rows) for what came from each rank, one after the other.
  template <class Visit> void for_each_id(IdRange ids, Visit visit) const {
    for (const std::vector<ContactRow> &part : arrived_) {
      for (auto first = part.begin(); first != part.end();) {
        const auto next =
            std::find_if(first, part.end(), [&](const ContactRow &row) { return row.lower != first->lower; });
        visit(static_cast<std::size_t>(first->lower - ids.first), std::span(first, next));
        first = next;
      }
    }
  }

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
        points_table_(file.table<double>(vtk::at("Points"), 2 * num_regions, 3)),
        fields_(file, contact_fields, num_regions) {}

  /// Collective.
  void write(std::int64_t first, const std::vector<const ContactRow *> &rows) {
    cells_.write(first, 2 * first, std::vector<std::int32_t>(rows.size(), 2));
    fill(rows);
    file_.write(points_table_, 2 * first, std::span<const double>(points_));
    fields_.write(file_, first);
  }

private:
  void fill(const std::vector<const ContactRow *> &rows) {
    points_.resize(6 * rows.size());
    double *point = points_.data();
    fields_.start(rows.size());
    for (const ContactRow *row : rows) {
      point = FieldValue<Triple>::put(point, {row->begin.x, row->begin.y, 0.0});
      point = FieldValue<Triple>::put(point, {row->end.x, row->end.y, 0.0});
      fields_.add(*row);
    }
  }

  CollectiveFile &file_;
  vtk::CellTables cells_;
  CollectiveFile::Table points_table_;
  std::vector<double> points_;
  FieldDatasets<decltype(contact_fields)> fields_;
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
    file.start_to_sync();
  }
  return as_counted;
}

} // namespace

void write_contact_frame(const Communicator &communicator, CollectiveFile &file, double time,
                         const Strips &strips, const ContactSource &source) {
  ContactStrips regions(communicator, strips, source);
  const std::vector<std::int64_t> counts = regions.count();
  const RowRange slab =
      rows_in_rank_order(communicator, std::accumulate(counts.begin(), counts.end(), std::int64_t{0}));
  vtk::write_header(file, time);
  expect_on_all_ranks(communicator, write_regions(file, regions, counts, slab),
                      "as many contacts as the source has counted");
}

} // namespace gcpdda
