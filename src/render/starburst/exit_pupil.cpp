// SPDX-License-Identifier: Apache-2.0
// The exit pupil in direction cosines. Only a few rays are traced. Whether a point is open depends on the points where
// its ray meets the stop and the rims that vignette; these are smooth functions of the cosines, so polynomials through
// them give borders as sharp as the mask.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "base/tasks.h"
#include "contrejour/expert/check_lens.h"
#include "contrejour/expert/iris_field.h"
#include "contrejour/expert/lens_starburst.h"
#include "render/starburst/mask_points.h"
#include "render/starburst/pupil_dirt.h"
#include "render/starburst/pupil_outline.h"
#include "render/starburst/pupil_rays.h"
#include "render/starburst/smooth_fit.h"

namespace contrejour {
namespace {

constexpr int kDegree = 8;            // of the points at the stop and the rims
constexpr int kAmplitudeDegree = 4;
constexpr double kFitBeyond = 0.06;   // relative radii: rays up to this far outside are used in the fit
constexpr double kNearRim = 0.05;     // a rim this close to the outermost rays may cut the pupil between them
constexpr double kObscures = 3.0;  // radii of an obscuration, plus one: a small one may lie between the rays
constexpr double kUncertain = 0.02;   // relative radii, added to twice the linear model's own error
constexpr int kMinSamples = 16, kMaxSamples = 4096;
constexpr std::size_t kKeptRays = 5;
constexpr int kShadeStep = 8;  // samples

// The points at the stop, then at each rim that vignettes, as functions of the cosines: x and y of each.
class Borders {
 public:
  Borders(const PupilRays& pupil, const std::vector<std::size_t>& used, std::vector<std::size_t> rims, const Iris& iris,
          int degree)
      : iris_(iris), opening_(iris), rims_(std::move(rims)), exact_(fit(pupil, used, degree)) {
    for (const std::size_t rim : rims_) blocks_within_.push_back(pupil.blocks_within[rim]);
    const SmoothFit straight = fit(pupil, used, 1);
    for (std::size_t f = 0; f < straight.functions(); ++f) {
      const double at_zero = straight({}, f);
      straight_.push_back({at_zero, {straight({1.0, 0.0}, f) - at_zero, straight({0.0, 1.0}, f) - at_zero}});
    }
    // The linear model's largest error determines where the polynomials have to be evaluated.
    std::vector<double> smooth(exact_.functions());
    double worst = 0.0;
    for (const std::size_t k : used) {
      exact_.evaluate(pupil.rays[k].cosines, smooth.data());
      for (std::size_t f = 0; f < smooth.size(); ++f)
        worst = std::max(worst, std::abs(smooth[f] - straight_[f].at(pupil.rays[k].cosines)));
    }
    uncertain_ = 2.0 * worst + kUncertain;
    values_per_point_ = exact_.functions();
  }

  // The signed distance from the border, in cosines; far from the border only its sign is right.
  [[nodiscard]] double distance(Vec2 cosines) const {
    Values here, right, up;  // filled only as far as they are read
    for (std::size_t f = 0; f < straight_.size(); ++f) here[f] = straight_[f].at(cosines);
    const double about = largest(here);
    if (std::abs(about) > uncertain_) return std::copysign(kFar, about);
    exact_.evaluate(cosines, here.data());
    const double level_here = largest(here);
    if (std::abs(level_here) > kNearBorder) return std::copysign(kFar, level_here);
    exact_.evaluate(cosines + Vec2{kStep, 0.0}, right.data());
    exact_.evaluate(cosines + Vec2{0.0, kStep}, up.data());
    double worst = -kFar;
    for (std::size_t c = 0; c < values_per_point_ / 2; ++c) {
      const double g = level(here, c);
      const Vec2 gradient = Vec2{level(right, c) - g, level(up, c) - g} * (1.0 / kStep);
      worst = std::max(worst, g / std::max(length(gradient), 1e-12));
    }
    return worst;
  }

  // The largest distance between fitted and traced points for a ray, over the stop and the rims.
  [[nodiscard]] double error_at(const PupilRays& pupil, std::size_t ray) const {
    Values values{};
    exact_.evaluate(pupil.rays[ray].cosines, values.data());
    double worst = length(pupil.rays[ray].stop - Vec2{values[0], values[1]});
    for (std::size_t r = 0; r < rims_.size(); ++r)
      worst = std::max(worst, length(pupil.at_rim(rims_[r], ray) - Vec2{values[2 * r + 2], values[2 * r + 3]}));
    return worst;
  }

  static constexpr std::size_t kMaxRims = 15;

 private:
  static constexpr double kFar = 1e3;
  static constexpr double kStep = 1e-6;  // cosines
  static constexpr double kNearBorder = 0.03;  // relative radii: several samples, within which the distance matters
  struct Straight {
    double at_zero;
    Vec2 slope;
    [[nodiscard]] double at(Vec2 cosines) const { return at_zero + dot(slope, cosines); }
  };
  using Values = std::array<double, 2 * (kMaxRims + 1)>;

  SmoothFit fit(const PupilRays& pupil, const std::vector<std::size_t>& used, int degree) const {
    std::vector<Vec2> points;
    std::vector<double> values;
    const auto add = [&](auto position_of) {
      for (const std::size_t k : used) values.push_back(position_of(k).x);
      for (const std::size_t k : used) values.push_back(position_of(k).y);
    };
    for (const std::size_t k : used) points.push_back(pupil.rays[k].cosines);
    add([&](std::size_t k) { return pupil.rays[k].stop; });
    for (const std::size_t rim : rims_) add([&](std::size_t k) { return pupil.at_rim(rim, k); });
    return {points, values, degree};
  }

  // How far a point lies outside the iris (0) or a rim (1 and more), or within an obscuration, in relative radii.
  [[nodiscard]] double level(const Values& values, std::size_t constraint) const {
    const Vec2 at{values[2 * constraint], values[2 * constraint + 1]};
    if (constraint > 0) return blocks_within_[constraint - 1] ? 1.0 - length(at) : length(at) - 1.0;
    return iris_.field ? iris_distance(iris_, at) : opening_.bound_distance(at);
  }
  [[nodiscard]] double largest(const Values& values) const {
    double worst = level(values, 0);
    for (std::size_t c = 1; c < values_per_point_ / 2; ++c) worst = std::max(worst, level(values, c));
    return worst;
  }

  const Iris& iris_;
  IrisOpening opening_;
  std::vector<std::size_t> rims_;
  std::vector<bool> blocks_within_;  // by rim
  SmoothFit exact_;
  std::vector<Straight> straight_;
  double uncertain_ = 0;
  std::size_t values_per_point_ = 0;
};

// The rims that cut the pupil, or nearly do: the outermost rays that the iris lets pass decide, or the rays closest to
// an obscuration's middle. Returns at most Borders::kMaxRims, the closest first.
std::vector<std::size_t> vignetting_rims(const PupilRays& pupil) {
  std::vector<std::pair<double, std::size_t>> found;
  for (std::size_t rim = 0; rim < pupil.rims; ++rim) {
    double farthest = 0.0;
    for (std::size_t k = 0; k < pupil.rays.size(); ++k)
      if (pupil.rays[k].arrived && pupil.rays[k].iris < kNearRim)
        farthest = std::max(farthest, pupil.blocks_within[rim] ? kObscures - length(pupil.at_rim(rim, k))
                                                               : length(pupil.at_rim(rim, k)));
    if (farthest > 1.0 - kNearRim) found.emplace_back(-farthest, rim);
  }
  std::sort(found.begin(), found.end());
  found.resize(std::min(found.size(), Borders::kMaxRims));
  std::vector<std::size_t> rims;
  for (const auto& [farthest, rim] : found) rims.push_back(rim);
  return rims;
}

std::vector<std::size_t> rays_within(const PupilRays& pupil, double beyond) {
  std::vector<std::size_t> used;
  for (std::size_t k = 0; k < pupil.rays.size(); ++k)
    if (pupil.rays[k].arrived && pupil.rays[k].blocked <= beyond) used.push_back(k);
  return used;
}

int degree_for(std::size_t rays, int wanted) {
  while (wanted > 0 && SmoothFit::terms(wanted) * SmoothFit::kPointsPerTerm > rays) --wanted;
  return wanted;
}

std::vector<std::size_t> open_rays(const PupilRays& pupil) {
  std::vector<std::size_t> open = rays_within(pupil, 0.0);
  std::erase_if(open, [&](std::size_t k) { return pupil.rays[k].obscured > 0.0; });
  return open;
}

// Includes the neighbours of open rays: the border lies between an open ray and a blocked one.
void grow_over_neighbours(const PupilRays& pupil, Vec2& low, Vec2& high) {
  const int side = pupil.side;
  const auto open = [&](int x, int y) {
    const PupilRay& ray = pupil.rays[static_cast<std::size_t>(y * side + x)];
    return ray.arrived && ray.blocked <= 0.0;
  };
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      bool next_to_open = false;
      for (int j = std::max(0, y - 1); j <= std::min(side - 1, y + 1); ++j)
        for (int i = std::max(0, x - 1); i <= std::min(side - 1, x + 1); ++i) next_to_open = next_to_open || open(i, j);
      const PupilRay& ray = pupil.rays[static_cast<std::size_t>(y * side + x)];
      if (!next_to_open || !ray.arrived) continue;
      low = {std::min(low.x, ray.cosines.x), std::min(low.y, ray.cosines.y)};
      high = {std::max(high.x, ray.cosines.x), std::max(high.y, ray.cosines.y)};
    }
  }
}

// The square root of the flux per unit area of direction cosines: transmittance times |d entrance / d cosines|
// (radiometry.md).
SmoothFit amplitude_of(const PupilRays& pupil, const std::vector<std::size_t>& used, double shared_flux) {
  std::vector<Vec2> points;
  std::vector<double> entrance, amplitude;
  for (const std::size_t k : used) points.push_back(pupil.rays[k].cosines);
  for (const std::size_t k : used) entrance.push_back(pupil.rays[k].entrance_mm.x);
  for (const std::size_t k : used) entrance.push_back(pupil.rays[k].entrance_mm.y);
  const SmoothFit from(points, entrance, degree_for(used.size(), kDegree));
  constexpr double h = 1e-6;
  for (const std::size_t k : used) {
    const Vec2 at = pupil.rays[k].cosines;
    const auto along = [&](Vec2 step) {
      return Vec2{from(at + step, 0) - from(at - step, 0), from(at + step, 1) - from(at - step, 1)} * (0.5 / h);
    };
    const double density = std::abs(cross(along({h, 0.0}), along({0.0, h})));
    amplitude.push_back(std::sqrt(pupil.rays[k].transmission * shared_flux * density));
  }
  return {points, amplitude, degree_for(used.size(), kAmplitudeDegree)};
}

void keep_rays(const PupilRays& pupil, const std::vector<std::size_t>& open, ExitPupil& out) {
  const std::size_t count = std::min(kKeptRays, open.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2 at = pupil.rays[open[(2 * i + 1) * open.size() / (2 * count)]].entrance_mm;
    out.rays_mm.push_back({at.x, at.y, pupil.z_mm});
  }
}

// Fills in the mask's amplitudes and the flux, normalised to a mean of 1 over the outline. Returns the mask's power.
double shade(const SmoothFit& amplitude, double area, ExitPupil& out) {
  const MaskGrid& grid = out.mask.grid;
  // Linear interpolation between knots, kShadeStep samples apart: its error is at most 1e-4.
  const int knots = grid.side / kShadeStep + 2;
  std::vector<double> at_knot;
  for (int row = 0; row < knots; ++row)
    for (int column = 0; column < knots; ++column)
      at_knot.push_back(std::max(0.0, amplitude(out.middle + grid.position_mm(column * kShadeStep, row * kShadeStep))));
  double sum = 0.0, squares = 0.0;
  std::size_t k = 0;
  for (int row = 0; row < grid.side; ++row) {
    for (int column = 0; column < grid.side; ++column, ++k) {
      float& value = out.mask.amplitude[k];
      if (value <= 0.0F) continue;
      const double* const knot = at_knot.data() + (row / kShadeStep) * knots + column / kShadeStep;
      const double s = static_cast<double>(column % kShadeStep) / kShadeStep;
      const double t = static_cast<double>(row % kShadeStep) / kShadeStep;
      const double here =
          (1.0 - t) * ((1.0 - s) * knot[0] + s * knot[1]) + t * ((1.0 - s) * knot[knots] + s * knot[knots + 1]);
      squares += value * here * here;
      value *= static_cast<float>(here);
      sum += value;
    }
  }
  const double sample = grid.pitch_mm * grid.pitch_mm;
  out.flux_mm2 = squares * sample;
  const double mean = sum * sample / area;
  if (!(mean > 0.0)) return 0.0;
  for (float& value : out.mask.amplitude) value /= static_cast<float>(mean);
  return out.flux_mm2 / (mean * mean);
}

// Half-tones of a picture, after hullin2011 3.2: multiplies the amplitude of each sample by the square root of its
// transmittance. Returns the remaining fraction of the mask's power.
double dim_by_half_tones(const Iris& iris, const PupilRays& pupil, const std::vector<std::size_t>& used, int degree,
                         ExitPupil& out) {
  if (!iris.field || !iris.field->has_half_tones()) return 1.0;
  std::vector<Vec2> cosines, stops;
  for (const std::size_t k : used) cosines.push_back(pupil.rays[k].cosines);
  for (const std::size_t k : used) stops.push_back(pupil.rays[k].stop);
  const MaskGrid& grid = out.mask.grid;
  const MaskPoints points(cosines, stops, degree, out.middle, grid);
  double all = 0.0, passed = 0.0;
  std::size_t k = 0;
  for (int row = 0; row < grid.side; ++row) {
    for (int column = 0; column < grid.side; ++column, ++k) {
      float& value = out.mask.amplitude[k];
      if (!(value > 0.0F)) continue;
      const double transmittance = iris_transmittance(iris, points.at(column, row), points.sample());
      all += static_cast<double>(value) * value;
      passed += transmittance * value * value;
      value *= static_cast<float>(std::sqrt(transmittance));
    }
  }
  out.flux_mm2 *= passed / all;
  return passed / all;
}

Result<void> check(const LensState& lens, const LightSource& light, double lambda_nm, int samples_across) {
  if (!is_wavelength(lambda_nm))
    return failure(ErrorCode::InvalidArgument, fmt::format("no light has a wavelength of {} nm", lambda_nm));
  if (samples_across < kMinSamples || samples_across > kMaxSamples)
    return failure(ErrorCode::InvalidArgument,
                   fmt::format("{} samples across the pupil are out of range; choose {} to {}", samples_across,
                               kMinSamples, kMaxSamples));
  if (auto good = check_lens(lens); !good) return good;
  return check_source(lens, light);
}

ExitPupil pupil_of(const PupilRays& pupil, const LensState& lens, const LightSource& light, int samples_across,
                   const Context& context) {
  ExitPupil out;
  const std::vector<std::size_t> open = open_rays(pupil), used = rays_within(pupil, kFitBeyond);
  const int degree = degree_for(used.size(), kDegree);
  if (open.size() < SmoothFit::kPointsPerTerm * SmoothFit::terms(1) || degree < 1) return out;
  const std::vector<std::size_t> rims = vignetting_rims(pupil);

  std::vector<std::size_t> fitted, held_out;
  for (std::size_t k = 0; k < used.size(); ++k) (k % 5 == 2 ? held_out : fitted).push_back(used[k]);
  const Borders borders(pupil, fitted, rims, lens.iris, degree_for(fitted.size(), kDegree));
  for (const std::size_t k : held_out)
    if (pupil.rays[k].blocked <= kNearRim) out.fit_error = std::max(out.fit_error, borders.error_at(pupil, k));

  constexpr double kHuge = std::numeric_limits<double>::max();
  Vec2 low{kHuge, kHuge}, high{-kHuge, -kHuge};
  grow_over_neighbours(pupil, low, high);
  out.middle = (low + high) * 0.5;
  out.radius = 0.5 * std::max(high.x - low.x, high.y - low.y);
  out.mask = make_mask(
      grid_over(out.radius, samples_across), [&](Vec2 at) { return borders.distance(out.middle + at); }, context);

  double open_samples = 0.0;
  for (const float transmittance : out.mask.amplitude) open_samples += transmittance;
  if (!(open_samples > 0.0)) return {};
  const double open_area = open_samples * out.mask.grid.pitch_mm * out.mask.grid.pitch_mm;
  out.outline = outline_of(pupil, {rims, open, used}, lens.iris, open_area);
  double power_mm2 =
      shade(amplitude_of(pupil, used, light.shared_flux()), out.outline ? out.outline->area_mm2() : open_area, out);
  power_mm2 *= dim_by_half_tones(lens.iris, pupil, used, degree, out);
  add_dirt(lens, light, pupil, used, degree, power_mm2, out);
  keep_rays(pupil, open, out);
  return out;
}

}  // namespace

Result<ExitPupil> exit_pupil(const LensState& lens, const LightSource& light, double lambda_nm, int samples_across,
                             const Context& context) {
  if (const auto good = check(lens, light, lambda_nm, samples_across); !good) return tl::unexpected(good.error());
  Context quiet = context;
  quiet.progress = {};
  const LightSource along(normalized(light.direction), light.distance_mm);
  const auto pupil = trace_pupil(lens, IrisOpening(lens.iris), along, lambda_nm, quiet);
  if (context.cancelled()) return interrupted();
  ExitPupil out;
  if (pupil) out = pupil_of(*pupil, lens, along, samples_across, quiet);
  if (context.cancelled()) return interrupted();
  return out;
}

}  // namespace contrejour
