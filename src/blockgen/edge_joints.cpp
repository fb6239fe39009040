#include "blockgen/edge_joints.hpp"

#include <algorithm>
#include <cmath>

namespace gcpdda::blockgen {

EdgeJoints::EdgeJoints(std::span<const Trace> traces, const JointLaws &laws, const Aabb &box,
                       double tolerance)
    : traces_(traces), laws_(&laws), box_(box), tolerance_(tolerance) {
  // As many bins as traces: a few of these pass each bin, be they long and crossing or short.
  const double per_side = std::ceil(std::sqrt(static_cast<double>(traces.size())));
  num_columns_ = num_rows_ = static_cast<std::size_t>(std::clamp(per_side, 8.0, 512.0));
  width_ = box.extent().x / static_cast<double>(num_columns_);
  height_ = box.extent().y / static_cast<double>(num_rows_);
  bins_.resize(num_columns_ * num_rows_);
  for (std::size_t k = 0; k < traces.size(); ++k) {
    enter(k);
  }
}

std::int32_t EdgeJoints::of(Vec2 from, Vec2 to) const {
  const Vec2 middle = 0.5 * (from + to);
  std::int32_t joint = -1;
  for (const std::uint32_t k : bins_[row(middle.y) * num_columns_ + column(middle.x)]) {
    if (lies_on(from, traces_[k]) && lies_on(to, traces_[k])) {
      joint = laws_->of_edges(joint, traces_[k].joint, -1);
    }
  }
  return joint;
}

std::vector<std::uint32_t> EdgeJoints::at(Vec2 p) const {
  std::vector<std::uint32_t> found;
  for (const std::uint32_t k : bins_[row(p.y) * num_columns_ + column(p.x)]) {
    if (lies_on(p, traces_[k])) {
      found.push_back(k);
    }
  }
  return found;
}

// Into every bin it passes: column by column, with a margin for rounding.
void EdgeJoints::enter(std::size_t trace) {
  const Trace &t = traces_[trace];
  const Aabb own = t.box();
  if (!own.inflated(tolerance_).meets(box_)) {
    return;
  }
  const Vec2 along = t.to - t.from;
  const double margin = 1e-6 * (width_ + height_) + tolerance_;
  for (std::size_t c = column(own.low.x - margin); c <= column(own.high.x + margin); ++c) {
    const double left = box_.low.x + static_cast<double>(c) * width_ - margin;
    const double right = box_.low.x + static_cast<double>(c + 1) * width_ + margin;
    double low = own.low.y;
    double high = own.high.y;
    if (std::abs(along.x) > margin) {
      const double y0 = t.from.y + along.y * std::clamp((left - t.from.x) / along.x, 0.0, 1.0);
      const double y1 = t.from.y + along.y * std::clamp((right - t.from.x) / along.x, 0.0, 1.0);
      low = std::min(y0, y1);
      high = std::max(y0, y1);
    }
    if (high + margin < box_.low.y || low - margin > box_.high.y) {
      continue;
    }
    for (std::size_t r = row(low - margin); r <= row(high + margin); ++r) {
      bins_[r * num_columns_ + c].push_back(static_cast<std::uint32_t>(trace));
    }
  }
}

std::size_t EdgeJoints::column(double x) const {
  const double c = std::floor((x - box_.low.x) / width_);
  return static_cast<std::size_t>(std::clamp(c, 0.0, static_cast<double>(num_columns_ - 1)));
}

std::size_t EdgeJoints::row(double y) const {
  const double r = std::floor((y - box_.low.y) / height_);
  return static_cast<std::size_t>(std::clamp(r, 0.0, static_cast<double>(num_rows_ - 1)));
}

bool EdgeJoints::lies_on(Vec2 p, const Trace &trace) const {
  const Vec2 along = trace.to - trace.from;
  const double length = norm(along);
  const double across = cross(along, p - trace.from);
  const double at = dot(along, p - trace.from);
  return std::abs(across) <= tolerance_ * length && at >= -tolerance_ * length &&
         at <= (length + tolerance_) * length;
}

} // namespace gcpdda::blockgen
