// SPDX-License-Identifier: Apache-2.0
// Rays of one ghost and light at one wavelength, at the Lobatto points of a box of the entrance plane: exact ones, or
// those of a fit.
// All in the light's meridional frame: the light comes from -x or along the axis, so a centred lens is symmetric
// in y and half the rays are the mirror images of the others; hullin2011 4.2, "symmetries".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "ghosts/light_frame.h"
#include "ghosts/ray_grid.h"
#include "render/pupils/curved_box.h"
#include "render/pupils/ray_source.h"

namespace contrejour::inline internal::ray_maps {

using namespace pupils;  // boxes of pupils and the curves of their sides

// Relative height up to which rays matter for the image; rays at a box's border may land far outside it.
constexpr float kNearlyThrough = 1.2F;

// One value a node, rows of `nodes` by rising y.
struct LobattoRays {
  Rectangle box;  // mm, in the plane of the entrance window
  int nodes = 0;
  float reach = std::numeric_limits<float>::infinity();  // RaySource::reach()
  int failed = 0;  // nodes whose ray does not arrive; their values are undefined
  std::vector<float> sensor_x_mm, sensor_y_mm;
  std::vector<float> transmission;
  std::vector<std::vector<float>> weight;    // transmissions weighted by add_light(): one field, or one a channel
  std::array<double, 3> gain{1.0, 1.0, 1.0};                   // of weights to channels
  std::vector<float> relative_height;                  // infinite where the ray fails; without obscurations
  std::vector<std::array<std::vector<float>, 2>> stop;  // by crossing: x and y over the stop radius
  std::vector<float> rim_squared;            // [rim * nodes^2 + node]
  std::vector<bool> blocks_within;           // by rim; empty where none does

  [[nodiscard]] bool arrives(std::size_t node) const {
    return relative_height[node] < std::numeric_limits<float>::infinity();
  }
  // True if the node's values hold. Those of failing rays and those of fits far outside the light do not.
  [[nodiscard]] bool counts(std::size_t node) const { return relative_height[node] < reach; }
  [[nodiscard]] bool blocks_at(std::size_t step) const { return !blocks_within.empty() && blocks_within[step]; }
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(nodes) * static_cast<std::size_t>(nodes); }
};

// Adds gain * transmission, one value a node, to the ray set's light. The first is one weight for all channels.
void add_light(LobattoRays& ray_set, std::span<const float> transmission, const std::array<double, 3>& gain);

// The ray set of the mirror box on the other side of y = 0, for a lens and light with that symmetry.
[[nodiscard]] LobattoRays mirrored(const LobattoRays& ray_set);

// The nodes of a cell of the ray set: the second is the next in the first's row, the others are in the row above.
using CellCorners = std::array<std::size_t, 4>;
// True if light may get through between these nodes; the iris counts as its circumscribed circle.
[[nodiscard]] bool may_transmit(const LobattoRays& ray_set, const CellCorners& corners);
// The bounds of the cells that satisfy a predicate; none if no cell does.
[[nodiscard]] std::optional<Rectangle> bounds_of_cells(const LobattoRays& ray_set,
                                                       const std::function<bool(const CellCorners&)>& counts);

// Indices of the steps whose rims may clip any of the ray sets, which are of one box; those that clip deepest come
// first. An obscuration may block light between rays: its squared height is assumed to exceed the highest value at the
// nodes by no more than the range of these values.
[[nodiscard]] std::vector<std::size_t> rims_in_play(std::span<const LobattoRays> ray_sets);

class LobattoTracer {
 public:
  // source: of that light.
  LobattoTracer(std::unique_ptr<RaySource> source, const LightFrame& light);
  LobattoTracer(PacketPath path, const LightFrame& light)
      : LobattoTracer(std::make_unique<TracedRays>(std::move(path)), light) {}

  // A ray set without weights. For a box that is its own mirror image half of the rays are traced.
  [[nodiscard]] LobattoRays trace(const Rectangle& box, int nodes, PacketPrecision precision);
  // The transmissions of the rays through the same nodes.
  [[nodiscard]] std::vector<float> transmissions(const Rectangle& box, int nodes, PacketPrecision precision);

  // Sets the curved sides of the boxes that follow.
  void curve(const SideCurve& curve) { curve_ = curve; }

  [[nodiscard]] std::uint64_t rays() const { return rays_; }  // traced or evaluated
  [[nodiscard]] std::uint64_t traced_rays() const { return source_->surfaces() > 0 ? rays_ : 0; }
  [[nodiscard]] std::uint64_t surface_hits() const { return rays_ * source_->surfaces(); }

 private:
  [[nodiscard]] int first_traced_row(const Rectangle& box, int nodes) const;
  void set_starts(const Rectangle& box, int nodes, int first_row);
  void weigh(const Rectangle& box, float* transmission) const;
  void leave_obscurations_out(LobattoRays& ray_set) const;

  LightFrame light_;
  std::unique_ptr<RaySource> source_;
  bool is_obscured_ = false;
  SideCurve curve_;
  std::vector<float> x_mm_, y_mm_;
  std::uint64_t rays_ = 0;
};

}  // namespace contrejour::inline internal::ray_maps
