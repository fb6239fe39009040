#include "gcpdda/io/result_files.hpp"

#include "hdf5_vtk_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace gcpdda {

namespace {

/// Rows of this rank's slab of lower ids, in the order of the file.
std::vector<ContactRow> route_to_slabs(const Communicator &communicator, std::int64_t num_blocks,
                                       std::vector<ContactRow> rows) {
  const bool sound = std::all_of(rows.begin(), rows.end(), [num_blocks](const ContactRow &row) {
    return 0 <= row.lower && row.lower < row.higher && row.higher < num_blocks;
  });
  expect_on_all_ranks(communicator, sound, "contact rows with valid ids, the lower first");
  std::vector<std::vector<ContactRow>> parts(static_cast<std::size_t>(communicator.size()));
  if (parts.size() == 1) {
    parts[0] = std::move(rows);
  } else {
    for (const ContactRow &row : rows) {
      parts[static_cast<std::size_t>(slab_owner(num_blocks, communicator.size(), row.lower))].push_back(row);
    }
    rows = {};
  }
  parts = communicator.all_to_all(std::move(parts));
  std::vector<ContactRow> slab = std::move(parts.front());
  for (std::size_t rank = 1; rank < parts.size(); ++rank) {
    slab.insert(slab.end(), parts[rank].begin(), parts[rank].end());
    parts[rank] = {};
  }
  const auto in_file = [](const ContactRow &a, const ContactRow &b) {
    return std::tie(a.lower, a.higher, a.position) < std::tie(b.lower, b.higher, b.position);
  };
  if (!std::is_sorted(slab.begin(), slab.end(), in_file)) {
    std::sort(slab.begin(), slab.end(), in_file);
  }
  return slab;
}

} // namespace

void FrameWriter::write_contacts(int index, double time, std::vector<ContactRow> rows) {
  const std::vector<ContactRow> slab = route_to_slabs(communicator_, num_blocks_, std::move(rows));
  std::vector<Vec2> ends;
  std::vector<std::int64_t> blocks;
  ends.reserve(2 * slab.size());
  blocks.reserve(2 * slab.size());
  for (const ContactRow &row : slab) {
    ends.insert(ends.end(), {row.begin, row.end});
    blocks.insert(blocks.end(), {row.lower, row.higher});
  }
  const RowRange regions = rows_in_rank_order(communicator_, std::ssize(slab));
  const RowRange points{2 * regions.first, 2 * regions.count, 2 * regions.total};

  CollectiveFile file(communicator_, directory_ / "frames" / fmt::format("contacts_{:06}.hdf", index));
  vtk::write_header(file, time);
  vtk::write_cells(file, regions, points, vtk::CellType::line, std::vector<std::int32_t>(slab.size(), 2));
  vtk::write_points(file, points, ends);
  const auto column = [&](const char *name, auto get) {
    file.dataset(vtk::cell_data(name), regions, vtk::column(slab, get));
  };
  file.dataset(vtk::cell_data("blocks"), regions, blocks, 2);
  column("joint", [](const ContactRow &row) { return row.joint; });
  column("state", [](const ContactRow &row) { return row.state; });
  column("normal_force", [](const ContactRow &row) { return row.normal_force; });
  column("shear_force", [](const ContactRow &row) { return row.shear_force; });
  column("overlap", [](const ContactRow &row) { return row.overlap; });
  column("slip", [](const ContactRow &row) { return row.slip; });
  file.publish();
  all_writes_collective_ = all_writes_collective_ && file.all_writes_collective();
}

} // namespace gcpdda
