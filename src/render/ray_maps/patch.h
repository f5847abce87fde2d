// SPDX-License-Identifier: Apache-2.0
// A part of a ghost as polynomials over a box of the entrance plane: where its rays land, what they carry, and how
// close they pass to whatever may block them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "contrejour/expert/colour.h"
#include "contrejour/frame.h"
#include "render/ray_maps/lobatto_rays.h"

namespace contrejour::inline internal::ray_maps {

// The fields of a patch in order: position in pixels (2); stop coordinates (2 a crossing); the squared relative height
// at every rim that comes near; the rays' weights, one for each channel, or one for all channels of a single
// wavelength.
struct PatchLayout {
  int crossings = 0;
  int rims = 0;
  int weights = 1;  // or 3
  std::uint32_t obscurations = 0;  // bit k: rim k blocks inside; its field is 2 minus the square

  static constexpr int kX = 0, kY = 1, kStop = 2;
  [[nodiscard]] int rim(int k) const { return kStop + 2 * crossings + k; }
  [[nodiscard]] int limits_end() const { return rim(rims); }  // stop coordinates and rims end before this field
  [[nodiscard]] bool is_obscuration(int k) const { return (obscurations >> k & 1U) != 0; }
  [[nodiscard]] int weight(int k) const { return limits_end() + k; }
  [[nodiscard]] int weight_of(int channel) const { return weight(weights == 1 ? 0 : channel); }
  [[nodiscard]] int fields() const { return weight(weights); }
};

inline constexpr int kMaxRims = 12;

struct Patch {
  PatchLayout layout;
  int nodes = 0;  // along a side, Lobatto points
  Rectangle box;  // mm of the entrance plane, in the light's frame
  Vec2 origin_px;  // origin of positions
  double flux_area_mm2 = 0;  // the box's area times cos(theta): flux is gain x weight x this
  Rgb gain{1.0, 1.0, 1.0};  // per channel
  std::vector<bool> counts;  // by node: its values hold (LobattoRays); empty: all do
  std::vector<float> values;  // [(field * nodes + row) * nodes + column]

  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(nodes) * static_cast<std::size_t>(nodes); }
  [[nodiscard]] const float* field(int f) const { return values.data() + static_cast<std::size_t>(f) * size(); }
  [[nodiscard]] float* field(int f) { return values.data() + static_cast<std::size_t>(f) * size(); }
};

// All rays of the ray set must have arrived. Rims that every ray clears by a wide margin are left out.
[[nodiscard]] Patch make_patch(const LobattoRays& ray_set, const LightFrame& light, const Frame& frame);

// The patches of ray sets of one box at several wavelengths, with a common origin and the same rims.
[[nodiscard]] std::vector<Patch> make_patches(std::span<const LobattoRays> ray_sets, const LightFrame& light,
                                              const Frame& frame);

// The factors, one for each of such patches, that make the patch of a further wavelength or of a band.
struct PatchBlend {
  std::vector<double> geometry;
  std::vector<std::vector<double>> weight;  // for each weight of the result, factors of the patches' weights
  Rgb gain{1.0, 1.0, 1.0};
};
void blend(std::span<const Patch> patches, const PatchBlend& factors, Patch& out);

// Bilinear patches between neighbouring rays that arrived, one for each four rays between which light may pass.
[[nodiscard]] std::vector<Patch> patches_of_cells(const LobattoRays& ray_set, const LightFrame& light,
                                                  const Frame& frame);

// An estimate of the polynomials' errors, from the size of their highest terms.
struct PatchError {
  double position_px = 0;
  double stop = 0;  // stop radii
  double rim = 0;  // of squared relative heights
  double weight = 0;  // relative to the largest
};
[[nodiscard]] PatchError estimated_error(const Patch& patch);

// The quarter of a patch on the low (0) or high (1) side of each axis, as a patch of its own.
[[nodiscard]] Patch quarter(const Patch& patch, int ix, int iy);

}  // namespace contrejour::inline internal::ray_maps
