// SPDX-License-Identifier: Apache-2.0
#include "render/tiled/tile_traversal.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/tiled/tile_traversal.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/inline_if_fast.h"
#include "optics/surface/packet-inl.h"
// Must follow packet-inl.h, whose functions its templates use.
#include "render/tiled/barycentric-inl.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::tiled::HWY_NAMESPACE {

namespace hk = kernels::HWY_NAMESPACE;
namespace hn = hwy::HWY_NAMESPACE;
using P = hk::Packet<float>;
using Mask = P::Mask;

constexpr std::size_t kAhead = 4;  // primitives to prefetch

HWY_INLINE P broadcast(float value) { return P(hn::Set(P::Tag(), value)); }

HWY_INLINE P interpolate(const hk::Weights<P>& weights, const std::array<float, 4>& corner) {
  const P values[4] = {broadcast(corner[0]), broadcast(corner[1]), broadcast(corner[2]), broadcast(corner[3])};
  return hk::weighted_sum(weights, values);
}

// Tests one pixel at a time, since a picture is a look-up in memory.
HWY_INLINE Mask passes_picture(const IrisShape& iris, P x, P y) {
  const P::Tag d;
  HWY_ALIGN std::array<float, HWY_MAX_BYTES / sizeof(float)> at_x, at_y, distance;
  hn::Store(x.v, d, at_x.data());
  hn::Store(y.v, d, at_y.data());
  iris.distances(at_x.data(), at_y.data(), hn::Lanes(d), distance.data());
  return hn::Le(hn::Load(d, distance.data()), hn::Zero(d));
}

// Whether points lie inside the iris's opening. Coordinates are too large by the factor `total`.
HWY_INLINE Mask passes(const IrisShape& iris, P x, P y, P total) {
  if (iris.is_circle()) return hn::Le((x * x + y * y).v, (total * total).v);
  if (iris.is_picture()) return passes_picture(iris, x / total, y / total);
  Mask inside = hn::FirstN(P::Tag(), hn::Lanes(P::Tag()));
  for (const IrisBound& bound : iris.bounds()) {
    if (bound.straight()) {
      const P along =
          x * broadcast(static_cast<float>(bound.normal.x)) + y * broadcast(static_cast<float>(bound.normal.y));
      inside = hn::And(inside, hn::Le(along.v, (total * broadcast(static_cast<float>(bound.apothem))).v));
    } else {
      // p - c|^2 <= r^2, multiplied out: with a far centre the difference would lose its digits.
      const P along =
          x * broadcast(static_cast<float>(bound.centre.x)) + y * broadcast(static_cast<float>(bound.centre.y));
      const P power = x * x + y * y +
                      total * (total * broadcast(static_cast<float>(bound.power_at_axis())) - broadcast(2.0F) * along);
      inside = hn::And(inside, hn::Le(power.v, hn::Zero(P::Tag())));
    }
  }
  return inside;
}

// Which pixels no rim and no crossing of the iris blocks.
CONTREJOUR_INLINE_IF_FAST Mask unblocked(const TraversalInput& input, const Primitive& p,
                                         const hk::Weights<P>& weights) {
  Mask open = hn::Le(interpolate(weights, p.relative_height).v, weights.total.v);
  if (p.crossings == 0) return open;
  open =
      hn::And(open, passes(input.iris, interpolate(weights, p.stop_x), interpolate(weights, p.stop_y), weights.total));
  for (std::uint32_t c = 0; c + 1 < p.crossings; ++c) {
    const StopPoints& points = input.buffer.more_crossings[p.more_crossings + c];
    open = hn::And(open,
                   passes(input.iris, interpolate(weights, points.x), interpolate(weights, points.y), weights.total));
  }
  return open;
}

HWY_INLINE StopPoints points_of(const TraversalInput& input, const Primitive& p, std::size_t crossing) {
  return crossing == 0 ? StopPoints{p.stop_x, p.stop_y} : input.buffer.more_crossings[p.more_crossings + crossing - 1];
}

// A pixel's width in the units of a crossing, from the ratio of areas.
HWY_INLINE double pixel_at_stop(const Primitive& p, const StopPoints& points) {
  const auto area = [](const std::array<float, 4>& x, const std::array<float, 4>& y) {
    return 0.5 * std::abs(cross(Vec2{x[2], y[2]} - Vec2{x[0], y[0]}, Vec2{x[3], y[3]} - Vec2{x[1], y[1]}));
  };
  return std::sqrt(area(points.x, points.y) / std::max(area(p.x, p.y), 1.0));
}

// Multiplies each pixel's value by what the stop pattern and dirt transmit where its light crosses the stop and, if
// dirt lies there, the front: one pixel at a time.
CONTREJOUR_INLINE_IF_FAST P behind_stop(const TraversalInput& input, const Primitive& p, const StopTransmittance& stop,
                                        const hk::Weights<P>& weights, Mask inside, P value) {
  const P::Tag d;
  constexpr std::size_t kLanes = HWY_MAX_BYTES / sizeof(float), kPlanes = kMaxStopCrossings + 1;
  HWY_ALIGN std::array<float, kLanes> wanted, out;
  HWY_ALIGN std::array<std::array<float, kLanes>, kPlanes> x, y;
  std::array<StopPoint, kPlanes> points;
  const auto look_up = [&](std::size_t plane, const StopPoints& corners, double unit) {
    hn::Store((interpolate(weights, corners.x) / weights.total).v, d, x[plane].data());
    hn::Store((interpolate(weights, corners.y) / weights.total).v, d, y[plane].data());
    points[plane].width = pixel_at_stop(p, corners) * unit;
  };
  const bool on_front = stop.has_front();
  const double outer = stop.outer_radius();
  for (std::size_t c = 0; c < p.crossings; ++c) look_up(c, points_of(input, p, c), outer);
  if (on_front) look_up(p.crossings, input.buffer.more_crossings[p.more_crossings + p.more_points() - 1], 1.0);
  const double to_mm = stop.dirt && !on_front ? stop.dirt->site().stop_radius_mm : 1.0;
  hn::Store(hn::IfThenElseZero(inside, hn::Set(d, 1.0F)), d, wanted.data());
  hn::Store(value.v, d, out.data());
  for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
    if (!(wanted[k] > 0.0F)) continue;
    for (std::size_t c = 0; c < p.crossings; ++c) points[c].at = Vec2{x[c][k], y[c][k]} * outer;
    if (on_front) points[p.crossings].at = Vec2{x[p.crossings][k], y[p.crossings][k]};
    if (stop.pattern) out[k] *= static_cast<float>(stop.pattern->transmittance({points.data(), p.crossings}));
    float left = 1.0F;
    for (std::size_t c = 0; stop.dirt && c < stop.dirt_crossings(p.crossings); ++c) {
      const StopPoint& point = points[on_front ? p.crossings : c];
      left *= static_cast<float>(stop.dirt->transmission({point.at * to_mm, point.width * to_mm}, c));
    }
    out[k] *= left;
  }
  return P(hn::Load(d, out.data()));
}

// An edge includes the points on it if it runs upwards, or horizontally to the left, so that a shared edge belongs to
// exactly one of two neighbours.
HWY_INLINE float min_on_edge(const Primitive& p, std::size_t i) {
  const std::size_t j = (i + 1) % 4;
  const bool holds = p.y[j] < p.y[i] || (p.y[j] == p.y[i] && p.x[j] <= p.x[i]);
  return holds ? 0.0F : std::numeric_limits<float>::min();
}

template <template <class> class Method>
CONTREJOUR_INLINE_IF_FAST void add_primitive(const TraversalInput& input, const Primitive& p, TilePixels& tile) {
  const P::Tag d;
  const std::size_t lanes = hn::Lanes(d);
  const int width = tile.pixels.x1 - tile.pixels.x0 + 1;
  const int first = std::max(p.pixels.y0, tile.pixels.y0) - tile.pixels.y0;
  const int last = std::min(p.pixels.y1, tile.pixels.y1) - tile.pixels.y0;
  const auto begin = static_cast<std::size_t>(first * width);
  const auto end = static_cast<std::size_t>((last + 1) * width);

  hk::Quad<P> quad;
  for (std::size_t i = 0; i < 4; ++i) {
    quad.x[i] = broadcast(p.x[i]);
    quad.y[i] = broadcast(p.y[i]);
  }
  const P smallest[4] = {broadcast(min_on_edge(p, 0)), broadcast(min_on_edge(p, 1)), broadcast(min_on_edge(p, 2)),
                         broadcast(min_on_edge(p, 3))};
  const P left = broadcast(static_cast<float>(p.pixels.x0));
  const P right = broadcast(static_cast<float>(p.pixels.x1) + 1.0F);
  const Method<P> method(quad);
  const Gain& gain = input.gains[p.pass];
  const StopTransmittance* const stop = input.stops.empty() ? nullptr : &input.stops[p.pass];
  for (std::size_t k = begin; k < end; k += lanes) {
    const P x(hn::LoadU(d, tile.x.data() + k));
    const P y(hn::LoadU(d, tile.y.data() + k));
    const auto relative = hk::relative_to(quad, x, y);
    Mask inside = hn::And(hn::FirstN(d, end - k), hn::And(hn::Gt(x.v, left.v), hn::Lt(x.v, right.v)));
    for (int i = 0; i < 4; ++i) inside = hn::And(inside, hn::Ge(relative.edge[i].v, smallest[i].v));
    if (hn::AllFalse(d, inside)) continue;

    const hk::Weights<P> weights = method.at(relative);
    inside = hn::And(inside, hn::Gt(weights.total.v, hn::Zero(d)));
    P value = interpolate(weights, p.irradiance) / weights.total;
    if (stop != nullptr && stop->pattern) {
      inside = hn::And(inside, hn::Le(interpolate(weights, p.relative_height).v, weights.total.v));
    } else if ((p.flags & kOpen) == 0) {
      inside = hn::And(inside, unblocked(input, p, weights));
    }
    if (stop != nullptr && (stop->pattern || stop->dirt)) value = behind_stop(input, p, *stop, weights, inside, value);
    const auto lit = hn::IfThenElseZero(inside, value.v);
    for (std::size_t c = 0; c < 3; ++c) {
      float* out = tile.value[c].data() + k;
      hn::StoreU(hn::MulAdd(lit, hn::Set(d, gain[c]), hn::LoadU(d, out)), d, out);
    }
  }
}

template <template <class> class QuadMethod, template <class> class TriangleMethod>
void traverse_by(const TraversalInput& input, std::span<const std::uint32_t> list, TilePixels& tile) {
  const std::vector<Primitive>& primitives = input.buffer.primitives;
  for (std::size_t k = 0; k < list.size(); ++k) {
    if (k + kAhead < list.size()) {
      const Primitive* next = &primitives[list[k + kAhead]];
      hwy::Prefetch(&next->x);
      hwy::Prefetch(&next->stop_x);
    }
    const Primitive& p = primitives[list[k]];
    if ((p.flags & kTriangle) != 0) {
      add_primitive<TriangleMethod>(input, p, tile);
    } else {
      add_primitive<QuadMethod>(input, p, tile);
    }
  }
}

void traverse(const TraversalInput& input, std::span<const std::uint32_t> list, TilePixels& tile) {
  using Interpolation = TiledOptions::Interpolation;
  switch (input.interpolation) {
    case Interpolation::Triangle: return traverse_by<hk::TriangleByMatrix, hk::TriangleByMatrix>(input, list, tile);
    case Interpolation::HomogeneousTriangle:
      return traverse_by<hk::TriangleByCrossProduct, hk::TriangleByCrossProduct>(input, list, tile);
    case Interpolation::MeanValue: return traverse_by<hk::MeanValue, hk::TriangleByCrossProduct>(input, list, tile);
    case Interpolation::Wachspress: return traverse_by<hk::Wachspress, hk::TriangleByCrossProduct>(input, list, tile);
    case Interpolation::LoopDeRose: return traverse_by<hk::LoopDeRose, hk::TriangleByCrossProduct>(input, list, tile);
  }
}

}  // namespace contrejour::inline internal::tiled::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace contrejour::inline internal::tiled {

HWY_EXPORT(traverse);

// The number of floats in the longest vector of any instruction set. HWY_MAX_BYTES is that of one set, here the
// smallest.
constexpr std::size_t kLongestVector = 64;

void TilePixels::load(const Image& image, const PixelRange& range) {
  pixels = range;
  const std::size_t width = static_cast<std::size_t>(range.x1 - range.x0 + 1);
  const std::size_t count = width * static_cast<std::size_t>(range.y1 - range.y0 + 1);
  for (auto* v : {&x, &y, &value[0], &value[1], &value[2]}) v->resize(count + kLongestVector);
  std::size_t k = 0;
  for (int row = range.y0; row <= range.y1; ++row) {
    const float* from = image.pixels.data() + image.index(range.x0, row);
    for (int column = range.x0; column <= range.x1; ++column, ++k) {
      x[k] = static_cast<float>(column) + 0.5F;
      y[k] = static_cast<float>(row) + 0.5F;
      for (std::size_t c = 0; c < 3; ++c) value[c][k] = *from++;
    }
  }
}

void TilePixels::store(Image& image) const {
  std::size_t k = 0;
  for (int row = pixels.y0; row <= pixels.y1; ++row) {
    float* to = image.pixels.data() + image.index(pixels.x0, row);
    for (int column = pixels.x0; column <= pixels.x1; ++column, ++k) {
      for (std::size_t c = 0; c < 3; ++c) *to++ = value[c][k];
    }
  }
}

void traverse_tile(const TraversalInput& input, std::span<const std::uint32_t> list, TilePixels& tile) {
  HWY_DYNAMIC_DISPATCH(traverse)(input, list, tile);
}

}  // namespace contrejour::inline internal::tiled
#endif  // HWY_ONCE
