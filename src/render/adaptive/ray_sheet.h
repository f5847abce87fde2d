// Exact rays of one ghost, light and band of wavelengths at the Lobatto points of a box of the entrance plane.
// All in the light's meridional frame: the light comes from -x or along the axis, so a centred lens is symmetric
// in y and half the rays are the mirror images of the others; hullin2011 4.2, "symmetries".
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ghosts/ray_grid.h"
#include "render/adaptive/light_frame.h"
#include "render/interface/frame_plan.h"

namespace contrejour::adaptive {

// Wavelengths close enough for a ghost to be drawn with the geometry of one of them.
struct Band {
  double lambda_nm = 550;               // where rays are traced
  std::span<const PlannedPass> passes;  // whose transmissions are summed
};

// One value a node, rows of `nodes` by rising y.
struct RaySheet {
  Rectangle box;  // mm, in the plane of the entrance window
  int nodes = 0;
  int failed = 0;  // nodes whose ray does not arrive; their values mean nothing
  std::vector<float> sensor_x_mm, sensor_y_mm;
  std::array<std::vector<float>, 3> weight;  // per channel: sum over the passes of gain * transmission
  std::vector<float> r_rel;                  // infinite where the ray fails; without obscurations
  std::vector<std::array<std::vector<float>, 2>> stop;  // by crossing: x and y over the stop radius
  std::vector<float> rim_squared;            // [step * nodes^2 + node]
  std::vector<bool> blocks_within;           // by step; empty where none does

  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(nodes) * static_cast<std::size_t>(nodes); }
};

// Whether a node's ray gets through; the iris counts as its circumscribed circle.
[[nodiscard]] bool is_open(const RaySheet& sheet, std::size_t node);

class SheetTracer {
 public:
  // The tables must hold every wavelength of the band.
  // stop_times: the stop is taken to be so many times as large (stop_screen.h).
  SheetTracer(const LensState& lens, Ghost ghost, const LightFrame& light, double plane_z_mm, const Band& band,
              const TablesByWavelength& tables, double stop_times = 1.0);

  // Rays at the band's own wavelength, and its transmission. A box that is its own mirror image costs half of them.
  [[nodiscard]] RaySheet trace(const Rectangle& box, int nodes, PacketPrecision precision);
  // The transmissions at the band's other wavelengths, for a sheet that is going to be drawn.
  void add_wavelengths(RaySheet& sheet, PacketPrecision precision);

  [[nodiscard]] std::size_t steps() const { return paths_.front().steps.size(); }
  [[nodiscard]] std::uint64_t rays() const { return rays_; }
  [[nodiscard]] std::uint64_t surface_hits() const { return rays_ * steps(); }

 private:
  void lay_out(const RaySheet& sheet, int first_row);
  void leave_obscurations_out(RaySheet& sheet) const;
  void trace_path(std::size_t k, int first_row, PacketPrecision precision, RaySheet& sheet);

  LightFrame light_;
  double plane_z_mm_;
  Band band_;
  std::vector<OpticalPath> paths_;                  // first the geometry's, then one a pass where they differ
  std::vector<const ReflectanceTables*> tables_;
  std::vector<float> x_mm_, y_mm_, scratch_;
  std::uint64_t rays_ = 0;
};

}  // namespace contrejour::adaptive
