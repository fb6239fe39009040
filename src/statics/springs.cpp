#include "statics/springs.hpp"

#include "base/check.hpp"
#include "model/find_row.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

namespace gcpdda::statics {

namespace {

/// True while the boxes of two rows are within `reach` of each other.
bool are_near(const BlockSystem &system, const ContactSpring &spring, double reach) {
  return system.motion[spring.lower].box.inflated(reach).meets(system.motion[spring.higher].box);
}

/// The springs of a region for which all of k_t counts.
ContactSpring spring_of(const BlockSystem &system, const CandidatePair &pair, const RegionDetails &force,
                        const RegionState &memory, const LawConstants &law) {
  ContactSpring spring;
  const Vec2 tangent = perp(force.normal);
  const double length = force.extent_end - force.extent_begin;
  const Vec2 middle = force.point + 0.5 * (force.extent_begin + force.extent_end) * tangent;
  spring.lower = pair.lower.value;
  spring.higher = pair.higher.value;
  spring.normal = force.normal;
  spring.lower_arm = middle - system.motion[spring.lower].centroid;
  spring.higher_arm = middle - system.motion[spring.higher].centroid;
  const bool pulls_or_pushes = !force.bonded || force.normal_force != 0.0;
  spring.normal_stiffness = pulls_or_pushes ? 2.0 * law.half_stiffness * length : 0.0;
  spring.bending = spring.normal_stiffness * length * length / 12.0;
  spring.tangential = law.tangential_stiffness * memory.longest;
  spring.sticking = spring.tangential;
  spring.grip = dot(force.grip - middle, tangent);
  return spring;
}

/// The normal spring of a region whose slip opens its joint, and with it the tangential one.
void lean_to_slip(ContactSpring &spring, const RegionState &state, const JointLaw &law) {
  const double lean = state.shear < 0.0 ? law.tan_dilation : -law.tan_dilation;
  const double square = 1.0 + lean * lean;
  spring.normal = (1.0 / std::sqrt(square)) * (spring.normal + lean * perp(spring.normal));
  spring.normal_stiffness *= square;
}

/// Side and turns of a region that has been evaluated.
SpringMemory moved_on(SpringMemory memory, const RegionState &state, double cap, const SpringRules &rules) {
  memory.open_for = 0;
  memory.turned = static_cast<std::uint8_t>(memory.turned > 0 ? memory.turned - 1 : 0);
  if (state.state == ContactState::slip && cap > 0.0) {
    const std::int8_t side = state.shear < 0.0 ? -1 : 1;
    if (memory.side != 0 && memory.side != side) {
      memory.turned = rules.turn_memory;
    }
    memory.slid_for = static_cast<std::uint8_t>(
        memory.turned == 0 && rules.slides_fade ? std::min(memory.slid_for + 1, 255) : 0);
    memory.side = side;
  } else {
    memory.slid_for = 0;
  }
  return memory;
}

/// What is left after `count` evaluations of a share that fades to a floor.
double faded(double share, int count, double fade, double floor) {
  for (int k = 0; k < count && share > floor; ++k) {
    share *= fade;
  }
  return std::max(share, floor);
}

/// Of k_t, where a region slips.
double share_of_slipping(const SpringMemory &memory, const SpringRules &rules) {
  const double slid = faded(1.0, memory.slid_for - rules.slide_memory, rules.slide_fade, rules.slide_floor);
  return rules.slip_share *
         faded(slid, memory.slid_for - rules.long_slide, rules.long_slide_fade, rules.long_slide_floor);
}

bool is_before(const SpringMemory &a, const SpringMemory &b) {
  return std::tie(a.lower, a.higher) < std::tie(b.lower, b.higher);
}

} // namespace

SpringRules under_load(SpringRules rules) {
  rules.slides_fade = false;
  rules.turn_memory = static_cast<std::uint8_t>(rules.turn_memory / 2);
  return rules;
}

void ContactSprings::List::clear() {
  springs.clear();
  memories.clear();
}

void ContactSprings::List::push_back(const ContactSpring &spring, const SpringMemory &memory) {
  springs.push_back(spring);
  memories.push_back(memory);
}

void ContactSprings::clear() {
  at_work_.clear();
  before_.clear();
  moves_.clear();
  pairs_at_work_.clear();
  are_held_ = false;
}

void ContactSprings::keep_open(const BlockSystem &system, std::size_t number, const SpringRules &rules) {
  SpringMemory memory = at_work_.memories[number];
  if (memory.open_for >= rules.open_memory || !are_near(system, at_work_.springs[number], rules.reach)) {
    return;
  }
  ++memory.open_for;
  ContactSpring spring = at_work_.springs[number];
  spring.normal_stiffness *= rules.fade;
  spring.bending *= rules.fade;
  spring.tangential *= rules.fade;
  spring.sticking *= rules.fade;
  next_.push_back(spring, memory);
}

template <class F> void ContactSprings::for_pairs_at_work(const Candidates &candidates, F &&f) {
  const auto count = static_cast<std::uint32_t>(candidates.pairs.size());
  if (moves_.empty()) {
    for (std::uint32_t number = 0; number < count; ++number) {
      f(number);
    }
    return;
  }
  if (pairs_at_work_.empty()) {
    for (std::uint32_t number = 0; number < count; ++number) {
      const CandidatePair &pair = candidates.pairs[number];
      if (!both_rest(pair.lower.value, pair.higher.value)) {
        pairs_at_work_.push_back(number);
      }
    }
  }
  std::for_each(pairs_at_work_.begin(), pairs_at_work_.end(), f);
}

void ContactSprings::update(const BlockSystem &system, const Candidates &candidates,
                            const ContactHistory &history, const ContactForces &contacts,
                            const SpringRules &rules) {
  expect(contacts.keeps_details(), "the last evaluation has left its details behind");
  next_.clear();
  std::size_t old = 0;
  const std::vector<SpringMemory> &memories = at_work_.memories;
  const auto add = [&](std::uint32_t number, std::uint32_t k, const RegionDetails &force) {
    const CandidatePair &pair = candidates.pairs[number];
    SpringMemory key;
    key.lower = system.properties[pair.lower.value].id;
    key.higher = system.properties[pair.higher.value].id;
    for (; old < memories.size() && is_before(memories[old], key); ++old) {
      keep_open(system, old, rules);
    }
    const bool is_known = old < memories.size() && !is_before(key, memories[old]);
    const SpringMemory before = is_known ? memories[old] : key;
    const ContactSpring last = is_known ? at_work_.springs[old] : ContactSpring{};
    old += is_known ? 1 : 0;
    if (force.normal_undefined) {
      return;
    }
    const RegionState &state = history.state(number, k);
    const SpringMemory memory = moved_on(before, state, force.cap, rules);
    const std::int32_t law = state.law >= 0 ? state.law : pair.law;
    ContactSpring spring = spring_of(system, pair, force, state, contacts.parameters().constants(law));
    const JointLaw &strength = contacts.parameters().joints.strength(law);
    if (state.state == ContactState::slip && state.slip < strength.dilation_limit) {
      lean_to_slip(spring, state, strength);
    }
    if (state.state == ContactState::slip && memory.turned == 0) {
      spring.tangential *= share_of_slipping(memory, rules);
    }
    spring.normal_stiffness = std::max(spring.normal_stiffness, rules.fade * last.normal_stiffness);
    spring.bending = std::max(spring.bending, rules.fade * last.bending);
    if (before.open_for > 0) {
      spring.tangential = std::max(spring.tangential, rules.fade * last.tangential);
      spring.sticking = std::max(spring.sticking, spring.tangential);
    }
    next_.push_back(spring, memory);
  };
  for_pairs_at_work(candidates,
                    [&](std::uint32_t pair) { contacts.for_kept_details(candidates, history, pair, add); });
  for (; old < memories.size(); ++old) {
    keep_open(system, old, rules);
  }
  std::swap(at_work_, next_);
}

void ContactSprings::hold_slip() {
  for (std::vector<ContactSpring> *list : {&at_work_.springs, &links_}) {
    for (ContactSpring &spring : *list) {
      spring.tangential = spring.sticking;
    }
  }
  are_held_ = true;
}

template <class F> void ContactSprings::for_all(F &&f) const {
  std::size_t at_rest = 0;
  const auto pass_at_rest = [&](auto &&is_next) {
    for (; at_rest < before_.springs.size() && is_next(before_.memories[at_rest]); ++at_rest) {
      ContactSpring spring = before_.springs[at_rest];
      if (both_rest(spring.lower, spring.higher)) {
        spring.tangential = are_held_ ? spring.sticking : spring.tangential;
        f(spring, before_.memories[at_rest]);
      }
    }
  };
  for (std::size_t k = 0; k < at_work_.springs.size(); ++k) {
    const SpringMemory &memory = at_work_.memories[k];
    pass_at_rest([&](const SpringMemory &other) { return is_before(other, memory); });
    f(at_work_.springs[k], memory);
  }
  pass_at_rest([](const SpringMemory &) { return true; });
}

void ContactSprings::set_moving(std::vector<std::uint8_t> moves) {
  if (!moves_.empty()) {
    next_.clear();
    for_all(
        [&](const ContactSpring &spring, const SpringMemory &memory) { next_.push_back(spring, memory); });
    std::swap(at_work_, next_);
    before_.clear();
  }
  moves_ = std::move(moves);
  pairs_at_work_.clear();
  are_held_ = false;
  if (!moves_.empty()) {
    std::swap(before_, at_work_);
    at_work_.clear();
    for (std::size_t k = 0; k < before_.springs.size(); ++k) {
      if (!both_rest(before_.springs[k].lower, before_.springs[k].higher)) {
        at_work_.push_back(before_.springs[k], before_.memories[k]);
      }
    }
  }
}

std::vector<SpringRecord> ContactSprings::records() const {
  std::vector<SpringRecord> all;
  all.reserve(std::max(before_.springs.size(), at_work_.springs.size()));
  for_all([&](const ContactSpring &spring, const SpringMemory &memory) { all.push_back({spring, memory}); });
  return all;
}

void ContactSprings::take(const BlockSystem &system, std::vector<SpringRecord> records) {
  std::stable_sort(records.begin(), records.end(), [](const SpringRecord &a, const SpringRecord &b) {
    return is_before(a.memory, b.memory);
  });
  clear();
  for (SpringRecord &record : records) {
    const auto lower = find_row(system, record.memory.lower.value);
    const auto higher = find_row(system, record.memory.higher.value);
    if (!lower || !higher || (*lower >= system.num_owned && *higher >= system.num_owned)) {
      continue;
    }
    record.spring.lower = static_cast<std::uint32_t>(*lower);
    record.spring.higher = static_cast<std::uint32_t>(*higher);
    at_work_.push_back(record.spring, record.memory);
  }
}

} // namespace gcpdda::statics
