#include "blockgen/dust_faces.hpp"

#include "geometry/polygon.hpp"

#include <algorithm>
#include <iterator>
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

void doubt_faces_of(const Heap &heap, std::vector<RockFace> &faces) {
  for (const std::size_t i : heap.dust) {
    faces[i].is_certain = false;
  }
  for (const std::size_t i : heap.around) {
    faces[i].is_certain = false;
  }
}

/// What is near the end of what is seen may be larger, and touch what is not seen. A heap there is doubtful,
/// and so are the heaps that share a face with it. Of these second ones what they are is known, but not
/// whether they shrink.
void doubt_near_the_unknown(std::vector<Heap> &heaps, std::vector<RockFace> &faces) {
  constexpr int rounds = 2;
  for (int round = 0; round < rounds; ++round) {
    for (Heap &heap : heaps) {
      heap.is_certain = heap.is_certain && std::all_of(heap.around.begin(), heap.around.end(),
                                                       [&](std::size_t i) { return faces[i].is_certain; });
    }
    for (const Heap &heap : heaps) {
      if (!heap.is_certain) {
        doubt_faces_of(heap, faces);
      }
    }
  }
}

/// Heaps that shrink together: a face between several of them may cross itself though it would not with any
/// one of them. The heaps around such a face stay, which may be too much for the next face, until all faces
/// are sound.
class JointShrinking {
public:
  JointShrinking(const HeapAt &at, std::vector<Heap> &heaps, std::vector<RockFace> &faces)
      : at_(&at), heaps_(&heaps), faces_(&faces) {}

  void keep_faces_sound() {
    bool changes = true;
    while (changes) {
      std::vector<Outcome> outcomes; // all of them by what shrinks before any is taken
      for (const Heap &heap : *heaps_) {
        outcomes.push_back(heap.shrinks && heap.is_certain ? outcome_of(heap) : Outcome::sound);
      }
      changes = false;
      for (std::size_t h = 0; h < outcomes.size(); ++h) {
        Heap &heap = (*heaps_)[h];
        heap.shrinks = heap.shrinks && outcomes[h] != Outcome::unsound;
        heap.is_certain = heap.is_certain && outcomes[h] != Outcome::unknown;
        changes = changes || outcomes[h] != Outcome::sound;
        if (outcomes[h] == Outcome::unknown) {
          doubt_faces_of(heap, *faces_);
        }
      }
    }
  }

private:
  enum class Outcome { sound, unknown, unsound };

  [[nodiscard]] Outcome outcome_of(const Heap &heap) const {
    Outcome worst = Outcome::sound;
    for (const std::size_t i : heap.around) {
      worst = std::max(worst, outcome_of((*faces_)[i]));
    }
    return worst;
  }

  /// Unknown where it depends on which of the doubtful heaps shrink.
  [[nodiscard]] Outcome outcome_of(const RockFace &face) const {
    constexpr std::size_t most_doubtful = 4; // all of their choices are tried
    const std::vector<std::size_t> doubtful = doubtful_around(face);
    if (doubtful.size() > most_doubtful) {
      return Outcome::unknown;
    }
    const std::size_t num_choices = std::size_t{1} << doubtful.size();
    std::size_t num_sound = 0;
    for (std::size_t choice = 0; choice < num_choices; ++choice) {
      const auto place = [&](Vec2 p) {
        const auto found = at_->find(p);
        if (found == at_->end() || !(*heaps_)[found->second].shrinks) {
          return p;
        }
        const auto k = std::find(doubtful.begin(), doubtful.end(), found->second) - doubtful.begin();
        const bool stays = k < std::ssize(doubtful) && (choice >> k) % 2 == 0;
        return stays ? p : (*heaps_)[found->second].point;
      };
      num_sound += is_sound(moved_face(face.shape, place), face.is_sliver) ? 1 : 0;
    }
    return num_sound == num_choices ? Outcome::sound : num_sound == 0 ? Outcome::unsound : Outcome::unknown;
  }

  [[nodiscard]] std::vector<std::size_t> doubtful_around(const RockFace &face) const {
    std::set<std::size_t> doubtful;
    for_each_ring(face.shape, [&](const Ring &ring) {
      for (const Vec2 p : ring) {
        const auto found = at_->find(p);
        if (found != at_->end() && (*heaps_)[found->second].shrinks && !(*heaps_)[found->second].is_certain) {
          doubtful.insert(found->second);
        }
      }
    });
    return {doubtful.begin(), doubtful.end()};
  }

  const HeapAt *at_;
  std::vector<Heap> *heaps_;
  std::vector<RockFace> *faces_;
};

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
  JointShrinking(at, heaps, faces).keep_faces_sound();
  for (Heap &heap : heaps) {
    heap.shrinks = heap.shrinks && heap.is_certain; // else more has to be seen first
  }
  const auto place = [&](Vec2 p) {
    const auto found = at.find(p);
    return found != at.end() && heaps[found->second].shrinks ? heaps[found->second].point : p;
  };
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
