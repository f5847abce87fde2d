// SPDX-License-Identifier: Apache-2.0
// Discs from the ghosts of a lens: where a fit of photographs of it starts. Ghosts are drawn, not only traced: wide
// open, most of a ghost's footprint may be a faint skirt around the body that a picture shows.
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <tuple>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "contrejour/expert/first_order.h"
#include "contrejour/expert/flare_layers.h"
#include "contrejour/expert/learn_lens.h"
#include "contrejour/expert/trace.h"

namespace contrejour {
namespace {

constexpr int kAngles = 8;  // at which ghosts are drawn
constexpr std::size_t kFewestAngles = 3;
constexpr int kWidth = 320, kWavelengths = 3;
constexpr double kDrawingError = 0.003;
constexpr int kDrawnForEachDisc = 2;  // ghosts: many are larger than the picture
constexpr double kBrightLight = 0.25;  // the part of a ghost's light that lies in pixels above its bright level
constexpr double kBody = 0.3;          // of that level: what belongs to the ghost's body
// A ghost that is larger than this part of the picture's width shows no edge; one that is smaller than this has no
// outline, and is found as a spot.
constexpr double kLargest = 0.6, kSmallest = 0.006;

// A ghost's body in one picture, in pixels.
struct Body {
  double centre_x = 0, radius = 0, level = 0;
};

double grey_of(const Image& image, std::size_t k) {
  return static_cast<double>(image.pixels[3 * k] + image.pixels[3 * k + 1] + image.pixels[3 * k + 2]);
}

double bright_level(const Image& image) {
  std::vector<double> values;
  double all = 0.0, sum = 0.0;
  for (std::size_t k = 0; 3 * k < image.pixels.size(); ++k) {
    values.push_back(grey_of(image, k));
    all += values.back();
  }
  std::ranges::sort(values, std::greater());
  for (const double value : values) {
    sum += value;
    if (sum > kBrightLight * all) return value;
  }
  return 0.0;
}

// None if the ghost has no light in the picture, or if its body leaves it.
std::optional<Body> body_of(const FlareLayer& layer, const Frame& frame) {
  Body body;
  body.level = bright_level(layer.image);
  if (!(body.level > 0.0)) return std::nullopt;
  double count = 0.0, x1 = 0.0, y2 = 0.0;
  for (int y = 0; y < layer.image.height; ++y) {
    for (int x = 0; x < layer.image.width; ++x) {
      const std::size_t k =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(layer.image.width) + static_cast<std::size_t>(x);
      if (grey_of(layer.image, k) < kBody * body.level) continue;
      const int u = layer.left + x, v = layer.top + y;
      if (u == 0 || v == 0 || u == frame.width - 1 || v == frame.height - 1) return std::nullopt;
      ++count;
      x1 += u + 0.5;
      y2 += std::pow(v + 0.5 - 0.5 * frame.height, 2);
    }
  }
  body.centre_x = x1 / count;
  body.radius = 2.0 * std::sqrt(y2 / count);  // an even disc's
  return body;
}

// A ghost at one angle, in tangents.
struct SeenDisc {
  double s = 0, centre = 0, radius = 0, level = 0;
};

// y = a + b s^2, by least squares.
std::pair<double, double> even_fit(const std::vector<SeenDisc>& seen, double (*value)(const SeenDisc&)) {
  Eigen::Matrix2d a = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  for (const SeenDisc& one : seen) {
    const Eigen::Vector2d row{1.0, one.s * one.s};
    a += row * row.transpose();
    b += row * value(one);
  }
  const Eigen::Vector2d x = a.ldlt().solve(b);
  return {x[0], x[1]};
}

FoundGhost disc_of(const std::vector<SeenDisc>& seen) {
  FoundGhost found;
  std::tie(found.speed, found.bend) = even_fit(seen, [](const SeenDisc& one) { return one.centre / one.s; });
  const auto [radius, change] = even_fit(seen, [](const SeenDisc& one) { return one.radius; });
  found.radius = std::max(radius, 0.0);
  found.growth = found.radius > 0.0 ? change / found.radius : 0.0;
  found.first = seen.front().s;
  found.last = seen.back().s;
  return found;
}

// The lights at which the ghosts are drawn: their images lie at these tangents to the right of the middle.
struct DrawnAngles {
  FrameSettings settings;
  std::vector<double> s;
  std::vector<Light> lights;
  double focal_px = 0;
};

DrawnAngles drawn_angles(const LensState& lens, double largest_angle_rad) {
  DrawnAngles all;
  Frame& frame = all.settings.frame;
  frame = frame_on_sensor(lens, kWidth,
                          std::max(1, static_cast<int>(kWidth * lens.sensor_height_mm / lens.sensor_width_mm)));
  all.settings.wavelengths = kWavelengths;
  all.focal_px = first_order(lens, lens.design_wavelength_nm).focal_length_mm / frame.pixel_pitch_mm;
  for (int k = 1; k <= kAngles; ++k) {
    all.s.push_back(std::tan(largest_angle_rad) * k / kAngles);
    const Vec2 image{0.5 * frame.width + all.s.back() * all.focal_px, 0.5 * frame.height};
    Light light;
    light.direction = direction_for_image_point(lens, frame.sensor_from_pixel(image), lens.design_wavelength_nm);
    all.lights.push_back(light);
  }
  return all;
}

// The brightest first: by their levels, which are what a picture shows, in the mean of all angles.
std::vector<FoundGhost> ranked_discs(const std::vector<std::vector<SeenDisc>>& ghosts, const DrawnAngles& angles,
                                     std::size_t most) {
  std::vector<std::pair<double, FoundGhost>> ranked;
  for (const std::vector<SeenDisc>& seen : ghosts) {
    if (seen.size() < kFewestAngles) continue;
    const FoundGhost found = disc_of(seen);
    const double part = 2.0 * found.radius * angles.focal_px / kWidth;
    if (part > kLargest || part < kSmallest) continue;
    double level = 0.0;
    for (const SeenDisc& one : seen) level += one.level;
    ranked.emplace_back(level, found);
  }
  std::ranges::stable_sort(ranked, std::greater(), &std::pair<double, FoundGhost>::first);
  std::vector<FoundGhost> discs;
  for (std::size_t k = 0; k < std::min(most, ranked.size()); ++k) discs.push_back(ranked[k].second);
  return discs;
}

}  // namespace

Result<std::vector<FoundGhost>> discs_of_lens(const LensState& lens, double largest_angle_rad, int most,
                                              const Context& context) {
  if (!(largest_angle_rad > 0.0 && largest_angle_rad < 1.5) || most < 1)
    return invalid_argument("discs of a lens: an angle between 0 and 1.5 rad and one ghost or more are needed");
  const DrawnAngles angles = drawn_angles(lens, largest_angle_rad);
  LayerOptions options;
  options.by = LayersBy::Ghost;
  options.ghost_count = kDrawnForEachDisc * most;
  const Context quiet{context.threads, context.cancel, {}};
  const auto ghosts = brightest_ghosts(lens, angles.lights, angles.settings, options, quiet);
  if (!ghosts) return tl::unexpected(ghosts.error());
  options.ghosts = *ghosts;
  AdaptiveOptions method;
  method.error = kDrawingError;
  std::vector<std::vector<SeenDisc>> seen(ghosts->size());
  for (std::size_t k = 0; k < angles.lights.size(); ++k) {
    const auto flare = render_layers(method, lens, std::span(&angles.lights[k], 1), angles.settings, options, quiet);
    if (!flare) return tl::unexpected(flare.error());
    for (const FlareLayer& layer : flare->layers) {
      const auto at = std::ranges::find_if(*ghosts, [&](const Ghost& g) { return layer_name(g) == layer.name; });
      const auto body = body_of(layer, angles.settings.frame);
      if (at == ghosts->end() || !body) continue;
      seen[static_cast<std::size_t>(at - ghosts->begin())].push_back(
          {angles.s[k], (body->centre_x - 0.5 * angles.settings.frame.width) / angles.focal_px,
           body->radius / angles.focal_px, body->level});
    }
  }
  return ranked_discs(seen, angles, static_cast<std::size_t>(most));
}

}  // namespace contrejour
