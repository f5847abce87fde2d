// SPDX-License-Identifier: Apache-2.0
// How paths, shapes and irises lie in the buffers that shaders read (shaders/bindings.glsl, trace.comp, shape.glsl).
// Thread-safety: pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "render/device/frame_device.h"

namespace contrejour::inline internal::vulkan {

// The parameters of a dispatch: shaders' push constants, in their order.
struct Parameters {
  std::uint32_t step_count = 0, first_ray = 0;
  std::uint32_t side = 0, crossing_count = 0, bound_count = 0, flags = 0;
  std::int32_t width = 0, height = 0;
  float triangle_weight = 0;
  std::uint32_t level = 0;
  std::array<float, 3> gain{};
  float merge_threshold = 0;
  std::uint32_t blocks_at = 0, level_side = 0, finer_at = 0, finer_side = 0;
  std::uint32_t large_capacity = 0, corner_capacity = 0;
  std::uint32_t primitive_capacity = 0;
  std::uint32_t grid_count = 1, block_stride = 0;
  std::int32_t large_pixels = 0;
  std::uint32_t first_grid = 0;
  std::uint32_t picture = 0;  // its number from 1 on; 0: the iris is none
};
static_assert(sizeof(Parameters) <= 128, "every device has 128 bytes of push constants");

// A grid of a frame with stop patterns or dirt, as shaders/grid_stop.glsl reads it.
struct GridRecord {
  std::uint32_t pattern = 0;  // its number from 1 on; 0: none
  float outer_radius = 1;  // of which crossings of the stop are multiples, stop radii
  std::uint32_t first_ray = 0, side = 0;
  std::array<float, 2> start_mm{}, step_mm{};  // of the rays, in their plane
  std::array<float, 3> along{};  // the first ray's direction
  float per_distance_mm = 0;  // the change of the direction by mm of the plane; 0: the light is distant
  float front_gap_mm = 0;  // along the axis, to the plane of dirt on the front
  std::array<float, 3> unused{};
};
static_assert(sizeof(GridRecord) == 64);

enum ParameterFlags : std::uint32_t {
  kCircle = 1,
  kSmooth = 2,
  kLastLevel = 4,
  kObscured = 8,
  kFirst = 1,  // FLAG_FIRST
};

inline constexpr std::uint64_t kRayBytes = 16, kCrossingBytes = 8 * kMaxStopCrossings, kVertexBytes = 8;
inline constexpr std::uint64_t kLargeBytes = 64, kCornerBytes = 8, kSumBytes = 8, kCutRecordBytes = 16,
                               kPixelBytes = 12;
inline constexpr float kFailedHeight = 3.0e38F;  // FAILED

// Maps a point of the sensor (mm) to pixels: origin + scale * sensor.
struct PixelMap {
  Vec2 origin, scale;
};
[[nodiscard]] PixelMap pixel_map(const Frame& frame, Vec2 shift_mm);

// Numbers that a grid's path may begin at, so that a uniform buffer of any device may begin there.
inline constexpr std::size_t kPathAlignment = 64;
inline constexpr std::uint64_t kPathRange = 64U << 10U;  // bytes of a path: those of PATH_NUMBERS in shaders/trace.comp

// The places at which the numbers of a path begin.
struct PathPlace {
  std::uint32_t reals_at = 0, integers_at = 0;
};

// The numbers of many paths, as they are uploaded.
class PathData {
 public:
  // Appends a path, whose places are multiples of 4: shaders read texels of four numbers.
  [[nodiscard]] PathPlace add(const PacketPath& path, PacketPrecision precision);
  // Appends a grid's start and path, whose places are multiples of kPathAlignment, and sets the members of a dispatch
  // that describe the path. The numbers refer to each other from the place on.
  [[nodiscard]] PathPlace add(const DeviceGrid& grid, const PixelMap& map, Parameters& to);

  [[nodiscard]] const std::vector<float>& floats() const { return floats_; }
  [[nodiscard]] const std::vector<double>& doubles() const { return doubles_; }
  [[nodiscard]] const std::vector<std::int32_t>& integers() const { return integers_; }
  // Each reflectance with the next, as rays interpolate between them.
  [[nodiscard]] std::vector<float> table_pairs() const;

 private:
  [[nodiscard]] PathPlace append(const PacketPath& path, PacketPrecision precision, std::size_t origin);
  [[nodiscard]] int table_of(const float* values);
  void append(const std::vector<double>& numbers, PacketPrecision precision);
  [[nodiscard]] std::size_t size(PacketPrecision precision) const;

  std::vector<float> floats_;
  std::vector<double> doubles_;
  std::vector<std::int32_t> integers_;
  std::vector<float> tables_;
  std::map<const float*, int> table_at_;
};

// A light's numbers, as shaders/start.glsl; the meridian's direction in place of the step.
[[nodiscard]] std::vector<float> start_numbers(const PacketStart& start, Vec2 meridian, const PixelMap& map);

// The bounds of an iris that is no picture, eight numbers each.
[[nodiscard]] std::vector<float> bound_numbers(const IrisShape& iris);

}  // namespace contrejour::inline internal::vulkan
