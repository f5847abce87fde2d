// SPDX-License-Identifier: Apache-2.0
#include "measure/find/find_ghosts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/tasks.h"
#include "measure/find/station_steps.h"

namespace contrejour::inline internal {
namespace {

constexpr int kSpokes = 14;             // places around a circle where the step is measured
constexpr double kOverCircle = 0.4;     // the quantile of the steps around the circle
constexpr double kVisibleSpokes = 0.4;  // of all, for a station to count
constexpr double kModelPart = 0.1;  // of a pixel's value: what counts as an error
constexpr int kRefinements = 24;
constexpr std::size_t kRefined = 24;  // candidates
constexpr double kRadiusRatio = 1.06;
constexpr std::size_t kMaxPictures = 16;
constexpr double kLightSpeed_px = 4.0;  // ghosts that stay so near the light's image cannot be told from its halo
constexpr double kMinRadius_px = 3.0, kMaxRadius = 0.75;  // smaller ones are sought as spots; of the width
// From the circle to where values are taken. The wider step finds soft borders, and does not say well where a sharp one
// is: it counts for less.
constexpr std::array<double, 2> kStepHalf_px{1.5, 4.0};
constexpr double kWideCounts = 0.8;
constexpr double kSameSpeed_px = 2.0, kSameRadius = 0.08;  // discs nearer than these, where both are, are the same

struct Spokes {
  std::array<double, kSpokes> x{}, y{};
};

Spokes spokes() {
  Spokes all;
  for (int k = 0; k < kSpokes; ++k) {
    const double angle = 2.0 * std::numbers::pi * (k + 0.5) / kSpokes;
    all.x[static_cast<std::size_t>(k)] = std::cos(angle);
    all.y[static_cast<std::size_t>(k)] = std::sin(angle);
  }
  return all;
}

// Between pixels; NaN outside the picture.
float value_at(const Image& image, double x, double y) {
  x -= 0.5;
  y -= 0.5;
  if (!(x >= 0.0 && y >= 0.0 && x < image.width - 1 && y < image.height - 1)) return std::nanf("");
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const auto u = static_cast<float>(x - left), v = static_cast<float>(y - top);
  const float* at = &image.pixels[static_cast<std::size_t>(top) * static_cast<std::size_t>(image.width) +
                                  static_cast<std::size_t>(left)];
  const float* below = at + image.width;
  return (1.0F - v) * ((1.0F - u) * at[0] + u * at[1]) + v * ((1.0F - u) * below[0] + u * below[1]);
}

// The step across a circle in one picture, or NaN where too little of it is seen.
double step_across(const SearchPicture& picture, const Spokes& all, Vec2 centre_px, double radius_px, double half_px) {
  std::array<float, kSpokes> steps{};
  std::size_t seen = 0;
  const double inner = std::max(radius_px - half_px, 0.0), outer = radius_px + half_px;
  for (std::size_t k = 0; k < kSpokes; ++k) {
    const float outside = value_at(picture.value, centre_px.x + outer * all.x[k], centre_px.y + outer * all.y[k]);
    if (std::isnan(outside)) continue;
    const float inside = value_at(picture.value, centre_px.x + inner * all.x[k], centre_px.y + inner * all.y[k]);
    if (!std::isnan(inside)) steps[seen++] = inside - outside;
  }
  if (static_cast<double>(seen) < kVisibleSpokes * kSpokes) return std::nan("");
  const auto at = steps.begin() + static_cast<std::ptrdiff_t>(kOverCircle * static_cast<double>(seen));
  std::nth_element(steps.begin(), at, steps.begin() + static_cast<std::ptrdiff_t>(seen));
  return static_cast<double>(*at);
}

// A candidate, and what all stations together show there, which may be below 0.
struct Disc {
  FoundGhost found;
  double signed_contrast = 0;
};

Disc disc_contrast(std::span<const SearchPicture> pictures, const Spokes& all, const FoundGhost& candidate) {
  StationsContrast best;
  const double start_px = candidate.radius * pictures.front().frame.pixels.focal_length_px;
  for (const double half_px : kStepHalf_px) {
    if (half_px > std::max(1.5, 0.5 * start_px)) break;
    std::vector<StationStep> steps;
    for (const SearchPicture& picture : pictures) {
      const TangentFrame& frame = picture.frame.pixels;
      const double s = picture.s, s2 = s * s;
      const Vec2 along{picture.frame.to_light.x, -picture.frame.to_light.y};
      const double centre = s * (candidate.speed + candidate.bend * s2);
      const double step = step_across(picture, all, frame.centre_px + along * (centre * frame.focal_length_px),
                                      std::max(start_px * (1.0 + candidate.growth * s2), kMinRadius_px), half_px);
      if (!std::isnan(step)) steps.push_back({s, step});
    }
    StationsContrast of_all = contrast_over_stations(steps);
    if (half_px != kStepHalf_px.front()) of_all.contrast *= kWideCounts;
    if (half_px == kStepHalf_px.front() || of_all.contrast > best.contrast) best = of_all;
  }
  Disc disc{candidate, best.signed_contrast};
  disc.found.contrast = best.contrast;
  disc.found.first = best.first;
  disc.found.last = best.last;
  return disc;
}

// A pattern search for the speed, its bend, the radius and its growth of the highest contrast.
FoundGhost refined(std::span<const SearchPicture> pictures, const Spokes& all, FoundGhost best,
                   double max_distance_px) {
  const double s_max = max_distance_px / pictures.front().frame.pixels.focal_length_px;
  std::array<double, 4> step{1.0 / max_distance_px, 2.0 / (max_distance_px * s_max * s_max), 0.05 * best.radius,
                             0.1 / (s_max * s_max)};
  for (int round = 0; round < kRefinements; ++round) {
    bool better = false;
    for (std::size_t k = 0; k < step.size(); ++k) {
      for (const double sign : {-1.0, 1.0}) {
        FoundGhost next = best;
        const std::array<double*, 4> values{&next.speed, &next.bend, &next.radius, &next.growth};
        *values[k] += sign * step[k];
        next = disc_contrast(pictures, all, next).found;
        if (next.contrast <= best.contrast) continue;
        best = next;
        better = true;
      }
    }
    if (!better) {
      for (double& s : step) s *= 0.5;
    }
  }
  return best;
}

std::vector<double> radii_px(double width) {
  std::vector<double> radii{kMinRadius_px};
  while (radii.back() < kMaxRadius * width) radii.push_back(std::max(radii.back() * kRadiusRatio, radii.back() + 0.5));
  return radii;
}

// Whether two discs are at one place with one size at the end of the range where both are.
bool is_same(const FoundGhost& a, const FoundGhost& b, double focal_length_px) {
  const double s = std::min(a.last, b.last), s2 = s * s;
  const double off_px = std::abs(a.speed + a.bend * s2 - b.speed - b.bend * s2) * s * focal_length_px;
  const double radius = b.radius * (1.0 + b.growth * s2), other = a.radius * (1.0 + a.growth * s2);
  return off_px < std::max(kSameSpeed_px, kSameRadius * radius * focal_length_px) &&
         std::abs(other - radius) < std::max(kSameRadius * radius, 1.5 / focal_length_px);
}

// The best of the strongest candidates once each is refined, which the grid of speeds and radii may have ranked
// otherwise. Refined candidates that are known do not count: a coarse one beside them leads to them again. If all of
// the strongest do, because a bright ghost is surrounded by candidates that lead to it, the next ones are refined, down
// to the least contrast.
template <class Refine>
FoundGhost best_refined(std::vector<FoundGhost> candidates, std::span<const FoundGhost> excluded, const Refine& refine,
                        double least, double focal_length_px) {
  std::ranges::stable_sort(candidates, std::greater(), &FoundGhost::contrast);
  FoundGhost best;
  for (std::size_t k = 0; k < candidates.size() && candidates[k].contrast >= least; ++k) {
    if (k % kRefined == 0 && best.contrast > 0.0) break;
    const FoundGhost next = refine(candidates[k]);
    const bool known =
        std::ranges::any_of(excluded, [&](const FoundGhost& other) { return is_same(next, other, focal_length_px); });
    if (!known && next.contrast > best.contrast) best = next;
  }
  return best;
}

// Evenly spaced ones of all pictures.
std::vector<SearchPicture> few_of(std::span<const SearchPicture> pictures) {
  const std::size_t step = (pictures.size() + kMaxPictures - 1) / kMaxPictures;
  std::vector<SearchPicture> few;
  for (std::size_t k = 0; k < pictures.size(); k += step) few.push_back(pictures[k]);
  return few;
}

// The residual of a pixel as a step on a scale on which errors are 1 everywhere: linear below the floor over
// kModelPart, logarithmic above. deviation: of the pixel, of which a part of its whole value is a part.
double stabilised(double residual, double deviation, double floor) {
  const double whole = std::max(residual, std::sqrt(std::max(deviation * deviation - floor * floor, 0.0)) / kModelPart);
  const auto scaled = [floor](double v) { return std::asinh(kModelPart * v / floor) / kModelPart; };
  return scaled(whole) - scaled(whole - residual);
}

// The discs of one speed: the best that is not excluded, and what all of them show.
struct OfSpeed {
  FoundGhost best;
  std::vector<double> contrasts;
};

OfSpeed discs_of_speed(std::span<const SearchPicture> pictures, const Spokes& all, double speed,
                       std::span<const double> radii, std::span<const FoundGhost> excluded) {
  OfSpeed one;
  const double focal_length_px = pictures.front().frame.pixels.focal_length_px;
  double max_distance_px = 0.0;
  for (const SearchPicture& picture : pictures)
    max_distance_px = std::max(max_distance_px, picture.s * focal_length_px);
  if (std::abs(speed - 1.0) * max_distance_px < kLightSpeed_px) return one;
  for (const double radius_px : radii) {
    FoundGhost candidate;
    candidate.speed = speed;
    candidate.radius = radius_px / focal_length_px;
    const Disc disc = disc_contrast(pictures, all, candidate);
    one.contrasts.push_back(disc.signed_contrast);
    const bool known = std::ranges::any_of(
        excluded, [&](const FoundGhost& other) { return is_same(disc.found, other, focal_length_px); });
    if (!known && disc.found.contrast > one.best.contrast) one.best = disc.found;
  }
  return one;
}

}  // namespace

std::vector<SearchPicture> search_pictures(std::span<const FitStation> stations, double usual_error,
                                           double counted_part) {
  const double floor = usual_error * std::sqrt(counted_part);
  const double taken_off = (1.0 - counted_part) * usual_error * usual_error;
  std::vector<SearchPicture> pictures;
  for (const FitStation& station : stations) {
    SearchPicture picture{station.s, station.frame, Image(station.rate.width, station.rate.height, 1), {}};
    picture.partial = picture.value;
    for (std::size_t k = 0; k < picture.value.pixels.size(); ++k) {
      double sum = 0.0, variance = 0.0, used = 0.0;
      for (std::size_t c = 0; c < 3; ++c) {
        const auto weight = static_cast<double>(station.weight.pixels[3 * k + c]);
        if (!(weight > 0.0)) continue;
        sum += static_cast<double>(station.rate.pixels[3 * k + c]);
        variance += std::max(1.0 / weight - taken_off, counted_part / weight);
        used += 1.0;
      }
      const float value =
          used > 0.0 ? static_cast<float>(stabilised(sum / used, std::sqrt(variance / used), floor)) : std::nanf("");
      picture.partial.pixels[k] = value;
      picture.value.pixels[k] = used == 3.0 ? value : std::nanf("");
    }
    pictures.push_back(std::move(picture));
  }
  return pictures;
}

std::optional<FoundGhost> strongest_disc(std::span<const SearchPicture> all_pictures, const GhostSearch& search,
                                         std::span<const FoundGhost> excluded, const Context& context) {
  const std::vector<SearchPicture> pictures = few_of(all_pictures);
  if (pictures.empty()) return std::nullopt;
  const TangentFrame& frame = pictures.front().frame.pixels;
  double s_max = 0.0;
  for (const SearchPicture& picture : pictures) s_max = std::max(s_max, picture.s);
  const double max_distance_px = s_max * frame.focal_length_px;
  if (!(max_distance_px > 0.0)) return std::nullopt;
  const auto half = static_cast<int>(std::ceil(search.max_speed * max_distance_px));
  const std::vector<double> radii = radii_px(frame.width);
  const Spokes all = spokes();
  std::vector<double> contrasts;
  std::vector<FoundGhost> candidates;  // the best of each speed
  const bool done = ordered_pipeline(
      static_cast<std::size_t>(2 * half + 1), context,
      [&](std::size_t k) {
        return discs_of_speed(pictures, all, (static_cast<int>(k) - half) / max_distance_px, radii, excluded);
      },
      [&](std::size_t /*k*/, const OfSpeed& one) {
        contrasts.insert(contrasts.end(), one.contrasts.begin(), one.contrasts.end());
        if (one.best.contrast > 0.0) candidates.push_back(one.best);
      });
  if (!done) return std::nullopt;
  const double usual = std::max(usual_contrast(std::move(contrasts)), 1e-6);
  FoundGhost best = best_refined(
      std::move(candidates), excluded,
      [&](const FoundGhost& candidate) { return refined(all_pictures, all, candidate, max_distance_px); },
      search.min_contrast * usual, frame.focal_length_px);
  if (!(best.contrast > 0.0)) return std::nullopt;
  best.contrast *= std::sqrt(static_cast<double>(pictures.size()) / static_cast<double>(all_pictures.size()));
  best.contrast /= usual;
  if (best.contrast < search.min_contrast) return std::nullopt;
  return best;
}

}  // namespace contrejour::inline internal
