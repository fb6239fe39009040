#include "blockgen/dust_faces.hpp"

#include "geometry/polygon.hpp"

#include <algorithm>
#include <set>
#include <tuple>

namespace gcpdda::blockgen {

namespace {

struct LessPoint {
  bool operator()(Vec2 a, Vec2 b) const { return std::tie(a.x, a.y) < std::tie(b.x, b.y); }
};

/// Dust faces that touch each other.
struct Heap {
  std::vector<std::size_t> dust;
  std::set<std::size_t> around; ///< other faces with a vertex of the dust
  std::vector<Vec2> vertices;
  Vec2 point; ///< the vertex nearest to the middle
  Aabb box;
  bool is_certain = true;
  bool shrinks = true;
};

using HeapAt = std::map<Vec2, std::size_t, LessPoint>; ///< number of the heap by vertex

template <class Visit> void for_each_ring(const PlaneFace &shape, Visit &&visit) {
  visit(shape.outer);
  for (const Ring &hole : shape.holes) {
    visit(hole);
  }
}

std::vector<std::size_t> dust_among(const std::vector<RockFace> &faces, double largest) {
  std::vector<std::size_t> dust;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (faces[i].is_sliver && norm(faces[i].box.extent()) < largest) {
      dust.push_back(i);
    }
  }
  return dust;
}

/// @param at  the heap of each of their vertices
std::vector<Heap> heaps_of(const std::vector<RockFace> &faces, const std::vector<std::size_t> &dust,
                           HeapAt &at) {
  std::map<Vec2, std::vector<std::size_t>, LessPoint> dust_at;
  for (const std::size_t i : dust) {
    for_each_ring(faces[i].shape, [&](const Ring &ring) {
      for (const Vec2 p : ring) {
        dust_at[p].push_back(i);
      }
    });
  }
  std::vector<Heap> heaps;
  std::set<std::size_t> seen;
  for (const std::size_t first : dust) {
    if (!seen.insert(first).second) {
      continue;
    }
    Heap heap;
    std::vector<std::size_t> rest{first};
    while (!rest.empty()) {
      const std::size_t i = rest.back();
      rest.pop_back();
      heap.dust.push_back(i);
      heap.box.include(faces[i].box);
      heap.is_certain = heap.is_certain && faces[i].is_certain;
      for_each_ring(faces[i].shape, [&](const Ring &ring) {
        for (const Vec2 p : ring) {
          if (at.emplace(p, heaps.size()).second) {
            heap.vertices.push_back(p);
          }
          for (const std::size_t other : dust_at[p]) {
            if (seen.insert(other).second) {
              rest.push_back(other);
            }
          }
        }
      });
    }
    const Vec2 middle = 0.5 * (heap.box.low + heap.box.high);
    heap.point = *std::min_element(heap.vertices.begin(), heap.vertices.end(), [&](Vec2 a, Vec2 b) {
      return std::tuple(norm(a - middle), a.x, a.y) < std::tuple(norm(b - middle), b.x, b.y);
    });
    heaps.push_back(std::move(heap));
  }
  return heaps;
}

/// Which faces lie around each heap, and which heaps cannot shrink for these.
void look_around_heaps(const std::vector<RockFace> &faces, const HeapAt &at, std::vector<Heap> &heaps) {
  const EdgeMap edges(faces);
  std::vector<bool> is_dust(faces.size(), false);
  for (const Heap &heap : heaps) {
    for (const std::size_t i : heap.dust) {
      is_dust[i] = true;
    }
  }
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for_each_ring(faces[i].shape, [&](const Ring &ring) {
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const auto found = at.find(ring[k]);
        if (found == at.end()) {
          continue;
        }
        Heap &heap = heaps[found->second];
        const RockFace &first = faces[heap.dust.front()];
        const bool is_at_side = edges.face_of(ring[(k + 1) % ring.size()], ring[k]) < 0 ||
                                edges.face_of(ring[k], ring[(k + ring.size() - 1) % ring.size()]) < 0;
        const bool is_alike = faces[i].material == first.material && faces[i].opening == first.opening;
        heap.shrinks = heap.shrinks && is_alike && !is_at_side;
        heap.is_certain = heap.is_certain && faces[i].is_certain;
        if (!is_dust[i]) {
          heap.around.insert(i);
        }
      }
    });
  }
}

/// A ring with the vertices that `place` moves, each once.
template <class Place> Ring moved_ring(const Ring &ring, Place &&place) {
  Ring after;
  for (const Vec2 p : ring) {
    if (const Vec2 there = place(p); after.empty() || after.back() != there) {
      after.push_back(there);
    }
  }
  while (after.size() > 1 && after.back() == after.front()) {
    after.pop_back();
  }
  return after;
}

/// A face with moved vertices, without the holes that have shrunk to one.
template <class Place> PlaneFace moved_face(const PlaneFace &shape, Place &&place) {
  PlaneFace after{moved_ring(shape.outer, place), {}};
  for (const Ring &hole : shape.holes) {
    if (Ring ring = moved_ring(hole, place); ring.size() > 1) {
      after.holes.push_back(std::move(ring));
    }
  }
  return after;
}

/// A simple outline and simple holes; a sliver may also have become a line, which is none.
bool is_sound(const PlaneFace &shape, bool is_sliver) {
  if (is_sliver && shape.outer.size() == 2 && shape.holes.empty()) {
    return true;
  }
  bool sound = shape.outer.size() > 2 && signed_area(shape.outer) > 0.0;
  for_each_ring(shape, [&](const Ring &ring) { sound = sound && ring.size() > 2 && is_simple(ring); });
  return sound;
}

template <class Place> void note_edges(const Ring &ring, Place &&place, MovedEdges &moved) {
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 from = ring[k];
    const Vec2 to = ring[(k + 1) % ring.size()];
    if (place(from) != place(to) && (place(from) != from || place(to) != to)) {
      moved.add({place(from), place(to)}, {from, to});
    }
  }
}

/// A sliver that has become a line has no vertices after that.
template <class Place>
void move_face(const SliverSizes &sizes, Place &&place, RockFace &face, MovedEdges &moved) {
  PlaneFace after = moved_face(face.shape, place);
  if (after.outer.size() < 3) {
    face.shape.outer.clear();
    return;
  }
  for_each_ring(face.shape, [&](const Ring &ring) { note_edges(ring, place, moved); });
  face.shape = std::move(after);
  face.area = 0.0;
  for_each_ring(face.shape, [&](const Ring &ring) { face.area += signed_area(ring); });
  Ring &outer = face.shape.outer;
  std::rotate(outer.begin(), std::min_element(outer.begin(), outer.end(), LessPoint()), outer.end());
  face.box = bounding_box(outer);
  face.is_sliver = is_sliver(face, sizes);
}

template <class Place> bool keeps_sound(const Heap &heap, const std::vector<RockFace> &faces, Place &&place) {
  return std::all_of(heap.around.begin(), heap.around.end(), [&](std::size_t i) {
    return is_sound(moved_face(faces[i].shape, place), faces[i].is_sliver);
  });
}

/// What is near the end of what is seen may be larger, and touch what is not seen. Whether a heap shrinks
/// depends on the faces around it and on the heaps around these.
void doubt_near_the_unknown(std::vector<Heap> &heaps, std::vector<RockFace> &faces) {
  constexpr int rounds = 2;
  for (int round = 0; round < rounds; ++round) {
    for (Heap &heap : heaps) {
      heap.is_certain = heap.is_certain && std::all_of(heap.around.begin(), heap.around.end(),
                                                       [&](std::size_t i) { return faces[i].is_certain; });
    }
    for (Heap &heap : heaps) {
      if (!heap.is_certain) {
        heap.shrinks = false;
        for (const auto &i : heap.dust) {
          faces[i].is_certain = false;
        }
        for (const std::size_t i : heap.around) {
          faces[i].is_certain = false;
        }
      }
    }
  }
}

} // namespace

bool MovedEdges::Less::operator()(const Edge &a, const Edge &b) const {
  return std::tie(a.first.x, a.first.y, a.second.x, a.second.y) <
         std::tie(b.first.x, b.first.y, b.second.x, b.second.y);
}

void shrink_dust(const SliverSizes &sizes, std::vector<RockFace> &faces, MovedEdges &moved) {
  constexpr double dust_share = 0.1;
  const double largest = dust_share * sizes.min_width;
  const std::vector<std::size_t> dust = dust_among(faces, largest);
  if (dust.empty()) {
    return;
  }
  HeapAt at;
  std::vector<Heap> heaps = heaps_of(faces, dust, at);
  look_around_heaps(faces, at, heaps);
  for (Heap &heap : heaps) {
    heap.shrinks = heap.shrinks && norm(heap.box.extent()) < largest;
  }
  doubt_near_the_unknown(heaps, faces);
  for (std::size_t h = 0; h < heaps.size(); ++h) {
    const auto to_point = [&](Vec2 p) {
      const auto found = at.find(p);
      return found != at.end() && found->second == h ? heaps[h].point : p;
    };
    heaps[h].shrinks = heaps[h].shrinks && keeps_sound(heaps[h], faces, to_point);
  }
  const auto place = [&](Vec2 p) {
    const auto found = at.find(p);
    return found != at.end() && heaps[found->second].shrinks ? heaps[found->second].point : p;
  };
  std::vector<bool> keep_sound(heaps.size()); // all together
  std::transform(heaps.begin(), heaps.end(), keep_sound.begin(),
                 [&](const Heap &heap) { return heap.shrinks && keeps_sound(heap, faces, place); });
  for (std::size_t h = 0; h < heaps.size(); ++h) {
    heaps[h].shrinks = keep_sound[h];
  }
  std::set<std::size_t> changed;
  for (const Heap &heap : heaps) {
    if (heap.shrinks) {
      changed.insert(heap.around.begin(), heap.around.end());
      for (const std::size_t i : heap.dust) {
        faces[i].shape.outer.clear(); // gone
      }
    }
  }
  for (const std::size_t i : changed) {
    move_face(sizes, place, faces[i], moved);
  }
  std::erase_if(faces, [](const RockFace &face) { return face.shape.outer.empty(); });
}

} // namespace gcpdda::blockgen
