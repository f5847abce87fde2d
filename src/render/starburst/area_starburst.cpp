#include "render/starburst/area_starburst.h"

#include <algorithm>
#include <cmath>

#include "base/tasks.h"
#include "render/area/image_motion.h"
#include "render/area/kernel.h"
#include "render/area/layers.h"

namespace contrejour {
namespace {

using namespace area;

constexpr double kFarPixels =
    2.5;   // the light's radius in pixels of the far part: there the pattern is dark and smooth
constexpr double kNearPixels = 8.0;  // and of the near one, where it shows the light's outline
constexpr double kFadeFrom = 4.0, kFadeTo = 10.0;  // pixels of the far part from the centre

// A light, its shape, and how the shape lies on the frame.
struct Area {
  std::size_t light = 0;
  LightPiece piece;
  LinearMap px_from_tangents;
  Vec2 centre_px;
  Rgb flux{};
};

// The near part's share: 1 at the centre, falling to 0; the far part's is what is left of 1.
struct Fade {
  double from = 0.0, to = 0.0;  // pixels
  bool far = false;
  [[nodiscard]] double at(double r) const {
    const double t = std::clamp((r - from) / (to - from), 0.0, 1.0);
    const double near = 1.0 - t * t * (3.0 - 2.0 * t);
    return far ? 1.0 - near : near;
  }
};

int level_of_width(double px) { return px < 1.0 ? 0 : std::min(static_cast<int>(std::log2(px)), kLevels - 1); }

// A rectangle of pixels.
struct Window {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

Window window_about(Vec2 centre, double radius, int width, int height) {
  const auto within = [](double v, int most) {
    return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(most)));
  };
  return {within(std::floor(centre.x - radius), width), within(std::floor(centre.y - radius), height),
          within(std::ceil(centre.x + radius), width), within(std::ceil(centre.y + radius), height)};
}

double farthest_corner(Vec2 from, int width, int height) {
  return length(Vec2{std::max(std::abs(from.x), std::abs(width - from.x)),
                     std::max(std::abs(from.y), std::abs(height - from.y))});
}

// The pattern at one level, times a fade (null: all of it), blurred.
Result<void> add_part(Layers& layers, const Area& area, int level, const Fade* fade, double pitch_mm,
                      const MakeStarburst& make, const Context& context) {
  const double scale = std::exp2(level);
  const LinearMap map = area.px_from_tangents * (1.0 / scale);
  const LayerFrame at = layers.frame_for(level, reach_of(area.piece, map));
  const Vec2 centre =
      area.centre_px * (1.0 / scale) - Vec2{static_cast<double>(at.left), static_cast<double>(at.top)} + at.moved;
  Window window{0, 0, at.frame.width, at.frame.height};
  if (fade != nullptr && !fade->far) window = window_about(centre, fade->to / scale, at.frame.width, at.frame.height);
  if (window.x0 >= window.x1 || window.y0 >= window.y1) return {};
  Image part(window.x1 - window.x0, window.y1 - window.y0);
  const Vec2 in_part = centre - Vec2{static_cast<double>(window.x0), static_cast<double>(window.y0)};
  const auto starburst = make(area.light, pitch_mm * scale, 1.0 + farthest_corner(in_part, part.width, part.height));
  if (!starburst) return tl::unexpected(starburst.error());
  add_starburst(part, *starburst, in_part, area.flux, context);
  Image picture(at.frame.width, at.frame.height);
  parallel_for(static_cast<std::size_t>(part.height), context, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < part.width; ++x) {
      const double share = fade == nullptr ? 1.0 : fade->at(scale * length(Vec2{x + 0.5, y + 0.5} - in_part));
      for (int c = 0; c < 3; ++c)
        picture.at(window.x0 + x, window.y0 + y, c) = static_cast<float>(share) * part.at(x, y, c);
    }
  });
  layers.add({picture}, at, make_kernel(area.piece, map, at.moved), 0.0, context);
  return {};
}

Result<void> add_area(Layers& layers, const Area& area, double pitch_mm, const MakeStarburst& make,
                      const Context& context) {
  const Vec2 e = eigenvalues(mapped_covariance(area.px_from_tangents, area.piece.covariance));
  const double radius_px = 2.0 * std::sqrt(std::max(e.x, 0.0));
  const int near = level_of_width(radius_px / kNearPixels), far = level_of_width(radius_px / kFarPixels);
  if (near == far) return add_part(layers, area, near, nullptr, pitch_mm, make, context);
  Fade fade{kFadeFrom * std::exp2(far), kFadeTo * std::exp2(far), false};
  if (auto ok = add_part(layers, area, near, &fade, pitch_mm, make, context); !ok) return ok;
  fade.far = true;
  return add_part(layers, area, far, &fade, pitch_mm, make, context);
}

}  // namespace

Result<void> add_area_starbursts(Image& image, std::span<const ImagedLight> areas, const LensState& lens,
                                 std::span<const Light> lights, const RenderSettings& settings,
                                 const MakeStarburst& make, const Context& context) {
  Layers layers(settings.frame);
  for (const ImagedLight& imaged : areas) {
    const Light& light = lights[imaged.light];
    Area area;
    area.light = imaged.light;
    area.piece = pieces_of(light, 1).front();
    area.px_from_tangents = image_motion_px(lens, settings.frame, light.source());
    area.centre_px = imaged.centre_px + area.px_from_tangents(area.piece.middle);
    for (std::size_t c = 0; c < 3; ++c) area.flux[c] = settings.starburst.gain * imaged.flux[c];
    if (auto ok = add_area(layers, area, settings.frame.pixel_pitch_mm, make, context); !ok) return ok;
    if (context.cancelled()) return interrupted();
  }
  const Image sum = std::move(layers).flattened(context);
  parallel_for(static_cast<std::size_t>(image.height), context, [&](std::size_t row) {
    const auto to = image.row(static_cast<int>(row));
    const auto from = sum.row(static_cast<int>(row));
    for (std::size_t k = 0; k < to.size(); ++k) to[k] += from[k];
  });
  return {};
}

}  // namespace contrejour
