// SPDX-License-Identifier: Apache-2.0
#include "vulkan/layout.h"

#include <algorithm>
#include <stdexcept>

#include "optics/surface/shape_constants.h"

namespace contrejour::inline internal::vulkan {
namespace {

constexpr std::size_t kGridReals = 14, kPathReals = 4, kStepReals = 20, kStepIntegers = 8;
constexpr std::size_t kTexelNumbers = 4;
static_assert(kPathReals % kTexelNumbers == 0 && kStepReals % kTexelNumbers == 0 && kStepIntegers % kTexelNumbers == 0);
// The bits of a step's first word beside its event, as in shaders/trace.glsl.
enum StepFlags : std::int32_t { kFromDenser = 4, kBlocksWithin = 8, kGeneral = 16, kBackwards = 32, kComplement = 64 };
constexpr int kCrossingShift = 7;

// Numbers of start.glsl.
std::array<double, kGridReals> grid_numbers(const PacketStart& start, Vec2 step_mm, const PixelMap& map) {
  return {start.origin_mm.x, start.origin_mm.y,
          start.direction.x, start.direction.y,
          start.direction.z, start.per_distance_mm,
          start.flux,        start.diverges ? 1.0 : 0.0,
          step_mm.x,         step_mm.y,
          map.origin.x,      map.origin.y,
          map.scale.x,       map.scale.y};
}

std::array<double, kPathReals> path_numbers(const PacketPath& path) {
  return {path.sensor_gap_mm(), path.sensor_offset_mm().x, path.sensor_offset_mm().y,
          path.inverse_stop_radius_per_mm()};
}

std::array<double, kStepReals> step_numbers(const PacketStep& s) {
  return {s.gap_mm,
          s.curvature_per_mm,
          s.inverse_semi_diameter_squared,
          s.eta,
          s.direction,
          s.axis.x,
          s.axis.y,
          s.axis.z,
          s.offset_mm.x,
          s.offset_mm.y,
          s.rim.centre_mm.x,
          s.rim.centre_mm.y,
          s.rim.u_per_mm.x,
          s.rim.u_per_mm.y,
          s.rim.v_per_mm.x,
          s.rim.v_per_mm.y,
          s.absorption_per_mm,
          s.grating_shift.x,
          s.grating_shift.y,
          s.efficiency};
}

std::vector<double> shape_numbers(const ShapeConstants& s) {
  std::vector<double> out{
      s.curvature,    s.curvature_x,  s.quadratic, s.quadratic_x, s.aperture_mm, s.per_aperture_squared,
      s.cos_rotation, s.sin_rotation, s.start_x,   s.start_y,     s.start_z};
  out.insert(out.end(), s.even.begin(), s.even.begin() + s.even_terms);
  out.insert(out.end(), s.odd.begin(), s.odd.begin() + s.odd_terms);
  return out;
}

}  // namespace

PixelMap pixel_map(const Frame& frame, Vec2 shift_mm) {
  Frame placed = frame;
  placed.shift_mm = placed.shift_mm + shift_mm;
  return {placed.pixel_from_sensor({}), {-1.0 / frame.pixel_pitch_mm, 1.0 / frame.pixel_pitch_mm}};
}

// Only the tables that steps refer to are copied, each once.
int PathData::table_of(const float* values) {
  const auto [at, is_new] = table_at_.try_emplace(values, static_cast<int>(tables_.size()));
  if (is_new) tables_.insert(tables_.end(), values, values + ReflectanceTables::kIntervals + 1);
  return at->second;
}

void PathData::append(const std::vector<double>& numbers, PacketPrecision precision) {
  if (precision == PacketPrecision::Double) {
    doubles_.insert(doubles_.end(), numbers.begin(), numbers.end());
  } else {
    const std::size_t first = floats_.size();
    floats_.resize(first + numbers.size());
    std::ranges::transform(numbers, floats_.begin() + static_cast<std::ptrdiff_t>(first),
                           [](double v) { return static_cast<float>(v); });
  }
}

std::size_t PathData::size(PacketPrecision precision) const {
  return precision == PacketPrecision::Double ? doubles_.size() : floats_.size();
}

PathPlace PathData::add(const DeviceGrid& grid, const PixelMap& map, Parameters& to) {
  const auto align = [](auto& numbers) {
    numbers.resize((numbers.size() + kPathAlignment - 1) / kPathAlignment * kPathAlignment);
  };
  align(floats_);
  align(doubles_);
  align(integers_);
  const std::size_t origin = size(grid.precision);
  const auto numbers = grid_numbers(grid.path.start(), grid.step_mm, map);
  append({numbers.begin(), numbers.end()}, grid.precision);
  PathPlace place = append(grid.path, grid.precision, origin);
  place.reals_at = static_cast<std::uint32_t>(origin);
  const std::size_t bytes_a_real = grid.precision == PacketPrecision::Double ? sizeof(double) : sizeof(float);
  if ((size(grid.precision) - origin) * bytes_a_real > kPathRange)
    throw std::runtime_error("a path has more surfaces than its shaders read");
  to.step_count = static_cast<std::uint32_t>(grid.path.steps().size());
  to.crossing_count = static_cast<std::uint32_t>(grid.path.stop_crossings());
  return place;
}

PathPlace PathData::add(const PacketPath& path, PacketPrecision precision) {
  append(std::vector<double>((kTexelNumbers - size(precision) % kTexelNumbers) % kTexelNumbers), precision);
  return append(path, precision, 0);
}

std::vector<float> PathData::table_pairs() const {
  std::vector<float> pairs;
  pairs.reserve(2 * tables_.size());
  for (std::size_t k = 0; k < tables_.size(); ++k) {
    pairs.push_back(tables_[k]);
    pairs.push_back(tables_[std::min(k + 1, tables_.size() - 1)]);
  }
  return pairs;
}

// origin: what the places of shapes count from.
PathPlace PathData::append(const PacketPath& path, PacketPrecision precision, std::size_t origin) {
  const std::size_t first = size(precision);
  std::vector<double> numbers;
  numbers.reserve(kPathReals + kStepReals * path.steps().size());
  const auto extend = [&](const auto& more) { numbers.insert(numbers.end(), more.begin(), more.end()); };
  extend(path_numbers(path));
  for (const PacketStep& step : path.steps()) extend(step_numbers(step));
  const PathPlace place{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(integers_.size())};
  const bool general = path.geometry() == PathGeometry::General;
  for (const PacketStep& step : path.steps()) {
    std::array<std::int32_t, kStepIntegers> out{};
    const auto flag = [](bool on, std::int32_t bit) { return on ? bit : 0; };
    const bool has_own = step.event == PathEvent::Refract && step.transmittance >= 0;
    out[0] = static_cast<std::int32_t>(step.event) | flag(step.from_denser, kFromDenser) |
             flag(step.blocks_within, kBlocksWithin) | flag(general, kGeneral) | flag(step.direction < 0, kBackwards) |
             flag(step.event == PathEvent::Refract && !has_own, kComplement) | step.crossing << kCrossingShift;
    if (step.event != PathEvent::Stop)
      out[1] = table_of(path.tables() + (has_own ? step.transmittance : step.reflectance));
    out[2] = -1;
    if (step.shape != nullptr) {
      const ShapeConstants& shape = *step.shape;
      out[2] = static_cast<std::int32_t>(first + numbers.size() - origin);
      out[3] = static_cast<std::int32_t>(shape.kind);
      out[4] = shape.even_terms;
      out[5] = shape.odd_terms;
      out[6] = shape.rotated ? 1 : 0;
      extend(shape_numbers(shape));
    }
    integers_.insert(integers_.end(), out.begin(), out.end());
  }
  append(numbers, precision);
  return place;
}

std::vector<float> start_numbers(const PacketStart& start, Vec2 meridian, const PixelMap& map) {
  const auto numbers = grid_numbers(start, meridian, map);
  std::vector<float> out;
  for (const double number : numbers) out.push_back(static_cast<float>(number));
  return out;
}

std::vector<float> bound_numbers(const IrisShape& iris) {
  std::vector<float> out;
  for (const IrisBound& bound : iris.bounds()) {
    const bool straight = bound.straight();
    for (const double v :
         {bound.normal.x, bound.normal.y, std::max(bound.apothem, -1e30), straight ? 1.0 : 0.0, bound.centre.x,
          bound.centre.y, straight ? 0.0 : bound.radius, straight ? 0.0 : bound.power_at_axis()})
      out.push_back(static_cast<float>(v));
  }
  return out;
}

}  // namespace contrejour::inline internal::vulkan
