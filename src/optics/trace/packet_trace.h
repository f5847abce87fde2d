// SPDX-License-Identifier: Apache-2.0
// Traces many rays of a light along one path in packets (Highway, the widest instruction set of the machine): the
// formulas of trace() in float, or in double where neighbouring rays lie too close for float.
// Layout: structure of arrays, any length. Nothing is allocated while tracing.
// Accuracy against trace() for unblocked rays: sensor positions 1e-3 mm in float (typically 1e-5) and 1e-5 mm
// in double (outputs are float), transmittance 1e-4 relative. Thread-safety: shared values are only read.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include "contrejour/expert/trace.h"

namespace contrejour::inline internal {

// Reflectance, and transmittance where a film absorbs, of every surface at one wavelength, tabulated over the
// cosine u of the ray in the medium of lower index. As a function of u a lossless surface is the same from both sides
// and has no square root at the critical angle (u = 0), so linear interpolation between the nodes is accurate to 1e-5.
class ReflectanceTables {
 public:
  static constexpr int kIntervals = 2048;

  ReflectanceTables(const LensState& lens, double lambda_nm);

  struct Entry {
    std::array<int, 2> reflectance{-1, -1};  // offsets into values(), light from the front and from behind
    int transmittance = -1;                  // -1: 1 - reflectance
  };
  // Offset of a table of zeros, for rims without refraction; only of lenses that have such rims.
  [[nodiscard]] int none() const { return none_; }
  [[nodiscard]] const Entry& of(int surface) const { return entries_[static_cast<std::size_t>(surface)]; }
  [[nodiscard]] const float* values() const { return values_.data(); }
  [[nodiscard]] double lambda_nm() const { return lambda_nm_; }
  [[nodiscard]] std::size_t bytes() const { return values_.size() * sizeof(float); }

 private:
  [[nodiscard]] Entry entry_of(const SurfaceState& surface, const LensState& lens);
  int add(const SurfaceState& surface, int direction, bool transmitted);

  std::vector<Entry> entries_;
  std::vector<float> values_;
  int none_ = -1;
  double lambda_nm_;
};

// A step with lengths relative to the preceding vertex, which keeps float accurate.
struct PacketStep {
  PathEvent event = PathEvent::Refract;
  int crossing = 0;             // for the stop: which one it is
  bool from_denser = false;     // n_in > n_out
  int reflectance = 0;          // offsets into the tables
  int transmittance = -1;
  double direction = 1;
  double gap_mm = 0;            // z of this vertex less that of the step before, or of the origin
  double curvature_per_mm = 0;
  double inverse_semi_diameter_per_mm = 0;
  double inverse_semi_diameter_squared = 0;
  double eta = 1;               // n_in / n_out
  const ShapeConstants* shape = nullptr;  // none: a sphere or a plane
  Vec3 axis{0, 0, 1};           // the surface's own axis, in a lens that is not centred
  Vec2 offset_mm;               // in the same lens: of the vertex from the preceding one, as gap_mm
  // The following members are for General paths only.
  Rim rim;
  bool blocks_within = false;
  double absorption_per_mm = 0;
  Vec2 grating_shift;
  double efficiency = 1;
};

// The features that an intersection must handle: tracers are compiled for each.
enum class PathGeometry {
  Spheres,  // centred spheres and planes
  Shapes,   // centred, some of other shapes
  General,  // any: decentred, tilted, non-circular rims, absorbing glass, a grating
};

// A light's rays, through points of the plane z = origin.z.
struct LightRays {
  Vec3 origin_mm;
  LightSource source;
};

// The ray through the origin, and for a light at a finite distance the terms by which other rays differ.
struct PacketStart {
  Vec3 origin_mm;
  Vec3 direction;
  bool diverges = false;
  double per_distance_mm = 0;  // 1 over the distance from the light to the origin
  double flux = 1;        // LightSource::flux_at; another ray's is this times (origin's distance over its own)^3
};

class LensSteps;

// A path prepared for tracing rays that start from one plane. The tables must outlive it.
class PacketPath {
 public:
  PacketPath(const OpticalPath& path, const ReflectanceTables& tables, const LightRays& rays);
  // A ghost's path assembled from existing steps, at a sixth of the cost. They must outlive it. stop_times: factor on
  // the stop's radius.
  PacketPath(const LensSteps& steps, const Ghost& ghost, const LightRays& rays, double stop_times = 1.0);

  // Moves the origin to another point of the plane, for the same light.
  void start_from(Vec2 origin_mm);

  [[nodiscard]] const std::vector<PacketStep>& steps() const { return steps_; }
  [[nodiscard]] const float* tables() const { return tables_; }
  [[nodiscard]] const PacketStart& start() const { return start_; }
  [[nodiscard]] PathGeometry geometry() const { return geometry_; }
  [[nodiscard]] double sensor_gap_mm() const { return sensor_gap_mm_; }  // from the last vertex
  [[nodiscard]] Vec2 sensor_offset_mm() const { return sensor_offset_mm_; }
  [[nodiscard]] double inverse_stop_radius_per_mm() const { return inverse_stop_radius_per_mm_; }
  [[nodiscard]] int stop_crossings() const { return stop_crossings_; }

 private:
  std::vector<PacketStep> steps_;
  const float* tables_;
  LightSource source_;
  PacketStart start_;
  PathGeometry geometry_ = PathGeometry::Spheres;
  std::vector<std::shared_ptr<const ShapeConstants>> shapes_;  // that steps_ point to
  double sensor_gap_mm_ = 0;
  Vec2 sensor_offset_mm_;
  double inverse_stop_radius_per_mm_ = 1;
  int stop_crossings_ = 0;
};

inline constexpr float kFailed = std::numeric_limits<float>::infinity();  // relative height of a ray that fails

// Output arrays. For a light at a finite distance transmissions include LightSource::flux_at. A ray that fails has
// relative_height = kFailed, transmission 0 and an undefined sensor point. A point at p radii from an obscuration's
// centre counts as the relative height 2 - p: above 1 where it blocks, and as smooth as a rim's.
struct TracedArrays {
  float* sensor_x_mm = nullptr;
  float* sensor_y_mm = nullptr;
  float* transmission = nullptr;
  float* relative_height = nullptr;
  std::array<float*, kMaxStopCrossings> stop_x{};  // one array a stop crossing
  std::array<float*, kMaxStopCrossings> stop_y{};
  // Optional: at step k of the path, the squared distance from the axis over the clear semi-diameter, at [k *
  // rim_stride + ray]; 4 beyond a sphere's equator; 2 - p^2 for an obscuration; not written at the stop. It is smooth
  // where relative_height has creases.
  float* rim_squared = nullptr;
  std::size_t rim_stride = 0;
};

enum class PacketPrecision { Float, Double };

// Searches trace rays closer than this at the entrance in double, since float has a resolution of about 4e-6 mm.
inline constexpr double kFloatStep_mm = 1e-3;
[[nodiscard]] constexpr PacketPrecision search_precision(double step_mm) {
  return step_mm < kFloatStep_mm ? PacketPrecision::Double : PacketPrecision::Float;
}

// Entrance points are relative to start().origin_mm.
void trace_packets(const PacketPath& path, PacketPrecision precision, const float* x_mm, const float* y_mm,
                   std::size_t count, const TracedArrays& out);

}  // namespace contrejour::inline internal
