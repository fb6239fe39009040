#include "gcpdda/model/fingerprint.hpp"

#include <initializer_list>

namespace gcpdda {

namespace {

/// A chain in which the order counts.
class Chain {
public:
  explicit Chain(std::uint64_t start) : value_(scattered(start)) {}
  void add(std::uint64_t x) { value_ = scattered(value_ ^ x); }
  void add(std::initializer_list<double> values) {
    for (const double x : values) {
      add(std::bit_cast<std::uint64_t>(x));
    }
  }
  void add(Vec2 x) { add({x.x, x.y}); }
  void add(const std::array<double, 3> &x) { add({x[0], x[1], x[2]}); }
  /// How many there are, then each of them.
  template <class T> void add(const std::vector<T> &values) {
    add(std::uint64_t{values.size()});
    for (const T &value : values) {
      add(value);
    }
  }
  void add(const VelocityRow &row) {
    add({row.time});
    add(row.velocity);
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

private:
  std::uint64_t value_;
};

} // namespace

std::uint64_t fingerprint(std::int64_t id, const SceneBlock &block) {
  Chain chain(static_cast<std::uint64_t>(id));
  chain.add(static_cast<std::uint64_t>(block.material));
  chain.add(std::uint64_t{block.fixed});
  chain.add(std::uint64_t{block.driven});
  chain.add(block.vertices);
  for (const std::int32_t joint : block.edge_joint) {
    chain.add(static_cast<std::uint64_t>(joint));
  }
  chain.add(block.velocity);
  chain.add(block.velocity_table);
  chain.add(block.fixed_points);
  return chain.value();
}

std::uint64_t fingerprint(std::span<const Material> materials) {
  Chain chain(materials.size());
  for (const Material &material : materials) {
    chain.add({material.density, material.youngs_modulus, material.poissons_ratio});
  }
  return chain.value();
}

} // namespace gcpdda
