#include "simulation/bolts.hpp"

#include "base/check.hpp"
#include "contact/contact_sums.hpp"
#include "model/find_row.hpp"
#include "simulation/bolt_pieces.hpp"
#include "simulation/link_springs.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <tuple>

namespace gcpdda {

namespace {

/// Of an owned, ghost or fixed block.
std::size_t any_row(const BlockSystem &system, std::int64_t id) {
  const auto row = find_row(system, id);
  expect(row.has_value(), "the blocks of a bolt are seen by the owners of either");
  return *row;
}

/// Of t_n.
LinkEnd in_reference_axes(const BlockSystem &system, std::size_t row, const LinkEnd &world) {
  Mat2 back;
  if (system.is_deformable(row)) {
    back = inverse(system.deformation_of(row).gradient);
  } else {
    const Rotation turn = Rotation::of(system.displacement[row].r);
    back = {turn.c, turn.s, -turn.s, turn.c};
  }
  return {world.block, back(world.point - system.centroid(row)), back(world.along), world.away};
}

struct LinkRecord {
  std::uint32_t link = 0;
  LinkMemory memory;
};
struct EndRecord {
  std::uint32_t link = 0;
  std::uint32_t side = 0;
  LinkEnd end;
};

Diagnostic remark(const Bolt &bolt, Severity severity, const char *what, const char *why, const char *hint) {
  return {severity, bolt.where, fmt::format("bolt '{}' {}", bolt.name, what), why, hint};
}

constexpr double near_an_end = 1e-6; ///< of a bolt: an end as near to a block lies in it

/// What is odd about a bolt that has been put in.
void note_bolt(const Bolt &bolt, const std::vector<BoltPiece> &pieces, bool has_links, Diagnostics &notes) {
  if (pieces.empty()) {
    notes.push_back(remark(bolt, Severity::warning, "lies outside the blocks", "it holds nothing",
                           "move 'from' and 'to' into blocks; an end on an edge lies in none"));
  } else if (!has_links && (pieces.front().begin > near_an_end || pieces.back().end < 1.0 - near_an_end)) {
    const bool is_head = pieces.front().begin > near_an_end;
    notes.push_back(remark(bolt, Severity::warning,
                           is_head ? "crosses no joint, and its head lies in no block"
                                   : "crosses no joint, and its tip lies in no block",
                           "it acts only between two blocks, and an end on an edge lies in none",
                           is_head ? "move 'from' into a block" : "move 'to' into a block"));
  } else if (!has_links) {
    notes.push_back(remark(bolt, Severity::warning, "crosses no joint", "it acts only between two blocks",
                           "make it longer, or leave it out"));
  } else if (pieces.back().end < 1.0 - near_an_end) {
    notes.push_back(remark(bolt, Severity::warning, "ends outside the blocks",
                           "its tip is taken to be where it leaves the last one", "check 'to'"));
  }
}

} // namespace

void Bolts::install(const Communicator &communicator, const Scene &scene, const BlockSystem &system,
                    std::span<const std::int64_t> which, const std::function<bool(std::int64_t)> &is_gone,
                    Diagnostics &notes) {
  std::vector<BoltPiece> mine;
  for (std::size_t row = 0; row < system.num_rows() && !which.empty(); ++row) {
    const bool counts = row < system.num_owned || (system.is_fixed(row) && communicator.is_root());
    if (counts && !is_gone(system.properties[row].id.value)) {
      append_pieces(scene, which, system, row, mine);
    }
  }
  std::vector<BoltPiece> all;
  for (const auto &theirs : communicator.all_gather(mine)) {
    all.insert(all.end(), theirs.begin(), theirs.end());
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const BoltPiece &a, const BoltPiece &b) { return a.bolt < b.bolt; });
  const std::size_t first = links_.size();
  auto piece = all.begin();
  for (const std::int64_t index : which) {
    const Bolt &bolt = scene.bolts[static_cast<std::size_t>(index)];
    std::vector<BoltPiece> pieces;
    for (; piece != all.end() && piece->bolt == index; ++piece) {
      pieces.push_back(*piece);
    }
    const std::vector<BoltLink> links =
        links_of(bolt, index, scene.supports[static_cast<std::size_t>(bolt.support)], pieces);
    note_bolt(bolt, pieces, !links.empty(), notes);
    links_.insert(links_.end(), links.begin(), links.end());
  }
  find_ends(communicator, system, first);
}

void Bolts::install_liners(const Communicator &communicator, const Scene &scene, const BlockSystem &system,
                           std::span<const std::int64_t> which, Diagnostics &notes) {
  if (which.empty()) {
    return;
  }
  const std::size_t first = links_.size();
  const std::vector<BoltLink> elements = lay_liners(communicator, scene, system, which, notes);
  links_.insert(links_.end(), elements.begin(), elements.end());
  find_ends(communicator, system, first);
}

// The owner of a block knows its axes; fixed ones are the same everywhere.
void Bolts::find_ends(const Communicator &communicator, const BlockSystem &system, std::size_t first) {
  std::vector<EndRecord> mine;
  for (std::size_t k = first; k < links_.size(); ++k) {
    for (std::size_t side = 0; side < 2; ++side) {
      LinkEnd &end = links_[k].end[side];
      if (const auto owned = find_owned_row(system, end.block)) {
        mine.push_back({static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(side),
                        in_reference_axes(system, *owned, end)});
      } else if (const auto fixed = find_fixed_row(system, end.block)) {
        end = in_reference_axes(system, *fixed, end);
      }
    }
  }
  for (const auto &theirs : communicator.all_gather(mine)) {
    for (const EndRecord &record : theirs) {
      links_[record.link].end[record.side] = record.end;
    }
  }
  std::stable_sort(links_.begin(), links_.end(), [](const BoltLink &a, const BoltLink &b) {
    return std::tuple(a.liner, a.bolt) < std::tuple(b.liner, b.bolt);
  });
  connected_ = false;
}

void Bolts::remove(const std::function<bool(const BoltLink &)> &is_gone) {
  std::erase_if(links_, is_gone);
  connected_ = false;
}

void Bolts::end_at_voids(const std::function<bool(std::int64_t)> &is_gone) {
  end_bars_at_voids(links_, is_gone);
}

void Bolts::take_laws(const Scene &scene) {
  laws_.clear();
  for (const BoltLink &link : links_) {
    const std::int32_t support = link.liner >= 0 ? scene.liners[static_cast<std::size_t>(link.liner)].support
                                                 : scene.bolts[static_cast<std::size_t>(link.bolt)].support;
    laws_.push_back(law_of(scene.supports[static_cast<std::size_t>(support)], link));
  }
  springs_ = springs_of_links();
}

Bolts::BlockSprings Bolts::springs_of_links() const {
  std::vector<std::pair<std::int64_t, PointSpring>> all;
  for (std::size_t k = 0; k < 2 * links_.size(); ++k) {
    const BoltLink &link = links_[k / 2];
    for (const PointSpring &spring : springs_of(laws_[k / 2], link, k % 2)) {
      all.emplace_back(link.end[k % 2].block, spring);
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const auto &a, const auto &b) { return a.first < b.first; });
  BlockSprings sorted;
  for (const auto &[block, spring] : all) {
    sorted.block.push_back(block);
    sorted.springs.push_back(spring);
  }
  return sorted;
}

void Bolts::share(const Communicator &communicator) {
  if (connected_) {
    links_ = shared(communicator);
  }
}

std::vector<BoltLink> Bolts::shared(const Communicator &communicator) const {
  std::vector<BoltLink> links = links_;
  if (!connected_ || links.empty()) {
    return links;
  }
  std::vector<LinkRecord> mine;
  for (const Here &here : here_) {
    if (here.counts) {
      mine.push_back({here.link, links_[here.link].memory});
    }
  }
  for (const auto &theirs : communicator.all_gather(mine)) {
    for (const LinkRecord &record : theirs) {
      links[record.link].memory = record.memory;
    }
  }
  return links;
}

std::vector<FarGhost> Bolts::partners(const Communicator &communicator, const BlockSystem &system) const {
  std::vector<FarGhost> far;
  if (links_.empty() || communicator.size() == 1) {
    return far;
  }
  std::vector<std::int64_t> owner(2 * links_.size(), -1);
  for (std::size_t k = 0; k < owner.size(); ++k) {
    if (find_owned_row(system, links_[k / 2].end[k % 2].block)) {
      owner[k] = communicator.rank();
    }
  }
  communicator.max(owner);
  for (std::size_t k = 0; k < owner.size(); ++k) {
    const std::int64_t other = owner[k ^ 1U];
    if (owner[k] == communicator.rank() && other >= 0 && other != owner[k]) {
      const std::size_t row = *find_owned_row(system, links_[k / 2].end[k % 2].block);
      far.push_back({static_cast<int>(other), static_cast<std::uint32_t>(row)});
    }
  }
  return far;
}

void Bolts::connect(const BlockSystem &system) {
  here_.clear();
  for (std::size_t k = 0; k < links_.size(); ++k) {
    const auto first = find_owned_row(system, links_[k].end[0].block);
    const auto second = find_owned_row(system, links_[k].end[1].block);
    if (first || second) {
      here_.push_back({static_cast<std::uint32_t>(k),
                       {any_row(system, links_[k].end[0].block), any_row(system, links_[k].end[1].block)},
                       first || find_fixed_row(system, links_[k].end[0].block)});
    }
  }
  forces_.resize(here_.size());
  gradient_.assign(links_.empty() ? 0 : system.deformation.size(), {});
  connected_ = true;
}

void Bolts::evaluate(const BlockSystem &system) {
  for (std::size_t k = 0; k < here_.size(); ++k) {
    const auto &[number, rows, counts] = here_[k];
    BoltLink &link = links_[number];
    const LinkPose pose = pose_of(system, link, rows);
    link.memory = respond(laws_[number], link.memory, pose.extension, pose.slide, pose.turn);
    forces_[k] = force_of(system, link, rows, pose, link.memory);
  }
  std::fill(gradient_.begin(), gradient_.end(), Mat2{});
  for (std::size_t k = 0; k < here_.size(); ++k) {
    for (std::size_t side = 0; side < 2; ++side) {
      const std::size_t row = here_[k].rows[side];
      if (row < system.num_owned && system.is_deformable(row)) {
        gradient_[system.deformation_begin[row]] += forces_[k].gradient[side];
      }
    }
  }
}

void Bolts::note_largest() {
  for (const Here &here : here_) {
    LinkMemory &memory = links_[here.link].memory;
    memory.largest = with_last(laws_[here.link], memory);
  }
}

void Bolts::add_forces(const BlockSystem &system, std::span<BlockContactSum> sums) const {
  for (std::size_t k = 0; k < here_.size(); ++k) {
    for (std::size_t side = 0; side < 2; ++side) {
      if (const std::size_t row = here_[k].rows[side]; row < system.num_owned) {
        sums[row].force += forces_[k].rigid[side];
      }
    }
  }
}

std::vector<LinkPull> Bolts::pulls_from(const std::function<bool(std::int64_t)> &goes,
                                        const BlockSystem &system) const {
  std::vector<LinkPull> pulls;
  for (std::size_t k = 0; k < here_.size(); ++k) {
    const BoltLink &link = links_[here_[k].link];
    for (std::size_t side = 0; side < 2; ++side) {
      const std::size_t row = here_[k].rows[side];
      if (row < system.num_owned && goes(link.end[1 - side].block) && !goes(link.end[side].block)) {
        pulls.push_back({row, forces_[k].rigid[side], forces_[k].gradient[side]});
      }
    }
  }
  return pulls;
}

std::span<const PointSpring> Bolts::BlockSprings::at(std::int64_t wanted) const {
  const auto [first, last] = std::equal_range(block.begin(), block.end(), wanted);
  return {springs.data() + (first - block.begin()), static_cast<std::size_t>(last - first)};
}

void Bolts::add_energies(double share, LinkEnergies &sums) const {
  for (const Here &here : here_) {
    if (here.counts) {
      const LinkMemory &memory = links_[here.link].memory;
      sums.stored.add(share * stored_energy(laws_[here.link], memory));
      sums.dissipated.add(share * memory.dissipated);
    }
  }
}

void Bolts::add_energies_at(const BlockSystem &system, double share, LinkEnergies &sums) const {
  for (const Here &here : here_) {
    if (here.counts) {
      const BoltLink &link = links_[here.link];
      const LinkPose pose = pose_of(system, link, here.rows);
      const LinkMemory then = respond(laws_[here.link], link.memory, pose.extension, pose.slide, pose.turn);
      sums.stored.add(share * stored_energy(laws_[here.link], then));
      sums.dissipated.add(share * then.dissipated);
    }
  }
}

// How far the line of a link goes on beyond its ends, towards the bolt's head and its tip; negative where it
// stops short of them. A bar ends where the rock does.
std::array<double, 2> Bolts::reach_of(std::size_t link) const {
  const auto to_head = [&](std::size_t k) { return links_[k].overhang[0] + 0.5 * links_[k].length; };
  const auto half_way = [&](std::size_t a, std::size_t b) {
    return 0.5 * (to_head(b) - to_head(a) - links_[link].length);
  };
  const BoltLink &own = links_[link];
  const bool is_first = link == 0 || links_[link - 1].bolt != own.bolt;
  const bool is_last = link + 1 == links_.size() || links_[link + 1].bolt != own.bolt;
  return {std::min(is_first ? own.overhang[0] : half_way(link - 1, link), own.grout[0] - 0.5 * own.length),
          std::min(is_last ? own.overhang[1] : half_way(link, link + 1), own.grout[1] - 0.5 * own.length)};
}

std::vector<LinkLine> Bolts::lines(const Communicator &communicator, const BlockSystem &system) const {
  std::vector<LinkLine> mine;
  for (const Here &here : here_) {
    const BoltLink &link = links_[here.link];
    if (!here.counts || link.liner >= 0) {
      continue;
    }
    const std::size_t head = link.head_first ? 0 : 1;
    const double sign = link.head_first ? 1.0 : -1.0; // of the bolt's direction in D
    const auto position = [&](std::size_t side, double beyond) {
      return trial_position(system, here.rows[side],
                            link.end[side].point + (sign * beyond) * link.end[side].along);
    };
    const auto [towards_head, towards_tip] = reach_of(here.link);
    mine.push_back({here.link,
                    {position(head, -towards_head), position(head, 0.5 * link.length),
                     position(1 - head, -0.5 * link.length), position(1 - head, towards_tip)},
                    link.memory});
    mine.back().memory.largest = with_last(laws_[here.link], link.memory);
  }
  std::vector<LinkLine> all;
  for (const auto &theirs : communicator.all_gather(mine)) {
    all.insert(all.end(), theirs.begin(), theirs.end());
  }
  std::sort(all.begin(), all.end(), [](const LinkLine &a, const LinkLine &b) { return a.link < b.link; });
  return all;
}

std::vector<statics::ContactSpring> Bolts::static_springs(const BlockSystem &system, double share) const {
  std::vector<statics::ContactSpring> springs;
  for (const Here &here : here_) {
    const BoltLink &link = links_[here.link];
    if (!link.memory.broken) {
      append_springs(system, link, here.rows, laws_[here.link], share, springs);
    }
  }
  return springs;
}

std::vector<LinerLine> Bolts::liner_lines(const Communicator &communicator, const BlockSystem &system) const {
  std::vector<LinerLine> mine;
  for (const Here &here : here_) {
    const BoltLink &link = links_[here.link];
    if (here.counts && link.liner >= 0) {
      mine.push_back(line_of(system, link, here.rows, laws_[here.link]));
      mine.back().link = here.link;
    }
  }
  std::vector<LinerLine> all;
  for (const auto &theirs : communicator.all_gather(mine)) {
    all.insert(all.end(), theirs.begin(), theirs.end());
  }
  std::sort(all.begin(), all.end(), [](const LinerLine &a, const LinerLine &b) { return a.link < b.link; });
  return all;
}

std::vector<BoltReport> Bolts::report(const Communicator &communicator, const Scene &scene,
                                      const BlockSystem &system) const {
  std::vector<BoltReport> reports;
  for (const auto &[number, points, memory] : lines(communicator, system)) {
    const std::int64_t bolt = links_[number].bolt;
    if (reports.empty() || reports.back().bolt != bolt) {
      BoltReport &fresh = reports.emplace_back();
      fresh.bolt = bolt;
      fresh.head = points.front();
      fresh.axial = memory.axial;
      fresh.largest_axial = memory.largest.tension;
      fresh.extension = memory.extension;
    }
    BoltReport &report = reports.back();
    report.tip = points.back();
    report.axial = std::max(report.axial, memory.axial);
    report.shear = std::max(report.shear, std::abs(memory.shear));
    report.largest_axial = std::max(report.largest_axial, memory.largest.tension);
    report.largest_shear = std::max(report.largest_shear, memory.largest.shear);
    report.extension = std::max(report.extension, memory.extension);
    report.slide = std::max(report.slide, std::abs(memory.slide));
    ++report.links;
    report.yielded += memory.yielded || memory.broken ? 1 : 0;
    report.broken += memory.broken ? 1 : 0;
  }
  for (BoltReport &report : reports) {
    const auto support = static_cast<std::size_t>(scene.bolts[static_cast<std::size_t>(report.bolt)].support);
    for (double *force : {&report.axial, &report.shear, &report.largest_axial, &report.largest_shear}) {
      *force *= scene.supports[support].spacing;
    }
  }
  return reports;
}

void Bolts::to_numbers(const std::vector<BoltLink> &links, std::vector<std::int64_t> &counts,
                       std::vector<double> &numbers) {
  for (const BoltLink &link : links) {
    const auto &[a, b] = link.end;
    const LinkMemory &m = link.memory;
    counts.insert(counts.end(), {link.bolt, a.block, b.block, link.head_first ? 1 : 0, m.yielded ? 1 : 0,
                                 m.broken ? 1 : 0, link.liner, m.cracked ? 1 : 0});
    numbers.insert(numbers.end(), {a.point.x,        a.point.y,         a.along.x,
                                   a.along.y,        b.point.x,         b.point.y,
                                   b.along.x,        b.along.y,         link.length,
                                   link.bond_length, link.overhang[0],  link.overhang[1],
                                   m.axial_slip,     m.shear_slip,      m.dissipated,
                                   m.axial,          m.shear,           m.extension,
                                   m.slide,          m.turn_slip,       m.moment,
                                   m.turn,           link.grout[0],     link.grout[1],
                                   m.steel_slip,     m.grout_slip,      a.away,
                                   b.away,           m.largest.tension, m.largest.compression,
                                   m.largest.moment, m.largest.shear,   m.largest.strength_used});
  }
}

Bolts Bolts::from_numbers(std::span<const std::int64_t> counts, std::span<const double> numbers) {
  Bolts bolts;
  const std::size_t count = counts.size() / counts_per_link;
  if (counts.size() != count * counts_per_link || numbers.size() != count * numbers_per_link) {
    throw FileError("it is damaged: its bolts are not whole");
  }
  for (std::size_t k = 0; k < count; ++k) {
    const auto c = counts.subspan(k * counts_per_link, counts_per_link);
    const auto x = numbers.subspan(k * numbers_per_link, numbers_per_link);
    BoltLink &link = bolts.links_.emplace_back();
    link.bolt = static_cast<std::int32_t>(c[0]);
    link.end = {LinkEnd{c[1], {x[0], x[1]}, {x[2], x[3]}, x[26]},
                LinkEnd{c[2], {x[4], x[5]}, {x[6], x[7]}, x[27]}};
    link.head_first = c[3] != 0;
    link.length = x[8];
    link.bond_length = x[9];
    link.overhang = {x[10], x[11]};
    link.memory = {x[12],     x[13],     x[14],     x[15], x[16], x[17], x[18],
                   c[4] != 0, c[5] != 0, c[7] != 0, x[19], x[20], x[21]};
    link.memory.steel_slip = x[24];
    link.memory.grout_slip = x[25];
    link.memory.largest = {x[28], x[29], x[30], x[31], x[32]};
    link.grout = {x[22], x[23]};
    link.liner = static_cast<std::int32_t>(c[6]);
  }
  return bolts;
}

} // namespace gcpdda
