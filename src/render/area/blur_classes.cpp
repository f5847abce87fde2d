#include "render/area/blur_classes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "render/area/blur_error.h"

namespace contrejour::area {
namespace {

// Lengths below are radii of a disc: twice the standard deviation along a line.
constexpr double kSharp_px = 0.8;      // a blur of this radius does not show
constexpr double kLargestBlur = 3.0;   // diagonals of the frame: more shows no more
constexpr double kPeakShare = 0.002;   // of the frame that is brighter than the peak
constexpr int kPeakCells = 40;         // across the frame, for what ghosts over one another add up to
constexpr double kLevelShare = 0.1;    // of the allowed squared error: what coarse pixels may make,
constexpr double kMisfitShare = 0.03;  // and a ghost by another blur than its own
constexpr double kPixelsCost = 0.3;    // what drawing a ghost in the frame's pixels is worth of the latter

struct Blur {
  std::size_t ghost = 0;
  LinearMap px;            // of the frame, from tangents
  BlurredGhost seen;
  int level = 0;
  Vec2 at_px;
  double area_px = 0.0;    // of the blurred ghost, about
  double density = 0.0;    // before it is blurred
  double brightness = 0.0;  // after; 0: it lies beside the frame
};

// Radii across the shorter and the longer axis.
Vec2 radii(const LinearMap& covariance) {
  const Vec2 e = eigenvalues(covariance);
  return {2.0 * std::sqrt(std::max(e.x, 0.0)), 2.0 * std::sqrt(std::max(e.y, 0.0))};
}

// Sensor mm to pixels: x is mirrored.
LinearMap pixels_from(const LinearMap& mm, double pitch_mm) {
  const double s = 1.0 / pitch_mm;
  return {{-mm.x.x * s, mm.x.y * s}, {-mm.y.x * s, mm.y.y * s}};
}

double apart(const LinearMap& a, const LinearMap& b, const LightPiece& piece) {
  return 2.0 * std::sqrt(std::max(trace_of(mapped_covariance(a - b, piece.covariance)), 0.0));
}

bool touches(const Frame& frame, Vec2 px, double radius_px) {
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
  const LinearMap spread = pixels_from(motion.spread_mm, frame.pixel_pitch_mm);
  const Vec2 size = radii(spread * transposed(spread) * 0.25);
  blur.seen.blur_px = blurred;
  blur.seen.size_px = size;
  blur.at_px = frame.pixel_from_sensor(motion.at_mm);
  const double ghost_px = std::numbers::pi * size.x * size.y;
  blur.area_px = ghost_px + std::numbers::pi * blurred.x * blurred.y + 1.0;
  blur.density = motion.density;
  // Twice as far as first derivatives say: ghosts are larger than that where they are not sharp.
  if (touches(frame, blur.at_px, 2.0 * (size.y + blurred.y)))
    blur.brightness = motion.density * (ghost_px + 1.0) / blur.area_px;
  return blur;
}

// The brightness of the ghosts that together fill kPeakShare of the frame, the brightest first.
double brightest(const std::vector<Blur>& by_brightness, const Frame& frame) {
  double left_px = kPeakShare * frame.width * frame.height;
  for (const Blur& blur : by_brightness) {
    left_px -= blur.area_px;
    if (left_px <= 0.0) return blur.brightness;
  }
  return by_brightness.empty() ? 0.0 : by_brightness.back().brightness;
}

// What ghosts add up to where they lie over one another, each an even disc, in the cells of a small frame.
double brightest_sum(const std::vector<Blur>& blurs, const Frame& frame) {
  const double cell = static_cast<double>(std::max(frame.width, frame.height)) / kPeakCells;
  const int columns = std::max(1, static_cast<int>(frame.width / cell));
  const int rows = std::max(1, static_cast<int>(frame.height / cell));
  std::vector<double> sums(static_cast<std::size_t>(columns * rows), 0.0);
  const auto within = [](double at, int count) { return static_cast<int>(std::clamp(at, 0.0, count - 1.0)); };
  for (const Blur& blur : blurs) {
    if (!(blur.brightness > 0.0)) continue;
    const Vec2 at = blur.at_px * (1.0 / cell) - Vec2{0.5, 0.5};
    const double radius = std::sqrt(blur.area_px / std::numbers::pi) / cell;
    for (int y = within(at.y - radius, rows); y <= within(at.y + radius, rows); ++y)
      for (int x = within(at.x - radius, columns); x <= within(at.x + radius, columns); ++x)
        if (length(Vec2{x - at.x, y - at.y}) <= radius)
          sums[static_cast<std::size_t>(y * columns + x)] += blur.brightness;
  }
  const auto nth =
      sums.begin() + static_cast<std::ptrdiff_t>((1.0 - kPeakShare) * static_cast<double>(sums.size() - 1));
  std::nth_element(sums.begin(), nth, sums.end());
  return *nth;
}

void set_levels(std::vector<Blur>& blurs, double peak, double allowed_squares) {
  std::vector<BlurredGhost> ghosts;
  for (Blur& blur : blurs) {
    blur.seen.level = peak > 0.0 ? blur.brightness / peak : 0.0;
    ghosts.push_back(blur.seen);
  }
  const std::vector<int> levels = levels_of(ghosts, allowed_squares);
  for (std::size_t k = 0; k < blurs.size(); ++k) blurs[k].level = levels[k];
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

// Of the groups that will do the one that costs least: error, and work, which grows with a level's pixels.
Group* group_for(const Blur& blur, std::vector<Group>& groups, const LightPiece& piece, double allowed_squares) {
  Group* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (Group& group : groups) {
    const int level = group.seed.level;
    const double coarse = level > blur.level ? level_error(blur.seen, level) : 0.0;
    const double error = misfit_error(blur.seen, apart(group.seed.px, blur.px, piece)) + coarse;
    const double cost = error / allowed_squares + kPixelsCost * std::exp2(-2 * level);
    if (!(error <= allowed_squares && cost < least)) continue;
    least = cost;
    best = &group;
  }
  return best;
}

}  // namespace

std::vector<BlurClass> blur_classes(std::span<const Ghost> ghosts, std::span<const GhostMotion> motions,
                                    const LightPiece& piece, const Frame& frame, double allowed_squares) {
  std::vector<Blur> blurs;
  for (std::size_t g = 0; g < ghosts.size(); ++g) blurs.push_back(blur_of(g, motions[g], piece, frame));
  std::stable_sort(blurs.begin(), blurs.end(),
                   [](const Blur& a, const Blur& b) { return a.brightness > b.brightness; });
  const double peak = std::max(brightest(blurs, frame), brightest_sum(blurs, frame));
  set_levels(blurs, peak, kLevelShare * allowed_squares);
  std::vector<Group> groups;
  for (const Blur& blur : blurs) {
    Group* group = group_for(blur, groups, piece, kMisfitShare * allowed_squares);
    if (group == nullptr) group = &groups.emplace_back(Group{blur, kNowhere, 0.0, 0.0, {}});
    group->add(blur);
  }

  std::vector<BlurClass> classes;
  for (Group& group : groups) {
    BlurClass made;
    made.is_sharp = group.seed.seen.blur_px.y < kSharp_px;
    made.level = group.seed.level;
    made.px_from_tangents = group.px * (std::exp2(-made.level) / group.weight);
    made.peak = peak;
    made.room = group.density > 0.0 ? std::max(1.0, peak / group.density) : 1.0;
    std::sort(group.ghosts.begin(), group.ghosts.end());
    for (const std::size_t g : group.ghosts) made.ghosts.push_back(ghosts[g]);
    classes.push_back(std::move(made));
  }
  return classes;
}

}  // namespace contrejour::area
