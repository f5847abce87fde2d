// SPDX-License-Identifier: Apache-2.0
// Shapes of dirt from statistics. The plane is divided into squares, each with its own hashed numbers, so that nothing
// depends on the part of the plane that is requested, and the k-th speck of a square is the same at any density.
#include "contrejour/expert/dirt.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/scalar.h"
#include "base/split_mix.h"

namespace contrejour {
namespace {

constexpr double kCell_mm = 2.0;
constexpr double kFarthest_mm = 1e4;
constexpr double kMaxOutlineSteps = 1e4;  // along an outline
constexpr double kMaxDeviations = 2.5;  // of a log-normal size
constexpr double kElongation = 0.8;  // of specks: largest length of the line within one, over its width
constexpr double kNearlyStraight = 1e-6;  // rad

enum class Kind : std::uint64_t { Dust = 1, Scratch = 2 };

std::uint64_t mixed(std::uint64_t z) { return split_mix(z + kSplitMixIncrement); }

// The random numbers of one shape or square, in order, from 0 to below 1.
class Numbers {
 public:
  Numbers(const Dirt& dirt, Kind kind, int ix, int iy, std::uint64_t which) {
    state_ = mixed(dirt.seed);
    state_ = mixed(state_ ^ static_cast<std::uint64_t>(kind));
    state_ = mixed(state_ ^ static_cast<std::uint32_t>(ix));
    state_ = mixed(state_ ^ (static_cast<std::uint64_t>(static_cast<std::uint32_t>(iy)) << 32U));
    state_ = mixed(state_ ^ which);
  }
  double next() {
    state_ = mixed(state_);
    return unit_interval(state_);
  }
  double next_signed() { return 2.0 * next() - 1.0; }
  // A normally distributed number (Box & Muller 1958), clipped to the range of sizes.
  double next_normal() {
    const double r = std::sqrt(-2.0 * std::log(1.0 - next()));
    return std::clamp(r * std::cos(2.0 * kPi * next()), -kMaxDeviations, kMaxDeviations);
  }
  double next_size(double median) { return median * std::exp(Dirt::kSizeSpread * next_normal()); }

 private:
  std::uint64_t state_ = 0;
};

// A Poisson-distributed count by inversion: for a fixed number it never falls as the mean rises.
int poisson(double mean, double number) {
  int count = 0;
  double probability = std::exp(-mean);
  double below = probability;
  const int max_count = static_cast<int>(mean + 12.0 * std::sqrt(mean) + 12.0);
  while (number >= below && count < max_count) {
    ++count;
    probability *= mean / count;
    below += probability;
  }
  return count;
}

// The sum of two sines with whole numbers of periods, 0 at time 0, with an amplitude of about 1.
double wandering(double phase, Numbers& numbers) {
  double sum = 0.0;
  for (const double tone : {1.0, 2.0}) {
    const double start = numbers.next();
    sum += 0.5 * (std::sin(2.0 * kPi * (tone * phase + start)) - std::sin(2.0 * kPi * start));
  }
  return sum;
}

// The largest size over the median.
double largest_over_median() { return std::exp(Dirt::kSizeSpread * kMaxDeviations); }

class DirtGenerator {
 public:
  DirtGenerator(const Dirt& dirt, Vec2 low, Vec2 high) : dirt_(dirt), low_(low), high_(high) {}

  void add(Kind kind, double per_cm2, double outer_radius_mm) {
    if (!(per_cm2 > 0.0)) return;
    const double mean = per_cm2 * kCell_mm * kCell_mm * 0.01;
    const double around = outer_radius_mm + 2.0 * dirt_.drift_mm;
    const auto cell_of = [](double mm) { return static_cast<int>(std::floor(mm / kCell_mm)); };
    for (int iy = cell_of(low_.y - around); iy <= cell_of(high_.y + around); ++iy) {
      for (int ix = cell_of(low_.x - around); ix <= cell_of(high_.x + around); ++ix) {
        Numbers own(dirt_, kind, ix, iy, 0);
        const int count = poisson(mean, own.next());
        for (int k = 1; k <= count; ++k) add_one(kind, ix, iy, k);
      }
    }
  }

  [[nodiscard]] std::vector<DirtStroke> take() { return std::move(strokes_); }

 private:
  void add_one(Kind kind, int ix, int iy, int which) {
    Numbers own(dirt_, kind, ix, iy, static_cast<std::uint64_t>(which));
    DirtStroke s;
    s.middle_mm.x = (ix + own.next()) * kCell_mm;
    s.middle_mm.y = (iy + own.next()) * kCell_mm;
    s.opacity = dirt_.opacity;
    if (kind == Kind::Dust) {
      s.angle_rad = kPi * own.next();
      s.width_mm = own.next_size(dirt_.dust_mm);
      // On average the area is that of a round speck of that diameter.
      s.length_mm = kElongation * own.next() * s.width_mm;
      const double area = 0.25 * kPi * s.width_mm * s.width_mm;
      const double scale = std::sqrt(area / (area + s.length_mm * s.width_mm));
      s.width_mm *= scale;
      s.length_mm *= scale;
    } else {
      s.angle_rad = dirt_.scratch_angle_rad + dirt_.scratch_spread_rad * own.next_signed();
      s.length_mm = own.next_size(dirt_.scratch_length_mm);
      s.width_mm = own.next_size(dirt_.scratch_width_mm);
      s.bend_rad = dirt_.scratch_bend_rad * own.next_signed();
    }
    if (dirt_.phase != 0.0) {
      const double turns = dirt_.phase - std::floor(dirt_.phase);
      s.middle_mm.x += dirt_.drift_mm * wandering(turns, own);
      s.middle_mm.y += dirt_.drift_mm * wandering(turns, own);
    }
    const double outer_radius = s.outer_radius_mm();
    if (s.middle_mm.x + outer_radius < low_.x || s.middle_mm.x - outer_radius > high_.x ||
        s.middle_mm.y + outer_radius < low_.y || s.middle_mm.y - outer_radius > high_.y)
      return;
    strokes_.push_back(s);
  }

  const Dirt& dirt_;
  Vec2 low_, high_;
  std::vector<DirtStroke> strokes_;
};

}  // namespace

Vec2 DirtStroke::at(double fraction) const {
  const Vec2 along{std::cos(angle_rad), std::sin(angle_rad)};
  const double s = fraction * length_mm;
  if (std::abs(bend_rad) < kNearlyStraight || length_mm <= 0.0) return middle_mm + along * s;
  // On a circle of curvature c: (sin(c s) / c, (1 - cos(c s)) / c).
  const double angle = fraction * bend_rad, radius = length_mm / bend_rad;
  const double half = std::sin(0.5 * angle);
  return middle_mm + along * (radius * std::sin(angle)) + Vec2{-along.y, along.x} * (2.0 * radius * half * half);
}

Vec2 DirtStroke::normal_at(double fraction) const {
  const double angle = angle_rad + fraction * bend_rad;
  return {-std::sin(angle), std::cos(angle)};
}

Vec2 DirtStroke::along_and_across_mm(Vec2 point_mm) const {
  const Vec2 along{std::cos(angle_rad), std::sin(angle_rad)};
  const Vec2 from = point_mm - middle_mm;
  const Vec2 own{dot(along, from), cross(along, from)};
  if (std::abs(bend_rad) < kNearlyStraight || length_mm <= 0.0) return own;
  const double radius = length_mm / bend_rad;  // signed: the circle's centre lies to the left or right
  const Vec2 from_centre{own.x, own.y - radius};
  const double angle = std::atan2(from_centre.x, std::copysign(1.0, radius) * -from_centre.y);
  return {angle * std::abs(radius), std::copysign(1.0, radius) * (std::abs(radius) - length(from_centre))};
}

double DirtStroke::distance_mm(Vec2 point_mm) const {
  const Vec2 own = along_and_across_mm(point_mm);
  if (std::abs(bend_rad) < kNearlyStraight || length_mm <= 0.0) {
    const double beyond = std::max(0.0, std::abs(own.x) - 0.5 * length_mm);
    return std::hypot(beyond, own.y) - 0.5 * width_mm;
  }
  if (std::abs(own.x) <= 0.5 * length_mm) return std::abs(own.y) - 0.5 * width_mm;
  const double end = own.x > 0.0 ? 0.5 : -0.5;
  return std::min(length(point_mm - at(end)), length(point_mm - at(-end))) - 0.5 * width_mm;
}

Result<void> check_dirt(const Dirt& dirt) {
  const auto bad = [](const char* what, double value) {
    return failure(ErrorCode::InvalidArgument, fmt::format("dirt cannot have {} of {}", what, value));
  };
  const auto within = [](double value, double low, double high) { return value >= low && value <= high; };
  if (!within(dirt.dust_per_cm2, 0.0, Dirt::kMaxDustPerCm2)) return bad("specks per cm^2", dirt.dust_per_cm2);
  if (!within(dirt.scratches_per_cm2, 0.0, Dirt::kMaxScratchesPerCm2))
    return bad("scratches per cm^2", dirt.scratches_per_cm2);
  if (!within(dirt.dust_mm, 1e-4, Dirt::kWidest_mm)) return bad("specks, in mm,", dirt.dust_mm);
  if (!within(dirt.scratch_length_mm, 1e-4, Dirt::kLongest_mm)) return bad("scratches, in mm,", dirt.scratch_length_mm);
  if (!within(dirt.scratch_width_mm, 1e-4, Dirt::kWidest_mm))
    return bad("scratches' widths, in mm,", dirt.scratch_width_mm);
  if (!std::isfinite(dirt.scratch_angle_rad)) return bad("an angle", dirt.scratch_angle_rad);
  if (!within(dirt.scratch_spread_rad, 0.0, kPi)) return bad("a spread of angles", dirt.scratch_spread_rad);
  if (!within(dirt.scratch_bend_rad, 0.0, kPi)) return bad("a bend", dirt.scratch_bend_rad);
  if (!within(dirt.opacity, 0.0, 1.0)) return bad("an opacity", dirt.opacity);
  if (!within(dirt.drift_mm, 0.0, Dirt::kFarthestDrift_mm)) return bad("a drift, in mm,", dirt.drift_mm);
  if (!std::isfinite(dirt.phase)) return bad("a time", dirt.phase);
  return {};
}

std::vector<DirtStroke> dirt_within(const Dirt& dirt, Vec2 low_mm, Vec2 high_mm) {
  const auto is_near = [](Vec2 p) { return std::abs(p.x) <= kFarthest_mm && std::abs(p.y) <= kFarthest_mm; };
  if (!check_dirt(dirt) || !(dirt.opacity > 0.0) || !is_near(low_mm) || !is_near(high_mm)) return {};
  DirtGenerator maker(dirt, low_mm, high_mm);
  const double largest = largest_over_median();
  maker.add(Kind::Dust, dirt.dust_per_cm2, largest * dirt.dust_mm);
  maker.add(Kind::Scratch, dirt.scratches_per_cm2, 0.5 * largest * (dirt.scratch_length_mm + dirt.scratch_width_mm));
  return maker.take();
}

std::vector<Vec2> dirt_outline(const DirtStroke& stroke, double low, double high) {
  constexpr int kEndSteps = 8;  // over half a turn: the error is 1 - cos(pi / 16) of half a width
  constexpr double kStep_rad = 0.05;  // along a curved line
  const double half = 0.5 * stroke.width_mm;
  const double wanted = std::ceil((high - low) * std::abs(stroke.bend_rad) / kStep_rad);
  const int steps = wanted >= 1.0 ? static_cast<int>(std::min(wanted, kMaxOutlineSteps)) : 1;
  std::vector<Vec2> outline;
  const auto add_side = [&](double from, double to, double side) {
    for (int i = 0; i <= steps; ++i) {
      const double fraction = from + (to - from) * i / steps;
      outline.push_back(stroke.at(fraction) + stroke.normal_at(fraction) * (side * half));
    }
  };
  const auto add_end = [&](double fraction, double side) {  // from one side to the other, end points excluded
    const Vec2 n = stroke.normal_at(fraction) * (side * half);
    const Vec2 out = Vec2{-n.y, n.x};
    for (int i = 1; i < kEndSteps; ++i) {
      const double a = kPi * i / kEndSteps;
      outline.push_back(stroke.at(fraction) + n * std::cos(a) + out * std::sin(a));
    }
  };
  add_side(low, high, -1.0);
  if (high >= 0.5) add_end(0.5, -1.0);
  add_side(high, low, 1.0);
  if (low <= -0.5) add_end(-0.5, 1.0);
  return outline;
}

}  // namespace contrejour
