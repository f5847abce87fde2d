// SPDX-License-Identifier: Apache-2.0
#include "ghosts/iris_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "aperture/iris_blades.h"

namespace contrejour::inline internal {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

void straight_distances(const IrisBound& bound, const float* x, const float* y, std::size_t count, float* out,
                        bool first) {
  const auto nx = static_cast<float>(bound.normal.x);
  const auto ny = static_cast<float>(bound.normal.y);
  const auto apothem = static_cast<float>(bound.apothem);
  for (std::size_t k = 0; k < count; ++k) {
    const float d = nx * x[k] + ny * y[k] - apothem;
    out[k] = first || d > out[k] ? d : out[k];
  }
}

// (|p - c|^2 - r^2) / (|p - c| + r): the centres of nearly straight edges are far away, and float would round the
// difference of distances.
void round_distances(const IrisBound& bound, const float* x, const float* y, std::size_t count, float* out,
                     bool first) {
  const auto cx = static_cast<float>(bound.centre.x);
  const auto cy = static_cast<float>(bound.centre.y);
  const auto radius = static_cast<float>(bound.radius);
  const auto at_axis = static_cast<float>(bound.power_at_axis());
  for (std::size_t k = 0; k < count; ++k) {
    const float dx = x[k] - cx;
    const float dy = y[k] - cy;
    const float power = x[k] * x[k] + y[k] * y[k] - 2.0F * (cx * x[k] + cy * y[k]) + at_axis;
    const float d = power / (std::sqrt(dx * dx + dy * dy) + radius);
    out[k] = first || d > out[k] ? d : out[k];
  }
}

}  // namespace

IrisShape::IrisShape(const Iris& iris) {
  if (iris.field) {
    field_ = iris.field;
    cosine_ = std::cos(iris.rotation_rad);
    sine_ = std::sin(iris.rotation_rad);
    for (const IrisBound& bound : iris.field->hull()) bounds_.push_back(in_stop(bound));
    return;
  }
  const IrisOpening opening(iris);
  for (const IrisBound& bound : iris_bounds(iris)) {
    const auto lies_on_it = [&](const IrisEdge& edge) { return edge.bound == bound; };
    if (std::any_of(opening.edges().begin(), opening.edges().end(), lies_on_it)) bounds_.push_back(bound);
  }
  is_circle_ = bounds_.size() == 1 && bounds_.front() == kIrisRim;
  if (bounds_.empty()) bounds_.push_back({{1.0, 0.0}, -kUnbounded, {}});  // closed: no point is on its inner side
}

IrisShape IrisShape::hull() const {
  IrisShape shape;
  shape.bounds_ = bounds_;
  shape.is_circle_ = is_circle_;
  return shape;
}

std::pair<std::array<IrisBound, 6>, std::size_t> IrisShape::half_planes_of(const IrisPiece& piece) const {
  std::array<IrisBound, 6> all{in_stop({{1.0, 0.0}, piece.high.x, {}}), in_stop({{-1.0, 0.0}, -piece.low.x, {}}),
                               in_stop({{0.0, 1.0}, piece.high.y, {}}), in_stop({{0.0, -1.0}, -piece.low.y, {}})};
  std::size_t count = 4;
  for (int c = 0; c < piece.cuts; ++c) all[count++] = in_stop(piece.cut[static_cast<std::size_t>(c)]);
  return {all, count};
}

void IrisShape::distances(const float* x, const float* y, std::size_t count, float* out) const {
  if (is_picture()) {
    for (std::size_t k = 0; k < count; ++k) out[k] = static_cast<float>(picture_distance({x[k], y[k]}));
    return;
  }
  if (is_circle()) {
    for (std::size_t k = 0; k < count; ++k) out[k] = std::sqrt(x[k] * x[k] + y[k] * y[k]) - 1.0F;
    return;
  }
  for (std::size_t b = 0; b < bounds_.size(); ++b) {
    const auto distances_to = bounds_[b].straight() ? straight_distances : round_distances;
    distances_to(bounds_[b], x, y, count, out, b == 0);
  }
}

}  // namespace contrejour::inline internal
