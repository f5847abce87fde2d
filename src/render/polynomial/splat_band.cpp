// SPDX-License-Identifier: Apache-2.0
#include "render/polynomial/splat_band.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>

#include "base/split_mix.h"

namespace contrejour::inline internal::splatting {
namespace {

using adaptive::Item;

constexpr std::size_t kPointsAtOnce = 4096;  // evaluated together, in the processor's cache

// The map from a light's frame on the sensor to pixels, which is affine.
class PixelMap {
 public:
  PixelMap(const Frame& frame, const LightFrame& light)
      : origin_(frame.pixel_from_sensor({})),
        along_(frame.pixel_from_sensor(light.to_lens_frame({1.0, 0.0})) - origin_),
        across_(frame.pixel_from_sensor(light.to_lens_frame({0.0, 1.0})) - origin_) {}
  [[nodiscard]] Vec2 operator()(double x_mm, double y_mm) const { return origin_ + along_ * x_mm + across_ * y_mm; }

 private:
  Vec2 origin_, along_, across_;
};

// Some points of the entrance plane, with what their rays do.
struct PointBlock {
  std::vector<float> x_mm, y_mm, sensor_x_mm, sensor_y_mm, transmission, relative_height, iris_distance;
  std::array<std::vector<float>, kMaxStopCrossings> stop_x, stop_y;

  PointBlock() {
    for (auto* const values :
         {&x_mm, &y_mm, &sensor_x_mm, &sensor_y_mm, &transmission, &relative_height, &iris_distance})
      values->resize(kPointsAtOnce);
    for (auto* const crossings : {&stop_x, &stop_y})
      for (std::vector<float>& values : *crossings) values.resize(kPointsAtOnce);
  }

  void trace(pupils::RaySource& source, Vec2 origin_mm, std::size_t count) {
    TracedArrays out{sensor_x_mm.data(), sensor_y_mm.data(), transmission.data(), relative_height.data()};
    for (std::size_t c = 0; c < kMaxStopCrossings; ++c) {
      out.stop_x[c] = stop_x[c].data();
      out.stop_y[c] = stop_y[c].data();
    }
    source.rays(origin_mm, PacketPrecision::Double, x_mm.data(), y_mm.data(), count, out);
  }

  // Marks points that the iris blocks at any crossing by a relative height of kFailed.
  void block(const IrisShape& iris, const LightFrame& light, int crossings, std::size_t count) {
    const auto cosine = static_cast<float>(light.cos_rotation), sine = static_cast<float>(light.sin_rotation);
    for (std::size_t c = 0; c < static_cast<std::size_t>(crossings); ++c) {
      for (std::size_t k = 0; k < count; ++k) {
        const float along = stop_x[c][k], across = stop_y[c][k];
        stop_x[c][k] = cosine * along - sine * across;
        stop_y[c][k] = sine * along + cosine * across;
      }
      iris.distances(stop_x[c].data(), stop_y[c].data(), count, iris_distance.data());
      for (std::size_t k = 0; k < count; ++k)
        if (!(iris_distance[k] <= 0.0F)) relative_height[k] = kFailed;
    }
  }
};

// The points of a band, one somewhere in each cell, row by row. Each depends on its cell and the band's key alone.
class RandomPoints {
 public:
  RandomPoints(const Band& band, int side, Vec2 step_mm)
      : band_(band), side_(side), step_mm_(step_mm), row_(band.first_row) {}

  // Writes the next points, relative to the grid's corner, and returns their number; 0 at the end.
  [[nodiscard]] std::size_t next(std::span<float> x_mm, std::span<float> y_mm) {
    std::size_t count = 0;
    for (; count < x_mm.size() && row_ < band_.end_row; ++count) {
      const std::uint64_t cell =
          static_cast<std::uint64_t>(row_) * static_cast<std::uint64_t>(side_) + static_cast<std::uint64_t>(column_);
      const std::uint64_t bits = split_mix(band_.key + cell * kSplitMixIncrement);
      const double in_x = static_cast<double>(bits >> 32U) * 0x1p-32;
      const double in_y = static_cast<double>(bits & 0xffffffffU) * 0x1p-32;
      x_mm[count] = static_cast<float>(step_mm_.x * (column_ + in_x));
      y_mm[count] = static_cast<float>(step_mm_.y * (row_ + in_y));
      if (++column_ == side_) {
        column_ = 0;
        ++row_;
      }
    }
    return count;
  }

 private:
  const Band& band_;
  int side_;
  Vec2 step_mm_;
  int row_, column_ = 0;
};

// Adds the points that get through to the frame.
void add_lit(const PointBlock& block, std::size_t count, const PixelMap& pixel, const Frame& frame,
             std::vector<LitPoint>& lit) {
  for (std::size_t k = 0; k < count; ++k) {
    if (!(block.relative_height[k] <= 1.0F)) continue;
    const Vec2 at = pixel(block.sensor_x_mm[k], block.sensor_y_mm[k]);
    if (!(at.x >= 0.0 && at.y >= 0.0 && at.x < frame.width && at.y < frame.height)) continue;
    lit.push_back({static_cast<std::int32_t>(at.x), static_cast<std::int32_t>(at.y), block.transmission[k]});
  }
}

// Adds points to the pixels of the box that contains them.
void spread(const std::vector<LitPoint>& lit, double flux_mm2, SplattedBand& out) {
  if (lit.empty()) return;
  LitPoint low = lit.front(), high = low;
  for (const LitPoint& point : lit) {
    low = {std::min(low.x, point.x), std::min(low.y, point.y)};
    high = {std::max(high.x, point.x), std::max(high.y, point.y)};
  }
  out.left = low.x;
  out.top = low.y;
  out.width = 1 + high.x - low.x;
  out.height = 1 + high.y - low.y;
  out.lit = lit.size();
  const auto width = static_cast<std::size_t>(out.width);
  out.flux.resize(width * static_cast<std::size_t>(out.height));
  for (const LitPoint& point : lit)
    out.flux[static_cast<std::size_t>(point.y - low.y) * width + static_cast<std::size_t>(point.x - low.x)] +=
        point.transmission;
  for (double& value : out.flux) value *= flux_mm2;
}

}  // namespace

SplattedBand BandSplatter::draw(const Band& band, const Context& context) const {
  const Item& item = *band.item;
  const LightFrame light(item.light->source, has_axial_symmetry(scene_.lens, item.ghost));
  const auto fitted = item.is_fitted ? fit_of(item, light) : nullptr;
  const auto source = source_of(band, light, fitted.get());
  const Rectangle bounds = std::reduce(item.boxes.begin() + 1, item.boxes.end(), item.boxes.front(), both);
  const Vec2 step_mm = (bounds.high - bounds.low) * (1.0 / points_);
  SplattedBand out;
  const std::vector<LitPoint> lit = lit_points(band, {*source, light, bounds.low, step_mm}, context, out);
  spread(lit, step_mm.x * step_mm.y * light.source.shared_flux(), out);
  return out;
}

std::unique_ptr<pupils::FittedGhost> BandSplatter::fit_of(const Item& item, const LightFrame& light) const {
  const std::vector<PlannedPass>& passes = item.light->passes;
  return scene_.fitted->find({item.ghost, light, item.window.z_mm, scene_.lens.stop_radius_mm, passes.front().lambda_nm,
                              passes.back().lambda_nm});
}

std::unique_ptr<pupils::RaySource> BandSplatter::source_of(const Band& band, const LightFrame& light,
                                                           const pupils::FittedGhost* fitted) const {
  const double lambda_nm = band.pass->lambda_nm;
  if (fitted != nullptr) return fitted->at(lambda_nm);
  return std::make_unique<pupils::TracedRays>(
      PacketPath(scene_.steps.at(lambda_nm), band.item->ghost, {{0.0, 0.0, band.item->window.z_mm}, light.source}));
}

// One point in each cell of the band's rows, as far as it gets through to the frame.
std::vector<LitPoint> BandSplatter::lit_points(const Band& band, const Start& start, const Context& context,
                                               SplattedBand& counts) const {
  const PixelMap pixel(band.item->adjustment->placed(frame_), start.light);
  std::vector<LitPoint> lit;
  PointBlock block;
  RandomPoints random(band, points_, start.step_mm);
  while (!context.cancelled()) {
    const std::size_t count = random.next(block.x_mm, block.y_mm);
    if (count == 0) break;
    block.trace(start.source, start.low_mm, count);
    block.block(scene_.iris, start.light, start.source.stop_crossings(), count);
    add_lit(block, count, pixel, frame_, lit);
    if (!band.item->is_fitted) counts.rays += count;
  }
  counts.surface_hits = counts.rays * start.source.surfaces();
  return lit;
}

}  // namespace contrejour::inline internal::splatting
