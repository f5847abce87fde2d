#include "render/area/blur_classes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "render/area/layers.h"

namespace contrejour::area {
namespace {

// Lengths below are radii of a disc: twice the standard deviation along a line.
constexpr double kSharp_px = 0.8;      // a blur of this radius does not show
constexpr double kRadiusPixels = 2.5;  // a blur's radius in pixels of its level, where ghosts are larger than it
constexpr double kSpotPixels = 6.0;    // where they are much smaller, so that the light's shape shows
constexpr double kLongest = 30.0;      // its longer radius, whatever the shorter one is
constexpr double kAlike = 0.12;        // blurs that differ by this share of the radius are taken as one,
constexpr double kAlike_px = 0.5;      // or by so many pixels of the frame; darker ghosts' by more,
constexpr double kDark = 0.5;          // from this share of the peak on,
constexpr double kDarkest = 0.005;     // and from this one any
constexpr double kDim = 0.1;           // below, no spot shows the light's outline
constexpr double kLargestBlur = 3.0;   // diagonals of the frame: more shows no more
constexpr double kPeakShare = 0.002;   // of the frame that is brighter than the peak

struct Blur {
  std::size_t ghost = 0;
  LinearMap px;            // of the frame, from tangents
  double radius = 0.0;     // across the longer axis
  int level = 0, coarsest = 0;
  double area_px = 0.0;    // of the blurred ghost, about
  double density = 0.0;    // before it is blurred
  double brightness = 0.0;  // after; 0: it lies beside the frame
};

// Radii across the shorter and the longer axis.
Vec2 radii(const LinearMap& covariance) {
  const Vec2 e = eigenvalues(covariance);
  return {2.0 * std::sqrt(std::max(e.x, 0.0)), 2.0 * std::sqrt(std::max(e.y, 0.0))};
}

// Pixels may be as wide as what they show is smooth: blur and ghost, whichever is the larger, but a spot shows the
// light's own outline.
int level_for(Vec2 blur_px, double ghost_px) {
  const double finest = blur_px.x / kSpotPixels, coarsest = blur_px.x / kRadiusPixels;
  const double width = std::max(std::clamp(ghost_px / kRadiusPixels, finest, coarsest), blur_px.y / kLongest);
  return width < 1.0 ? 0 : std::min(static_cast<int>(std::log2(width)), kLevels - 1);
}

// Sensor mm to pixels: x is mirrored.
LinearMap pixels_from(const LinearMap& mm, double pitch_mm) {
  const double s = 1.0 / pitch_mm;
  return {{-mm.x.x * s, mm.x.y * s}, {-mm.y.x * s, mm.y.y * s}};
}

double apart(const LinearMap& a, const LinearMap& b, const LightPiece& piece) {
  return 2.0 * std::sqrt(std::max(trace_of(mapped_covariance(a - b, piece.covariance)), 0.0));
}

bool touches(const Frame& frame, Vec2 at_mm, double radius_px) {
  const Vec2 px = frame.pixel_from_sensor(at_mm);
  return px.x > -radius_px && px.y > -radius_px && px.x < frame.width + radius_px && px.y < frame.height + radius_px;
}

Blur blur_of(std::size_t ghost, const GhostMotion& motion, const LightPiece& piece, const Frame& frame) {
  Blur blur;
  blur.ghost = ghost;
  if (!(motion.density > 0.0)) {
    blur.px = kNowhere;
    return blur;
  }
  blur.px = pixels_from(motion.shift_mm, frame.pixel_pitch_mm);
  // A disc looks the same turned and mirrored: the map's symmetric part says it all.
  if (piece.is_disc) blur.px = square_root(blur.px * transposed(blur.px));
  Vec2 blurred = radii(mapped_covariance(blur.px, piece.covariance));
  const double largest = kLargestBlur * std::hypot(frame.width, frame.height);
  if (blurred.y > largest) {
    blur.px = blur.px * (largest / blurred.y);
    blurred = blurred * (largest / blurred.y);
  }
  blur.radius = blurred.y;
  const LinearMap spread = pixels_from(motion.spread_mm, frame.pixel_pitch_mm);
  const Vec2 size = radii(spread * transposed(spread) * 0.25);
  blur.level = level_for(blurred, size.x);
  blur.coarsest = level_for(blurred, blurred.x);
  const double ghost_px = std::numbers::pi * size.x * size.y;
  blur.area_px = ghost_px + std::numbers::pi * blurred.x * blurred.y + 1.0;
  blur.density = motion.density;
  // Twice as far as first derivatives say: ghosts are larger than that where they are not sharp.
  if (touches(frame, motion.at_mm, 2.0 * (size.y + blurred.y)))
    blur.brightness = motion.density * (ghost_px + 1.0) / blur.area_px;
  return blur;
}

// The brightness of the ghosts that together fill kPeakShare of the frame, the brightest first.
double peak_of(const std::vector<Blur>& by_brightness, const Frame& frame) {
  double left_px = kPeakShare * frame.width * frame.height;
  for (const Blur& blur : by_brightness) {
    left_px -= blur.area_px;
    if (left_px <= 0.0) return blur.brightness;
  }
  return by_brightness.empty() ? 0.0 : by_brightness.back().brightness;
}

struct Group {
  Blur seed;
  LinearMap px = kNowhere;  // times weights
  double weight = 0.0;
  double density = 0.0;
  std::vector<std::size_t> ghosts;

  void add(const Blur& blur) {
    const double w = std::max(blur.brightness, 1e-30);
    px = px + blur.px * w;
    weight += w;
    density = std::max(density, blur.density);
    ghosts.push_back(blur.ghost);
  }
};

// The group whose blur is the nearest, of those that will do.
Group* group_for(const Blur& blur, std::vector<Group>& groups, const LightPiece& piece, double peak) {
  const bool any = blur.brightness <= kDarkest * peak;
  const double darker = any ? 0.0 : std::max(1.0, kDark * peak / blur.brightness);
  Group* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (Group& group : groups) {
    const double off = apart(group.seed.px, blur.px, piece);
    const double alike = std::max(kAlike_px, kAlike * darker * std::max(blur.radius, group.seed.radius));
    const bool fits = any || (off <= alike && group.seed.level <= blur.level && group.seed.level >= blur.level - 1);
    if (!fits || !(off < least)) continue;
    least = off;
    best = &group;
  }
  return best;
}

}  // namespace

std::vector<BlurClass> blur_classes(std::span<const Ghost> ghosts, std::span<const GhostMotion> motions,
                                    const LightPiece& piece, const Frame& frame) {
  std::vector<Blur> blurs;
  for (std::size_t g = 0; g < ghosts.size(); ++g) blurs.push_back(blur_of(g, motions[g], piece, frame));
  std::stable_sort(blurs.begin(), blurs.end(),
                   [](const Blur& a, const Blur& b) { return a.brightness > b.brightness; });
  const double peak = peak_of(blurs, frame);
  std::vector<Group> groups;
  for (Blur& blur : blurs) {
    if (blur.brightness < kDim * peak)
      blur.level = std::min(blur.coarsest + (blur.radius > kAlike_px * 4.0 ? 1 : 0), kLevels - 1);
    Group* group = group_for(blur, groups, piece, peak);
    if (group == nullptr) group = &groups.emplace_back(Group{blur, kNowhere, 0.0, 0.0, {}});
    group->add(blur);
  }

  std::vector<BlurClass> classes;
  for (Group& group : groups) {
    BlurClass made;
    made.is_sharp = group.seed.radius < kSharp_px;
    made.level = group.seed.level;
    made.px_from_tangents = group.px * (std::exp2(-made.level) / group.weight);
    made.room = group.density > 0.0 ? std::max(1.0, peak / group.density) : 1.0;
    std::sort(group.ghosts.begin(), group.ghosts.end());
    for (const std::size_t g : group.ghosts) made.ghosts.push_back(ghosts[g]);
    classes.push_back(std::move(made));
  }
  return classes;
}

}  // namespace contrejour::area
