#include "blockgen/face_merger.hpp"

#include "blockgen/quality.hpp"
#include "model/fingerprint.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <numeric>
#include <tuple>

namespace gcpdda::blockgen {

namespace {

template <class Visit> void for_each_edge(const PlaneFace &shape, Visit &&visit) {
  const auto go_round = [&](const Ring &ring) {
    for (std::size_t k = 0; k < ring.size(); ++k) {
      visit(ring[k], ring[(k + 1) % ring.size()]);
    }
  };
  go_round(shape.outer);
  for (const Ring &hole : shape.holes) {
    go_round(hole);
  }
}

/// Where a sliver goes: -1 if it stays.
struct Choice {
  std::int64_t face = -1;
  bool is_certain = true;
};

Choice choose(const std::vector<RockFace> &faces, const EdgeMap &edges, std::size_t sliver) {
  const RockFace &own = faces[sliver];
  std::map<std::int64_t, double> shared; // a handful of neighbours
  Choice choice{-1, own.is_certain};
  for_each_edge(own.shape, [&](Vec2 from, Vec2 to) {
    const std::int64_t other = edges.face_of(to, from);
    if (other < 0) {
      return;
    }
    const RockFace &neighbour = faces[static_cast<std::size_t>(other)];
    choice.is_certain = choice.is_certain && neighbour.is_certain;
    if (neighbour.material == own.material && neighbour.opening == own.opening) {
      shared[other] += norm(to - from);
    }
  });
  double longest = 0.0;
  for (const auto &[other, length] : shared) {
    const Vec2 corner = faces[static_cast<std::size_t>(other)].corner();
    const bool wins_tie = length == longest && choice.face >= 0 &&
                          std::tie(corner.x, corner.y) <
                              std::tie(faces[static_cast<std::size_t>(choice.face)].shape.outer[0].x,
                                       faces[static_cast<std::size_t>(choice.face)].shape.outer[0].y);
    if (length > longest || wins_tie) {
      longest = length;
      choice.face = other;
    }
  }
  return choice;
}

/// Smallest face of each group of faces that become one.
class Groups {
public:
  explicit Groups(std::size_t n) : leader_(n) { std::iota(leader_.begin(), leader_.end(), std::size_t{0}); }
  std::size_t of(std::size_t i) {
    while (leader_[i] != i) {
      leader_[i] = leader_[leader_[i]];
      i = leader_[i];
    }
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    a = of(a);
    b = of(b);
    leader_[std::max(a, b)] = std::min(a, b);
  }

private:
  std::vector<std::size_t> leader_;
};

using Members = std::map<std::size_t, std::vector<std::size_t>>; ///< faces of a group by its smallest

void unite(const PlanarGraph &graph, const SliverSizes &sizes, const Members &members,
           std::vector<RockFace> &faces) {
  for (const auto &[leader, group] : members) {
    std::vector<const PlaneFace *> shapes;
    RockFace one = faces[leader];
    for (const std::size_t i : group) {
      shapes.push_back(&faces[i].shape);
      one.is_certain = one.is_certain && faces[i].is_certain;
      one.box.include(faces[i].box);
      one.area += i == leader ? 0.0 : faces[i].area;
    }
    one.shape = graph.unite(shapes);
    one.is_sliver = is_sliver(one, sizes);
    for (const std::size_t i : group) {
      faces[i].shape.outer.clear(); // gone
    }
    faces[leader] = std::move(one);
  }
  std::erase_if(faces, [](const RockFace &face) { return face.shape.outer.empty(); });
}

bool merge_once(const PlanarGraph &graph, const SliverSizes &sizes, std::vector<RockFace> &faces) {
  const EdgeMap edges(faces);
  Groups groups(faces.size());
  std::vector<bool> joins(faces.size(), false);
  std::vector<bool> is_certain(faces.size());
  std::transform(faces.begin(), faces.end(), is_certain.begin(),
                 [](const RockFace &f) { return f.is_certain; });
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (!faces[i].is_sliver) {
      continue;
    }
    const Choice choice = choose(faces, edges, i);
    if (!choice.is_certain) { // whoever may get it does not know
      is_certain[i] = false;
      for_each_edge(faces[i].shape, [&](Vec2 from, Vec2 to) {
        if (const std::int64_t other = edges.face_of(to, from); other >= 0) {
          is_certain[static_cast<std::size_t>(other)] = false;
        }
      });
    }
    if (choice.face >= 0) {
      const auto other = static_cast<std::size_t>(choice.face);
      groups.join(i, other);
      joins[i] = joins[other] = true;
    }
  }
  Members members;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    faces[i].is_certain = is_certain[i];
    if (joins[i]) {
      members[groups.of(i)].push_back(i);
    }
  }
  unite(graph, sizes, members, faces);
  return !members.empty();
}

} // namespace

std::size_t EdgeMap::Hash::operator()(const Edge &edge) const {
  std::uint64_t key = 0;
  for (const double x : {edge.from.x, edge.from.y, edge.to.x, edge.to.y}) {
    key = scattered(key ^ std::bit_cast<std::uint64_t>(x + 0.0)); // -0 is 0
  }
  return static_cast<std::size_t>(key);
}

EdgeMap::EdgeMap(const std::vector<RockFace> &faces) {
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for_each_edge(faces[i].shape, [&](Vec2 from, Vec2 to) {
      faces_.emplace(Edge{from, to}, static_cast<std::int64_t>(i));
    });
  }
}

std::int64_t EdgeMap::face_of(Vec2 from, Vec2 to) const {
  const auto found = faces_.find(Edge{from, to});
  return found == faces_.end() ? -1 : found->second;
}

bool is_sliver(const RockFace &face, const SliverSizes &sizes) {
  return face.area < sizes.min_area || mean_width(face.area, face.shape.outer) < sizes.min_width;
}

void merge_slivers(const PlanarGraph &graph, const SliverSizes &sizes, std::vector<RockFace> &faces) {
  constexpr int most_rounds = 3;
  for (int round = 0; round < most_rounds; ++round) {
    if (!merge_once(graph, sizes, faces)) {
      return;
    }
  }
}

} // namespace gcpdda::blockgen
