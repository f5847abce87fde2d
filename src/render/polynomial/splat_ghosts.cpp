// SPDX-License-Identifier: Apache-2.0
#include "render/polynomial/splat_ghosts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numeric>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/split_mix.h"
#include "base/tasks.h"
#include "contrejour/expert/iris_field.h"
#include "contrejour/expert/polynomial_method.h"
#include "render/adaptive/item.h"
#include "render/planning/adaptive_passes.h"
#include "render/planning/layer_images.h"

namespace contrejour::inline internal {
namespace {

using adaptive::Item;
using adaptive::Scene;

constexpr std::size_t kPointsAtOnce = 4096;  // evaluated together, in the processor's cache
constexpr int kPointsOfBand = 1 << 20;  // about the most that are drawn by one thread into one box of pixels

// Some rows of the points of one ghost and light at one wavelength: the unit of work of the threads.
struct Band {
  const Item* item = nullptr;
  const PlannedPass* pass = nullptr;
  std::uint64_t key = 0;  // of the item's and the pass's random numbers
  int first_row = 0, end_row = 0;
};

// A point that gets through the lens, in pixels of the frame.
struct LitPoint {
  std::int32_t x = 0, y = 0;
  float transmission = 0.0F;
};

// The flux on the pixels that a band's light falls on.
struct SplattedBand {
  int left = 0, top = 0, width = 0, height = 0;
  std::vector<double> flux;  // rows from the top; mm^2 at E0 = 1
  std::uint64_t rays = 0, surface_hits = 0;  // traced
  std::uint64_t lit = 0;
};

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

// Draws bands; of one frame, by any number of threads.
class BandSplatter {
 public:
  BandSplatter(const Scene& scene, const Frame& frame, int points) : scene_(scene), frame_(frame), points_(points) {}

  // Incomplete once the context is cancelled.
  [[nodiscard]] SplattedBand draw(const Band& band, const Context& context) const {
    const Item& item = *band.item;
    const LightFrame light(item.light->source, has_axial_symmetry(scene_.lens, item.ghost));
    const auto fitted = item.is_fitted ? fit_of(item, light) : nullptr;
    const auto source = source_of(item, light, band.pass->lambda_nm, fitted.get());
    const Rectangle bounds = std::reduce(item.boxes.begin() + 1, item.boxes.end(), item.boxes.front(), both);
    const Vec2 step_mm = (bounds.high - bounds.low) * (1.0 / points_);
    SplattedBand out;
    const std::vector<LitPoint> lit = lit_points(band, {*source, light, bounds.low, step_mm}, context, out);
    spread(lit, step_mm.x * step_mm.y * light.source.shared_flux(), out);
    return out;
  }

 private:
  struct Start {
    pupils::RaySource& source;
    const LightFrame& light;
    Vec2 low_mm, step_mm;  // of the points' cells
  };

  [[nodiscard]] std::unique_ptr<pupils::FittedGhost> fit_of(const Item& item, const LightFrame& light) const {
    const std::vector<PlannedPass>& passes = item.light->passes;
    return scene_.fitted->find({item.ghost, light, item.window.z_mm, scene_.lens.stop_radius_mm,
                                passes.front().lambda_nm, passes.back().lambda_nm});
  }

  [[nodiscard]] std::unique_ptr<pupils::RaySource> source_of(const Item& item, const LightFrame& light,
                                                             double lambda_nm,
                                                             const pupils::FittedGhost* fitted) const {
    if (fitted != nullptr) return fitted->at(lambda_nm);
    return std::make_unique<pupils::TracedRays>(
        PacketPath(scene_.steps.at(lambda_nm), item.ghost, {{0.0, 0.0, item.window.z_mm}, light.source}));
  }

  // One point in each cell of the band's rows, as far as it gets through to the frame.
  [[nodiscard]] std::vector<LitPoint> lit_points(const Band& band, const Start& start, const Context& context,
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
      add_lit(block, count, pixel, lit);
      if (!band.item->is_fitted) counts.rays += count;
    }
    counts.surface_hits = counts.rays * start.source.surfaces();
    return lit;
  }

  void add_lit(const PointBlock& block, std::size_t count, const PixelMap& pixel, std::vector<LitPoint>& lit) const {
    for (std::size_t k = 0; k < count; ++k) {
      if (!(block.relative_height[k] <= 1.0F)) continue;
      const Vec2 at = pixel(block.sensor_x_mm[k], block.sensor_y_mm[k]);
      if (!(at.x >= 0.0 && at.y >= 0.0 && at.x < frame_.width && at.y < frame_.height)) continue;
      lit.push_back({static_cast<std::int32_t>(at.x), static_cast<std::int32_t>(at.y), block.transmission[k]});
    }
  }

  // Adds points to the pixels of the box that contains them.
  static void spread(const std::vector<LitPoint>& lit, double flux_mm2, SplattedBand& out) {
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

  const Scene& scene_;
  const Frame& frame_;
  int points_;
};

// items: in the order of the plan's pairs.
std::vector<Band> bands_of(const FramePlan& plan, const std::vector<Item>& items, int points) {
  std::vector<Band> bands;
  std::size_t pair = 0;
  std::uint64_t number = 0;
  const int rows = std::max(1, kPointsOfBand / points);
  for_each_pair_with_passes(plan, [&](std::size_t, std::size_t, std::span<const PlannedPass> passes) {
    const Item& item = items[pair++];
    for (const PlannedPass& pass : passes) {
      const std::uint64_t key = split_mix(++number * kSplitMixIncrement);
      if (item.boxes.empty()) continue;
      for (int row = 0; row < points; row += rows)
        bands.push_back({&item, &pass, key, row, std::min(row + rows, points)});
    }
  });
  return bands;
}

// Returns the light that was added: the sum over channels.
double add_to(Image& image, const SplattedBand& band, const Rgb& gain) {
  const std::array<float, 3> g{static_cast<float>(gain[0]), static_cast<float>(gain[1]), static_cast<float>(gain[2])};
  double sum = 0.0;
  const double* from = band.flux.data();
  for (int y = 0; y < band.height; ++y) {
    float* to = image.pixels.data() + image.index(band.left, band.top + y);
    for (int x = 0; x < band.width; ++x, ++from) {
      sum += *from;
      const auto flux = static_cast<float>(*from);
      for (std::size_t c = 0; c < 3; ++c) *to++ += g[c] * flux;
    }
  }
  return sum * (gain[0] + gain[1] + gain[2]);
}

}  // namespace

Result<void> check_splatting(const PlannedFrame& planned, int points) {
  constexpr int kMost = PolynomialRenderOptions::kMostPoints;
  if (points < 0 || points > kMost)
    return invalid_argument(fmt::format("the number of points a side is out of range; choose one up to {}", kMost));
  const auto refused = [](const char* what) {
    return failure(ErrorCode::Unsupported, fmt::format("random points cannot draw {}; leave `points` at 0", what));
  };
  if (planned.settings.ringing.mode != RingingMode::None) return refused("ringing");
  if (planned.plan.dirt) return refused("dirt");
  const auto& field = planned.lens.iris.field;
  if (field && field->has_half_tones()) return refused("an iris with half-tones");
  return {};
}

Result<DrawnFlare> splat_ghosts(const PlannedFrame& planned, int points, const pupils::FittedGhosts& fitted,
                                const Context& context) {
  const auto start = Clock::now();
  const Frame& frame = planned.settings.frame;
  Context quiet = context;
  quiet.progress = {};
  const auto plan = with_adaptive_passes(planned.plan, planned.lens, frame, quiet);
  if (!plan) return interrupted();
  const Scene scene{planned.lens, *plan,   StepsByWavelength(planned.lens, plan->tables), IrisShape(planned.lens.iris),
                    &fitted,      &context};
  adaptive::Work work;
  const std::vector<Item> items = find_items(scene, quiet, work);
  if (context.cancelled()) return interrupted();
  const double bound_ms = ms_since(start);

  DrawnFlare flare;
  RenderStatistics& stats = flare.statistics;
  stats.rays = work.rays;
  stats.surface_hits = work.surface_hits;
  LayerImages images(*plan, frame);
  const BandSplatter splatter(scene, frame, points);
  const std::vector<Band> bands = bands_of(*plan, items, points);
  double light = 0.0, traced = 0.0;
  const bool done = ordered_pipeline(
      bands.size(), context, [&](std::size_t k) { return splatter.draw(bands[k], context); },
      [&](std::size_t k, const SplattedBand& drawn) {
        const Item& item = *bands[k].item;
        const double added = add_to(images.at(item.layer), drawn, item.adjustment->tinted(bands[k].pass->gain));
        light += added;
        if (!item.is_fitted) traced += added;
        stats.rays += drawn.rays;
        stats.surface_hits += drawn.surface_hits;
        stats.primitives += drawn.lit;
      });
  if (!done || context.cancelled()) return interrupted();

  images.move_to(flare);
  stats.traced_flux = light > 0.0 ? traced / light : 0.0;
  stats.ghosts_rendered = static_cast<int>(plan->ghosts.size());
  stats.ghosts_skipped_flux = plan->skipped_flux;
  const double total_ms = ms_since(start);
  stats.time_ms = {{"bound", bound_ms}, {"points", total_ms - bound_ms}, {"total", total_ms}};
  return flare;
}

}  // namespace contrejour::inline internal
