// SPDX-License-Identifier: Apache-2.0
#include "diffraction/starburst_pattern.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/scalar.h"
#include "base/tasks.h"
#include "diffraction/starburst_rings.h"

namespace contrejour::inline internal {
namespace {

constexpr double kSampleRho = 0.45;  // fringes are at least 1 apart: samples of an average are closer
// The transition from spectrum to edge waves, in samples across: where aliases of the edges are below 1 per cent; with
// dirt, which only the spectrum has, where they are 10. A picture has no edge waves.
constexpr double kTailEnd = 0.12, kTailEndWithDirt = 0.35, kTailEndOfPicture = 1.0;
constexpr double kTailFade = 0.625;  // of that, the beginning of the transition
constexpr double kCleanWithin = 2e-3;  // relative: the error of samples at edges
constexpr double kScatteredFrom = 0.7;  // of the tail's end: the spectrum from here on is extrapolated beyond
constexpr double kGrainRho = 1.0;  // distance between its samples, equal to its width
constexpr int kModelSamples = 6;  // fewer samples of the model, which is smooth
constexpr double kMinGrain = 0.25, kMaxGrain = 4.0;  // of the sum over shapes, due to interference
constexpr std::size_t kSharpStrokes = 16;  // the brightest: if many lie together, none is sharp
constexpr int kRowsPerStep = 4;  // between which the tail times rho^3 is interpolated

Vec2 along_angle(double angle_rad) { return {std::cos(angle_rad), std::sin(angle_rad)}; }

// Directions about a central one, and radii along each.
struct Sector {
  double angle_rad, window_rad;
  Vec2 along;  // the central direction
  int across, down;
};

// Mean of value(rho, x, y) over a sector's samples, rho = radius(fraction). A real mask's spectrum is equal at opposite
// points; the half plane x >= 0 is stored.
template <class Radius, class Value>
double sector_mean(const Sector& sector, Radius radius, Value value) {
  double sum = 0.0;
  for (int j = 0; j < sector.across; ++j) {
    Vec2 along = sector.along;
    if (sector.across > 1)
      along = along_angle(sector.angle_rad + sector.window_rad * ((j + 0.5) / sector.across - 0.5));
    const auto [x, y] = along.x < 0.0 ? along * -1.0 : along;
    for (int i = 0; i < sector.down; ++i) {
      const double rho = radius((i + 0.5) / sector.down);
      sum += value(rho, rho * x, rho * y);
    }
  }
  return sum / (sector.across * sector.down);
}

// Samples at an edge have their open fraction s as amplitude, so their power is s^2 instead of s. The mean of s - s^2
// is 1/6. The perimeter of a foreshortened shape is approximated by that of a uniformly scaled one of equal area.
double power_lost_at_edges(const PupilMask& mask, const PupilOutline& outline) {
  const double size_mm = std::sqrt(std::abs(cross(outline.x_mm, outline.y_mm)));
  double edges_mm = outline.opening.perimeter() * size_mm;
  for (const double area : outline.obscured_mm2) edges_mm += 2.0 * std::sqrt(kPi * area);
  return 1.0 + edges_mm * mask.grid.pitch_mm / (6.0 * outline.area_mm2());
}

// Obscurations are treated like specks of dirt, in units in which the pupil's radius is this.
constexpr double kObscurationUnits = 16.0;

std::optional<DirtWaves> waves_of_obscurations(const PupilOutline& outline, double pupil_radius_mm) {
  if (outline.obscured_mm2.empty()) return std::nullopt;
  std::vector<DirtStroke> discs;
  for (const double area : outline.obscured_mm2) {
    DirtStroke disc;
    disc.width_mm = 2.0 * std::sqrt(area / kPi) * kObscurationUnits / pupil_radius_mm;
    discs.push_back(disc);
  }
  return DirtWaves(discs);
}

double power_of(const PupilMask& mask, const PupilOutline* outline) {
  if (outline && outline->dirt) return outline->dirt->power_mm2;
  return mask.open_area_mm2() * (outline ? power_lost_at_edges(mask, *outline) : 1.0);
}

// The mean amplitude over the opening: 1 if only the opening's own edges dim the mask.
double mean_amplitude(const PupilMask& mask, const PupilOutline& outline) {
  double sum = 0.0;
  for (const float a : mask.amplitude) sum += a;
  return sum * mask.grid.pitch_mm * mask.grid.pitch_mm / outline.area_mm2();
}

// A direction in the plane of a shape whose unit vectors are x and y in the mask.
struct Foreshortened {
  double angle_rad, stretch;
  double angle_ratio;  // change of angles there over here
};
Foreshortened foreshortened_by(Vec2 x, Vec2 y, double angle_rad) {
  const Vec2 along{std::cos(angle_rad), std::sin(angle_rad)};
  const Vec2 own{dot(x, along), dot(y, along)};
  const double stretch = length(own);
  return {std::atan2(own.y, own.x), stretch, std::abs(cross(x, y)) / (stretch * stretch)};
}

}  // namespace

StarburstPattern::StarburstPattern(const PupilMask& mask, const PupilOutline* outline, double pupil_radius_mm,
                                   const Context& context)
    : across_(2.0 * pupil_radius_mm / mask.grid.pitch_mm), power_mm2_(power_of(mask, outline)),
      clean_(outline && !outline->dirt && std::abs(mean_amplitude(mask, *outline) - 1.0) < kCleanWithin),
      grid_(mask, pupil_radius_mm,
            across_ * (clean_    ? kTailEnd
                       : outline ? kTailEndWithDirt
                                 : kTailEndOfPicture),
            power_mm2_, outline != nullptr, context) {
  tail_end_ = grid_.up_to();
  tail_start_ = tail_end_ * kTailFade;
  if (!outline) return;
  edges_.emplace(outline->opening, outline->slope_spread_rad, context);
  outline_x_ = outline->x_mm * (1.0 / pupil_radius_mm);
  outline_y_ = outline->y_mm * (1.0 / pupil_radius_mm);
  // |F|^2 in stop radii, over 4 for d^2 rho = 4 d^2 f, over the mask's power; the edges' part by the mean amplitude.
  const double amplitude = mean_amplitude(mask, *outline) * std::abs(cross(outline_x_, outline_y_));
  edge_scale_ = amplitude * amplitude * pupil_radius_mm * pupil_radius_mm / (4.0 * power_mm2_);
  obscurations_ = waves_of_obscurations(*outline, pupil_radius_mm);
  const double own_area = 1.0 / (kObscurationUnits * kObscurationUnits);
  obscurations_scale_ = square(mean_amplitude(mask, *outline) * own_area * pupil_radius_mm) / (4.0 * power_mm2_);
  if (!outline->dirt) return;
  const PupilDirt& dirt = *outline->dirt;
  dirt_.emplace(dirt.strokes);
  dirt_x_ = dirt.x_mm * (1.0 / pupil_radius_mm);
  dirt_y_ = dirt.y_mm * (1.0 / pupil_radius_mm);
  dirt_scale_ = square(cross(dirt_x_, dirt_y_) * pupil_radius_mm) / (4.0 * power_mm2_);
  measure_grain(context);
}

// A normal n of a shape whose unit vectors are x and y appears along the u for which (x.u, y.u) is parallel to n.
std::vector<double> StarburstPattern::sharp_directions() const {
  std::vector<double> directions;
  const auto add = [&](const std::vector<double>& normals, Vec2 x, Vec2 y) {
    for (const double normal : normals) {
      const Vec2 n{std::cos(normal), std::sin(normal)};
      const Vec2 u{n.x * y.y - n.y * x.y, n.y * x.x - n.x * y.x};
      directions.push_back(std::atan2(u.y, u.x));
    }
  };
  if (edges_) add(edges_->end_normals(), outline_x_, outline_y_);
  if (dirt_) add(dirt_->brightest_end_normals(kSharpStrokes), dirt_x_, dirt_y_);
  return directions;
}

void StarburstPattern::sample(double angle_rad, double window_rad, double first_rho, int rows, float* out,
                              std::size_t stride) const {
  const bool needs_tail = first_rho * row_ratio(rows) > tail_start_;
  const Tail tail = needs_tail ? tail_along(angle_rad, window_rad) : Tail();
  const Vec2 along = along_angle(angle_rad);
  const double step = row_ratio(1.0);
  int row = 0;
  for (double rho = first_rho; row < rows; ++row, rho *= step) {
    if (rho >= tail_end_) break;
    double value = spectrum_average(angle_rad, along, window_rad, rho);
    const double t = (rho - tail_start_) / (tail_end_ - tail_start_);
    if (t > 0.0) value += t * (tail.times_rho3(rho) / (rho * rho * rho) - value);
    out[static_cast<std::size_t>(row) * stride] = static_cast<float>(value);
  }
  if (row == rows) return;
  double here = tail.times_rho3(first_rho * row_ratio(row));
  for (; row < rows; row += kRowsPerStep) {
    const double next = tail.times_rho3(first_rho * row_ratio(row + kRowsPerStep));
    double rho = first_rho * row_ratio(row);
    for (int i = 0; i < std::min(kRowsPerStep, rows - row); ++i, rho *= step) {
      const double value = here + (next - here) * i / kRowsPerStep;
      out[static_cast<std::size_t>(row + i) * stride] = static_cast<float>(value / (rho * rho * rho));
    }
    here = next;
  }
}

double StarburstPattern::Tail::times_rho3(double rho) const {
  double sum = scattered;
  if (edges) sum += scale * rho * rho * rho * edges->power(kPi * stretch * rho);
  if (obscurations) sum += obscurations_scale * rho * rho * rho * obscurations->power(kPi * rho / kObscurationUnits);
  if (dirt) sum += dirt_scale * rho * rho * rho * dirt->power(kPi * dirt_stretch * rho);
  return sum;
}

// The spectrum at f of a linearly mapped shape is the shape's own spectrum at the transposed map times f, with another
// direction, wave number and width of the window.
void StarburstPattern::add_edges(double angle_rad, double window_rad, Tail& tail) const {
  const Foreshortened foreshortened = foreshortened_by(outline_x_, outline_y_, angle_rad);
  tail.stretch = foreshortened.stretch;
  tail.edges = edges_->along(foreshortened.angle_rad, window_rad * foreshortened.angle_ratio);
  tail.scale = edge_scale_;
  if (!obscurations_) return;
  tail.obscurations = obscurations_->along(angle_rad, window_rad);
  tail.obscurations_scale = obscurations_scale_;
}

void StarburstPattern::add_dirt(double angle_rad, double window_rad, Tail& tail) const {
  const Foreshortened foreshortened = foreshortened_by(dirt_x_, dirt_y_, angle_rad);
  tail.dirt_stretch = foreshortened.stretch;
  tail.dirt = dirt_->along(foreshortened.angle_rad, window_rad * foreshortened.angle_ratio);
  tail.dirt_scale = dirt_scale_;
}

// The excess of the spectrum over the edges is extrapolated beyond its samples. If shapes of dirt are known, it follows
// their sum, times a factor for their interference in this direction, the halo's grain. If not, it falls as rho^-3,
// which keeps its flux in proportion to a rim's.
StarburstPattern::Tail StarburstPattern::tail_along(double angle_rad, double window_rad) const {
  Tail tail;
  if (edges_) add_edges(angle_rad, window_rad, tail);
  if (clean_) return tail;
  if (dirt_) {
    add_dirt(angle_rad, window_rad, tail);
    tail.dirt_scale *= grain_along(angle_rad, window_rad);
    return tail;
  }
  double sum = 0.0;
  int count = 0;
  for (double rho = tail_end_; rho > kScatteredFrom * tail_end_; rho /= row_ratio(1.0), ++count)
    sum +=
        spectrum_average(angle_rad, along_angle(angle_rad), window_rad, rho) * rho * rho * rho - tail.times_rho3(rho);
  tail.scattered = std::max(0.0, sum / count);
  return tail;
}

// Measures the excess of the spectrum over the edges, and the sum over shapes, as means over the spectrum's outermost
// part, in directions as close as the spectrum's samples: starbursts have many times more directions.
void StarburstPattern::measure_grain(const Context& context) {
  const double from = kScatteredFrom * tail_end_, length = tail_end_ - from;
  const auto directions = static_cast<std::size_t>(std::ceil(kPi * tail_end_ / kSampleRho));
  const double window = kPi / static_cast<double>(directions);
  const int down = std::max(1, static_cast<int>(length / kGrainRho));
  std::vector<double> halo(directions), shapes(directions);
  parallel_for(directions, context, [&](std::size_t i) {
    const double angle = (static_cast<double>(i) + 0.5) * window;
    halo[i] = sector_mean(
        {angle, window, along_angle(angle), 1, down}, [&](double fraction) { return from + length * fraction; },
        [&](double rho, double x, double y) { return grid_.density(x, y) * rho * rho * rho; });
    Tail edges, dirt;
    add_edges(angle, window, edges);
    add_dirt(angle, window, dirt);
    for (int k = 0; k < kModelSamples; ++k) {
      const double rho = from + length * (k + 0.5) / kModelSamples;
      halo[i] -= edges.times_rho3(rho) / kModelSamples;
      shapes[i] += dirt.times_rho3(rho) / kModelSamples;
    }
  });
  halo_ = DirectionMeans(halo);
  shapes_ = DirectionMeans(shapes);
}

double StarburstPattern::grain_along(double angle_rad, double window_rad) const {
  const double shapes = shapes_.over(angle_rad, window_rad);
  return shapes > 0.0 ? std::clamp(halo_.over(angle_rad, window_rad) / shapes, kMinGrain, kMaxGrain) : 1.0;
}

double StarburstPattern::spectrum_average(double angle_rad, Vec2 along, double window_rad, double rho) const {
  static const double kHeight = row_ratio(1.0) - 1.0;
  const double height = rho * kHeight, width = rho * window_rad;
  const int down = std::max(1, static_cast<int>(std::ceil(height / kSampleRho)));
  const int across = std::max(1, static_cast<int>(std::ceil(width / kSampleRho)));
  return sector_mean(
      {angle_rad, window_rad, along, across, down},
      [&](double fraction) { return std::min(rho + height * (fraction - 0.5), grid_.up_to()); },
      [&](double, double x, double y) { return grid_.density(x, y); });
}

}  // namespace contrejour::inline internal
