// SPDX-License-Identifier: Apache-2.0
#include "render/starburst/area_spread.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/tasks.h"
#include "render/area_lights/image_motion.h"
#include "render/area_lights/image_pyramid.h"
#include "render/area_lights/kernel.h"

namespace contrejour::inline internal {
namespace {

using namespace area;

// The smallest size, in pixels of the coarsest level, of the finest features of a light's shape.
constexpr double kFeaturePixels = 16.0;
constexpr double kOutlinePixels = 32.0;  // pixels of the shape's shorter radius when its features are measured
// The distances from a point's image, in pixels of a level, between which the next coarser level takes over: there the
// pattern is far wider than a pixel.
constexpr double kFadeFrom = 4.0, kFadeTo = 10.0;
// The largest numbers of products of kernel and picture: of all lights together, and the least that each light is
// granted. Where there would be more, pixels are made larger.
constexpr double kMaxProducts = 6e8, kMinProducts = 3e7;

// A light, its shape, and how the shape lies on the frame.
struct Area {
  std::size_t light = 0;
  LightPiece piece;
  LinearMap px_from_tangents;
  Vec2 centre_px;
  Rgb flux{};
};

// A level's weight as a function of the distance from a point's image; the weights of all levels sum to 1.
struct LevelRange {
  int level = 0, finest = 0, coarsest = 0;

  [[nodiscard]] double at(double r_px) const {
    return (level == coarsest ? 1.0 : within(level, r_px)) - (level == finest ? 0.0 : within(level - 1, r_px));
  }
  [[nodiscard]] double radius_px() const {
    return level == coarsest ? std::numeric_limits<double>::infinity() : kFadeTo * std::exp2(level);
  }

 private:
  static double within(int level, double r_px) {
    const double t = std::clamp((r_px * std::exp2(-level) - kFadeFrom) / (kFadeTo - kFadeFrom), 0.0, 1.0);
    return 1.0 - t * t * (3.0 - 2.0 * t);
  }
};

int level_of_width(double px) { return px < 1.0 ? 0 : std::min(static_cast<int>(std::log2(px)), kLevels - 1); }

// A rectangle of pixels.
struct Window {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

double farthest_corner(Vec2 from, int width, int height) {
  return length(Vec2{std::max(std::abs(from.x), std::abs(width - from.x)),
                     std::max(std::abs(from.y), std::abs(height - from.y))});
}

double weight_at(const Kernel& kernel, int x, int y) {
  const Rgb& w =
      kernel
          .weight[static_cast<std::size_t>(y) * static_cast<std::size_t>(kernel.width()) + static_cast<std::size_t>(x)];
  return w[0] + w[1] + w[2];
}

// Twice the shape's light over its total variation, in pixels of the kernel: the radius of a disc, also if there are
// several like discs with gaps between them; the width of a strip.
double feature_radius(const Kernel& kernel) {
  double light = 0.0, variation = 0.0;
  for (int y = 0; y + 1 < kernel.height(); ++y) {
    for (int x = 0; x + 1 < kernel.width(); ++x) {
      const double here = weight_at(kernel, x, y);
      light += here;
      variation += std::hypot(weight_at(kernel, x + 1, y) - here, weight_at(kernel, x, y + 1) - here);
    }
  }
  return variation > 0.0 ? 2.0 * light / variation : 0.0;
}

// The levels at which a light is drawn: as coarse as its features allow, and coarser if there would be too many
// products.
LevelRange levels_of(const Area& area, const Frame& frame, double max_products) {
  const Vec2 e = eigenvalues(mapped_covariance(area.px_from_tangents, area.piece.covariance));
  const int level = level_of_width(2.0 * std::sqrt(std::max(e.x, 0.0)) / kOutlinePixels);
  const Kernel kernel = make_kernel(area.piece, area.px_from_tangents * std::exp2(-level), {});
  const auto lit =
      static_cast<double>(std::ranges::count_if(kernel.weight, [](const Rgb& w) { return w[0] + w[1] + w[2] > 0.0; }));
  const double pixels = static_cast<double>(frame.width) * frame.height;
  const auto products = [&](int at, double across_px) {
    const double of_picture = std::min(across_px * across_px, pixels * std::exp2(-2 * at));
    return std::max(1.0, lit * std::exp2(2 * (level - at))) * of_picture;
  };
  LevelRange levels{0, 0, level_of_width(feature_radius(kernel) * std::exp2(level) / kFeaturePixels)};
  while (levels.coarsest + 1 < kLevels && products(levels.coarsest, std::sqrt(pixels)) > max_products)
    ++levels.coarsest;
  while (levels.finest < levels.coarsest && products(levels.finest, 2.0 * kFadeTo) > max_products) ++levels.finest;
  return levels;
}

// The pixels of the frame within a radius plus the kernel's reach on each side.
Window window_about(Vec2 centre, double radius, KernelExtent margin, const Frame& frame) {
  const auto within = [](double v, int largest) {
    return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(largest)));
  };
  const int across = margin.left + margin.right, down = margin.up + margin.down;
  return {within(std::floor(centre.x - radius) - across, frame.width),
          within(std::floor(centre.y - radius) - down, frame.height),
          within(std::ceil(centre.x + radius) + across, frame.width),
          within(std::ceil(centre.y + radius) + down, frame.height)};
}

// The middle of the pixel that a point lies in.
Vec2 middle_of_pixel(Vec2 at) { return {std::floor(at.x) + 0.5, std::floor(at.y) + 0.5}; }

// A point's spread at one level, times the level's weight, blurred by the light's shape. A spread much narrower than a
// pixel lies in one pixel, wherever in it the point is, so the spread is drawn at that pixel's middle, and the kernel
// moves it to where the point is.
Result<void> add_level(ImagePyramid& pyramid, const Area& area, const LevelRange& levels, double pitch_mm,
                       const AddPointSpread& add_point, const Context& context) {
  const double scale = std::exp2(levels.level);
  const LinearMap map = area.px_from_tangents * (1.0 / scale);
  const KernelExtent extent = extent_of(area.piece, map);
  const PyramidFrame at = pyramid.frame_for(levels.level, extent);
  const Vec2 centre =
      area.centre_px * (1.0 / scale) - Vec2{static_cast<double>(at.left), static_cast<double>(at.top)} + at.moved;
  const Window window = window_about(centre, levels.radius_px() / scale, extent, at.frame);
  if (window.x0 >= window.x1 || window.y0 >= window.y1) return {};
  Image part(window.x1 - window.x0, window.y1 - window.y0);
  const Vec2 exact = centre - Vec2{static_cast<double>(window.x0), static_cast<double>(window.y0)};
  const Vec2 in_part = middle_of_pixel(exact);
  const double farthest_px = std::min(farthest_corner(in_part, part.width, part.height), levels.radius_px() / scale);
  if (auto ok = add_point(part, area.light, {pitch_mm * scale, 2.0 + farthest_px}, in_part, area.flux); !ok) return ok;
  parallel_for(static_cast<std::size_t>(part.height), context, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < part.width; ++x)
      for (int c = 0; c < 3; ++c)
        part.at(x, y, c) *= static_cast<float>(levels.at(scale * length(Vec2{x + 0.5, y + 0.5} - in_part)));
  });
  pyramid.add({part, window.x0, window.y0}, at,
              make_kernel(area.piece, map, at.moved + in_part - exact, smooth_variance(levels.level)), 0.0, context);
  return {};
}

Result<void> add_area(ImagePyramid& pyramid, const Area& area, const Frame& frame, double max_products,
                      const AddPointSpread& add_point, const Context& context) {
  LevelRange levels = levels_of(area, frame, max_products);
  for (levels.level = levels.finest; levels.level <= levels.coarsest; ++levels.level)
    if (auto ok = add_level(pyramid, area, levels, frame.pixel_pitch_mm, add_point, context); !ok) return ok;
  return {};
}

}  // namespace

Result<void> add_area_spread(Image& image, std::span<const ImagedLight> areas, std::size_t area_count,
                             const LensState& lens, std::span<const Light> lights, const Frame& frame,
                             const AddPointSpread& add_point, const Context& context) {
  if (areas.empty()) return {};
  ImagePyramid pyramid(frame, Upsampling::Smooth);
  const double max_products = std::max(kMaxProducts / static_cast<double>(area_count), kMinProducts);
  for (const ImagedLight& imaged : areas) {
    const Light& light = lights[imaged.light];
    Area area;
    area.light = imaged.light;
    area.piece = pieces_of(light, 1).front();
    area.px_from_tangents = image_motion_px(lens, frame, light.source());
    area.centre_px = imaged.centre_px + area.px_from_tangents(area.piece.middle);
    area.flux = imaged.flux;
    if (auto ok = add_area(pyramid, area, frame, max_products, add_point, context); !ok) return ok;
    if (context.cancelled()) return interrupted();
  }
  const Image sum = std::move(pyramid).flattened(context);
  parallel_for(static_cast<std::size_t>(image.height), context, [&](std::size_t row) {
    const auto to = image.row(static_cast<int>(row));
    const auto from = sum.row(static_cast<int>(row));
    for (std::size_t k = 0; k < to.size(); ++k) to[k] += from[k];
  });
  return {};
}

}  // namespace contrejour::inline internal
