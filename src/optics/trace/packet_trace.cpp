// SPDX-License-Identifier: Apache-2.0
#include "optics/trace/packet_trace.h"

#include <algorithm>
#include <array>
#include <limits>

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "optics/trace/packet_trace.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/inline_if_fast.h"
#include "optics/surface/packet-inl.h"
#include "optics/trace/meeting-inl.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::HWY_NAMESPACE {

namespace hk = kernels::HWY_NAMESPACE;
namespace hn = hwy::HWY_NAMESPACE;

// As in trace.cpp: a ray beyond the equator of a sphere has left the glass; squared.
constexpr double kBeyondEquatorSquared = 4.0;

template <class P>
struct PacketState {
  hk::Ray3<P> ray;
  P transmission;
  P relative_height_squared;
  P alive;  // 1 or 0
};

template <class P>
HWY_INLINE void pass_stop(PacketState<P>& s, const PacketStep& step, double inverse_radius, std::size_t at,
                          const TracedArrays& out) {
  const P scale(inverse_radius);
  store_floats(s.ray.x * scale, out.stop_x[static_cast<std::size_t>(step.crossing)] + at);
  store_floats(s.ray.y * scale, out.stop_y[static_cast<std::size_t>(step.crossing)] + at);
}

// Multiplies the transmission by the internal transmittance of the path from the point whose z was from_z in the
// preceding step's coordinates.
template <class P>
HWY_INLINE void absorb(PacketState<P>& s, const PacketStep& step, P from_z) {
  const P distance = (s.ray.z + P(step.gap_mm) - from_z) / s.ray.dz;
  s.transmission = s.transmission * exponential(distance * P(-step.absorption_per_mm));
}

// As in trace.cpp.
template <class P>
HWY_INLINE void deflect_by_grating(PacketState<P>& s, const PacketStep& step) {
  const P zero(0.0);
  s.transmission = s.transmission * P(step.efficiency);
  s.ray.dx = s.ray.dx + P(step.grating_shift.x);
  s.ray.dy = s.ray.dy + P(step.grating_shift.y);
  const P along_squared = P(1.0) - s.ray.dx * s.ray.dx - s.ray.dy * s.ray.dy;
  s.alive = or_zero(along_squared > zero, s.alive);
  const P along = square_root(larger(along_squared, zero));
  s.ray.dz = select(s.ray.dz > zero, along, zero - along);
}

// Takes one packet across one surface. Rays that fail continue with meaningless numbers and alive = 0.
template <PathGeometry kGeometry, class P>
CONTREJOUR_INLINE_IF_FAST void advance(PacketState<P>& s, const PacketStep& step, const float* tables,
                                       float* rim_squared) {
  const P zero(0.0);
  const P one(1.0);
  const P direction(step.direction);
  hk::SurfaceFramePoint<P> own;
  const P from_z = s.ray.z;
  const auto hit = meet<kGeometry>(s.ray, step, own);
  s.alive = or_zero(hit.cos_in_squared > zero, s.alive);
  if constexpr (kGeometry == PathGeometry::General) {
    if (step.absorption_per_mm != 0.0) absorb(s, step, from_z);
  }
  if (step.event == PathEvent::Stop) return;

  P r_squared;
  if constexpr (kGeometry == PathGeometry::General) {
    const auto point = rim_point(own, step.rim);
    r_squared = point.x * point.x + point.y * point.y;
  } else {
    r_squared = (own.x * own.x + own.y * own.y) * P(step.inverse_semi_diameter_squared);
  }
  const P beyond = select(own.nz > zero, zero, P(kBeyondEquatorSquared));
  P out_squared = larger(r_squared, beyond);
  P height_squared = out_squared;
  if constexpr (kGeometry == PathGeometry::General) {
    if (step.blocks_within) {
      out_squared = select(own.nz > zero, P(2.0) - r_squared, P(kBeyondEquatorSquared));
      const P height = larger(P(2.0) - square_root(r_squared), zero);
      height_squared = larger(height * height, beyond);
    }
  }
  s.relative_height_squared = larger(s.relative_height_squared, height_squared);
  if (rim_squared != nullptr) store_floats(out_squared, rim_squared);

  const P eta(step.eta);
  if (step.event == PathEvent::Reflect) {
    const P cos_in = smaller(hit.cos_in, one);
    const P cos_out_squared = one - eta * eta * (one - cos_in * cos_in);
    const P u = step.from_denser ? square_root(larger(cos_out_squared, zero)) : cos_in;
    s.transmission = s.transmission * look_up(tables + step.reflectance, ReflectanceTables::kIntervals, u);
    hk::reflect(s.ray, hit, direction);
    if constexpr (kGeometry == PathGeometry::General) {
      if (step.efficiency != 1.0) deflect_by_grating(s, step);
    }
    return;
  }
  const P cos_out_squared = hk::refract(s.ray, hit, eta, direction);
  s.alive = or_zero(cos_out_squared > zero, s.alive);
  const P u = step.from_denser ? square_root(larger(cos_out_squared, zero)) : smaller(hit.cos_in, one);
  const P through = step.transmittance >= 0
                        ? look_up(tables + step.transmittance, ReflectanceTables::kIntervals, u)
                        : one - look_up(tables + step.reflectance, ReflectanceTables::kIntervals, u);
  s.transmission = s.transmission * through;
}

template <PathGeometry kGeometry, class P>
HWY_INLINE void land(const PacketState<P>& s, const PacketPath& path, std::size_t at, const TracedArrays& out) {
  const P zero(0.0);
  const P t = (P(path.sensor_gap_mm()) - s.ray.z) / s.ray.dz;
  const auto ok = or_zero(s.ray.dz > zero, s.alive) > zero;
  P x = s.ray.x + t * s.ray.dx;
  P y = s.ray.y + t * s.ray.dy;
  if constexpr (kGeometry == PathGeometry::General) {
    x = x - P(path.sensor_offset_mm().x);
    y = y - P(path.sensor_offset_mm().y);
  }
  store_floats(or_zero(ok, x), out.sensor_x_mm + at);
  store_floats(or_zero(ok, y), out.sensor_y_mm + at);
  store_floats(or_zero(ok, s.transmission), out.transmission + at);
  store_floats(select(ok, square_root(s.relative_height_squared), P(std::numeric_limits<double>::infinity())),
               out.relative_height + at);
}

template <class P>
HWY_INLINE PacketState<P> enter(const PacketStart& start, const float* x_mm, const float* y_mm) {
  const P x = hk::load_floats(typename P::Tag(), x_mm);
  const P y = hk::load_floats(typename P::Tag(), y_mm);
  PacketState<P> s;
  s.ray = {P(start.origin_mm.x) + x, P(start.origin_mm.y) + y, P(0.0),
           P(start.direction.x),     P(start.direction.y),     P(start.direction.z)};
  s.transmission = P(1.0);
  if (start.diverges) {
    const P per_distance(start.per_distance_mm);
    const P ratio = hk::perturb_direction(s.ray, x * per_distance, y * per_distance);
    s.transmission = P(start.flux) * ratio * ratio * ratio;
  }
  s.relative_height_squared = P(0.0);
  s.alive = P(1.0);
  return s;
}

// Traces one packet of rays, which starts at index `at` of the arrays.
template <PathGeometry kGeometry, class P>
CONTREJOUR_INLINE_IF_FAST void trace_one(const PacketPath& path, const float* x_mm, const float* y_mm, std::size_t at,
                                         const TracedArrays& out) {
  PacketState<P> s = enter<P>(path.start(), x_mm + at, y_mm + at);
  float* rim_squared = out.rim_squared != nullptr ? out.rim_squared + at : nullptr;
  for (const PacketStep& step : path.steps()) {
    advance<kGeometry>(s, step, path.tables(), rim_squared);
    if (step.event == PathEvent::Stop) pass_stop(s, step, path.inverse_stop_radius_per_mm(), at, out);
    if (rim_squared != nullptr) rim_squared += out.rim_stride;
  }
  land<kGeometry>(s, path, at, out);
}

// Traces the last rays, too few for a packet, in buffers of a packet's length.
template <PathGeometry kGeometry, class P>
void trace_tail(const PacketPath& path, const float* x_mm, const float* y_mm, std::size_t count,
                const TracedArrays& out) {
  constexpr std::size_t kLongest = HWY_MAX_BYTES / sizeof(float);
  constexpr std::size_t kFixed = 4;
  std::array<std::array<float, kLongest>, 2> in{};
  std::array<std::array<float, kLongest>, kFixed + 2 * kMaxStopCrossings> buffers;
  std::copy_n(x_mm, count, in[0].begin());
  std::copy_n(y_mm, count, in[1].begin());
  TracedArrays part{buffers[0].data(), buffers[1].data(), buffers[2].data(), buffers[3].data(), {}, {}, nullptr, 0};
  for (std::size_t c = 0; c < kMaxStopCrossings; ++c) {
    part.stop_x[c] = buffers[kFixed + 2 * c].data();
    part.stop_y[c] = buffers[kFixed + 2 * c + 1].data();
  }
  std::vector<float> rims;
  if (out.rim_squared != nullptr) {
    rims.resize(path.steps().size() * kLongest);
    part.rim_squared = rims.data();
    part.rim_stride = kLongest;
  }
  trace_one<kGeometry, P>(path, in[0].data(), in[1].data(), 0, part);
  for (std::size_t k = 0; part.rim_squared != nullptr && k < path.steps().size(); ++k) {
    std::copy_n(rims.data() + k * kLongest, count, out.rim_squared + k * out.rim_stride);
  }
  std::copy_n(part.sensor_x_mm, count, out.sensor_x_mm);
  std::copy_n(part.sensor_y_mm, count, out.sensor_y_mm);
  std::copy_n(part.transmission, count, out.transmission);
  std::copy_n(part.relative_height, count, out.relative_height);
  for (std::size_t c = 0; c < static_cast<std::size_t>(path.stop_crossings()); ++c) {
    std::copy_n(part.stop_x[c], count, out.stop_x[c]);
    std::copy_n(part.stop_y[c], count, out.stop_y[c]);
  }
}

TracedArrays advanced(const TracedArrays& arrays, std::size_t by, int crossings) {
  TracedArrays out = arrays;
  out.sensor_x_mm += by;
  out.sensor_y_mm += by;
  out.transmission += by;
  out.relative_height += by;
  if (out.rim_squared != nullptr) out.rim_squared += by;
  for (std::size_t c = 0; c < static_cast<std::size_t>(crossings); ++c) {
    out.stop_x[c] += by;
    out.stop_y[c] += by;
  }
  return out;
}

template <PathGeometry kGeometry, class P>
void trace_all(const PacketPath& path, const float* x_mm, const float* y_mm, std::size_t count,
               const TracedArrays& out) {
  const std::size_t lanes = hn::Lanes(typename P::Tag());
  std::size_t at = 0;
  for (; at + lanes <= count; at += lanes) trace_one<kGeometry, P>(path, x_mm, y_mm, at, out);
  if (at < count) {
    trace_tail<kGeometry, P>(path, x_mm + at, y_mm + at, count - at, advanced(out, at, path.stop_crossings()));
  }
}

template <class P>
void trace_any(const PacketPath& path, const float* x_mm, const float* y_mm, std::size_t count,
               const TracedArrays& out) {
  switch (path.geometry()) {
    case PathGeometry::Spheres: return trace_all<PathGeometry::Spheres, P>(path, x_mm, y_mm, count, out);
    case PathGeometry::Shapes: return trace_all<PathGeometry::Shapes, P>(path, x_mm, y_mm, count, out);
    case PathGeometry::General: return trace_all<PathGeometry::General, P>(path, x_mm, y_mm, count, out);
  }
}

void trace_float(const PacketPath& path, const float* x_mm, const float* y_mm, std::size_t count,
                 const TracedArrays& out) {
  trace_any<hk::Packet<float>>(path, x_mm, y_mm, count, out);
}

void trace_double(const PacketPath& path, const float* x_mm, const float* y_mm, std::size_t count,
                  const TracedArrays& out) {
  trace_any<hk::PrecisePacket>(path, x_mm, y_mm, count, out);
}

}  // namespace contrejour::inline internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace contrejour::inline internal {

HWY_EXPORT(trace_float);
HWY_EXPORT(trace_double);

void trace_packets(const PacketPath& path, PacketPrecision precision, const float* x_mm, const float* y_mm,
                   std::size_t count, const TracedArrays& out) {
  if (precision == PacketPrecision::Double) {
    HWY_DYNAMIC_DISPATCH(trace_double)(path, x_mm, y_mm, count, out);
  } else {
    HWY_DYNAMIC_DISPATCH(trace_float)(path, x_mm, y_mm, count, out);
  }
}

}  // namespace contrejour::inline internal
#endif  // HWY_ONCE
