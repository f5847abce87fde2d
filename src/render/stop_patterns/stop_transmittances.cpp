// SPDX-License-Identifier: Apache-2.0
#include "render/stop_patterns/stop_transmittances.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "base/tasks.h"
#include "render/stop_patterns/dirt_fringes.h"
#include "render/stop_patterns/stop_pattern.h"
#include "render/stop_patterns/stop_patterns.h"
#include "render/stop_patterns/stop_wave.h"

namespace contrejour::inline internal {
namespace {

using stop_patterns::EdgePattern;
using stop_patterns::StopPatterns;
using stop_patterns::TexturePattern;
using stop_patterns::TonedPattern;

// The first fringe is 1.9 of an edge's unit 1 / sqrt(2 F) wide; where that unit is fewer pixels than this, no fringe is
// visible.
constexpr double kInvisibleUnit_px = 0.15;
constexpr double kInvisibleShadow_px = 0.7;  // of sqrt(lambda z), by which the edges of dirt are blurred
// The order a corresponds to F = cot(pi a / 2) times the square of the stop's radius in the transform's units.
constexpr double kFractionalFresnel = 72.0;
constexpr double kSharpOrder = 1e-4;  // smaller ones leave the mask as it is: fringes of a hundredth of a stop radius

double distance_along_axis(const LightSource& light) {
  return light.is_distant() ? std::numeric_limits<double>::infinity() : light.distance_mm * light.direction.z;
}

}  // namespace

StopTransmittances::Key StopTransmittances::key_of(const Ghost& ghost, double lambda_nm, const LightSource& light) {
  return {ghost, lambda_nm, distance_along_axis(light)};
}

StopTransmittances::StopTransmittances(const LensState& lens, const FrameSettings& settings,
                                       std::shared_ptr<const DirtField> dirt, RenderCache& cache)
    : lens_(lens), options_(settings.ringing), pixel_pitch_mm_(settings.frame.pixel_pitch_mm),
      dirt_field_(std::move(dirt)),
      sharp_dirt_(dirt_field_ ? std::make_shared<const DirtShadows>(dirt_field_) : nullptr), cache_(cache) {
  if (on()) iris_ = std::make_shared<const IrisShape>(lens.iris);
}

double StopTransmittances::fresnel_number(const Ghost& ghost, double lambda_nm, const LightSource& light) const {
  if (options_.mode == RingingMode::None) return std::numeric_limits<double>::infinity();
  if (options_.mode == RingingMode::Fresnel)
    return stop_patterns::stop_wave(ghost_path(lens_, ghost, lambda_nm), distance_along_axis(light)).fresnel_number;
  return kFractionalFresnel /
         std::tan(0.5 * std::numbers::pi * std::clamp(std::abs(order(lambda_nm)), kSharpOrder, 0.999));
}

bool StopTransmittances::prepare(const FramePlan& plan, const Context& context) {
  std::vector<Request> requested;
  for_each_pair_with_passes(plan, [&](std::size_t g, std::size_t k, std::span<const PlannedPass> passes) {
    for (const PlannedPass& pass : passes)
      requested.push_back({plan.ghosts[g], pass.lambda_nm, pass.spread_nm, plan.lights[k].source});
  });
  return prepare(requested, context) && prepare_dirt(requested, context);
}

bool StopTransmittances::prepare(std::span<const Request> requested, const Context& context) {
  if (!on()) return true;
  std::vector<Request> missing;
  for (const Request& w : requested)
    if (stop_.try_emplace(key_of(w.ghost, w.lambda_nm, w.light)).second) missing.push_back(w);
  if (options_.mode != RingingMode::None) patterns_ = cache_.section<StopPatterns>(lens_.iris);
  const bool done = options_.mode == RingingMode::None      ? true
                    : options_.mode == RingingMode::Fresnel ? prepare_fresnel(missing, context)
                                                            : prepare_hullin(missing, context);
  if (done && has_half_tones()) add_half_tones(missing);
  return done;
}

// Applies a picture's half-tones to ghosts with sharp or fringed edges; patterns include them already.
void StopTransmittances::add_half_tones(std::span<const Request> requested) {
  for (const Request& w : requested) {
    auto& pattern = stop_[key_of(w.ghost, w.lambda_nm, w.light)];
    if (pattern && pattern->edges() == nullptr) continue;
    std::shared_ptr<const EdgePattern> edges(pattern, pattern ? pattern->edges() : nullptr);
    pattern = std::make_shared<const StopPattern>(iris_, TonedPattern(iris_, std::move(edges)));
  }
}

// The wave at the stop of each ghost; empty if cancelled.
std::vector<stop_patterns::StopWave> StopTransmittances::waves_of(std::span<const Request> requested,
                                                                  const Context& context) const {
  std::vector<stop_patterns::StopWave> waves(requested.size());
  Context quiet = context;
  quiet.progress = {};
  const bool done = parallel_for(requested.size(), quiet, [&](std::size_t k) {
    waves[k] = stop_patterns::stop_wave(ghost_path(lens_, requested[k].ghost, requested[k].lambda_nm),
                                        distance_along_axis(requested[k].light));
  });
  return done ? waves : std::vector<stop_patterns::StopWave>{};
}

// Whether no pixel shows the fringes of this Fresnel number in a ghost of this size.
bool StopTransmittances::is_sharp(double footprint, double fresnel_number) const {
  const double unit_mm = lens_.stop_radius_mm * footprint / std::sqrt(2.0 * fresnel_number);
  return !(unit_mm > kInvisibleUnit_px * pixel_pitch_mm_);
}

bool StopTransmittances::prepare_fresnel(std::span<const Request> requested, const Context& context) {
  const auto waves = waves_of(requested, context);
  if (waves.size() != requested.size()) return false;
  const auto sharp = [&](std::size_t k) { return is_sharp(waves[k].footprint, waves[k].fresnel_number); };
  const auto spread = [&](std::size_t k) { return requested[k].spread_nm / requested[k].lambda_nm; };
  // A ghost has patterns at all of its wavelengths, or edges' fringes at all: what is drawn together must be of one
  // kind.
  std::map<std::pair<Ghost, double>, double> lowest;
  const auto kin = [&](std::size_t k) {
    return std::pair(requested[k].ghost, distance_along_axis(requested[k].light));
  };
  for (std::size_t k = 0; k < requested.size(); ++k) {
    double& f = lowest.try_emplace(kin(k), std::numeric_limits<double>::infinity()).first->second;
    if (!sharp(k)) f = std::min(f, waves[k].fresnel_number);
  }
  const auto has_pattern = [&](std::size_t k) {
    return lowest.at(kin(k)) < StopPatterns::kEdgesFrom && waves[k].fresnel_number < StopPatterns::kHighestFresnel;
  };
  std::vector<StopPatterns::Request> textures;
  for (std::size_t k = 0; k < requested.size(); ++k)
    if (!sharp(k) && has_pattern(k)) textures.push_back({waves[k].fresnel_number, spread(k)});
  if (!patterns_->make(textures, context)) return false;
  for (std::size_t k = 0; k < requested.size(); ++k) {
    if (sharp(k)) continue;
    const double f = waves[k].fresnel_number;
    auto& pattern = stop_[key_of(requested[k].ghost, requested[k].lambda_nm, requested[k].light)];
    if (has_pattern(k))
      pattern = std::make_shared<const StopPattern>(iris_, TexturePattern(patterns_->pattern({f, spread(k)})));
    else
      pattern = std::make_shared<const StopPattern>(iris_, EdgePattern(iris_, patterns_->profile(spread(k)), f));
  }
  return true;
}

double StopTransmittances::order(double lambda_nm) const {
  const double order = options_.alpha.value_or(hullin_order(lambda_nm, lens_.f_number));
  return std::isfinite(order) ? order : 0.0;
}

bool StopTransmittances::prepare_hullin(std::span<const Request> requested, const Context& context) {
  const auto waves = waves_of(requested, context);
  if (waves.size() != requested.size()) return false;
  for (std::size_t k = 0; k < requested.size(); ++k) {
    const Request& w = requested[k];
    const double middle = order(w.lambda_nm);
    if (!(std::abs(middle) >= kSharpOrder) ||
        is_sharp(waves[k].footprint, fresnel_number(w.ghost, w.lambda_nm, w.light)))
      continue;
    // Three orders represent the band; an order set by the user applies to all wavelengths.
    const double off = options_.alpha ? 0.0 : middle * w.spread_nm / w.lambda_nm * std::sqrt(1.5);
    const std::vector<double> orders =
        off > 0.0 ? std::vector<double>{middle - off, middle, middle + off} : std::vector<double>{middle};
    const auto texture = patterns_->fractional(orders, context);
    if (!texture) return false;
    stop_[key_of(w.ghost, w.lambda_nm, w.light)] = std::make_shared<const StopPattern>(iris_, TexturePattern(texture));
  }
  return true;
}

std::shared_ptr<const StopPattern> StopTransmittances::pattern_of(const Ghost& ghost, double lambda_nm,
                                                                  const LightSource& light) const {
  const auto found = stop_.find(key_of(ghost, lambda_nm, light));
  return found == stop_.end() ? nullptr : found->second;
}

// The wave at the dirt's plane for each crossing. Shadows are limited where the iris's patterns are (kLowestFresnel).
// With fractional orders, the iris's Fresnel number is the one that the order corresponds to, wherever the dirt lies.
std::vector<stop_patterns::PlaneWave> StopTransmittances::dirt_waves(const Request& requested) const {
  const bool on_front = dirt_field_->site().on_front;
  const OpticalPath path = ghost_path(lens_, requested.ghost, requested.lambda_nm);
  const double light_mm = distance_along_axis(requested.light), lambda_mm = requested.lambda_nm * 1e-6;
  const std::vector<stop_patterns::PlaneWave> stops = stop_patterns::stop_crossing_waves(path, light_mm);
  std::vector<stop_patterns::PlaneWave> waves =
      on_front ? std::vector{stop_patterns::front_wave(path, light_mm)} : stops;
  if (stops.empty()) return waves;
  for (stop_patterns::PlaneWave& wave : waves) {
    const stop_patterns::PlaneWave& stop = on_front ? stops.back() : wave;
    const double beam_mm = lens_.stop_radius_mm * stop.magnification / wave.magnification;
    const double f = options_.mode == RingingMode::Hullin
                         ? fresnel_number(requested.ghost, requested.lambda_nm, requested.light)
                         : StopPatterns::kLowestFresnel;
    const double by_f_mm = beam_mm * beam_mm / (lambda_mm * f);
    wave.distance_mm = options_.mode == RingingMode::Hullin ? by_f_mm : std::min(wave.distance_mm, by_f_mm);
  }
  return waves;
}

double StopTransmittances::dirt_fringe_unit_mm(const Request& requested) const {
  if (options_.mode == RingingMode::None || !dirt_field_) return 0.0;
  const auto waves = dirt_waves(requested);
  return waves.empty() ? 0.0 : std::sqrt(requested.lambda_nm * 1e-6 * waves.back().distance_mm);
}

bool StopTransmittances::prepare_dirt(std::span<const Request> requested, const Context& context) {
  const auto& dirt = dirt_field_;
  if (options_.mode == RingingMode::None || !dirt || dirt->shapes().empty() || dirt->has_picture()) return true;
  std::vector<Request> missing;
  for (const Request& w : requested)
    if (dirt_.try_emplace(key_of(w.ghost, w.lambda_nm, w.light)).second) missing.push_back(w);
  using stop_patterns::DirtFringes;
  std::vector<std::vector<std::optional<DirtFringes::Request>>> planes;  // by crossing; empty where it is sharp
  std::vector<DirtFringes::Request> all;
  for (const Request& w : missing) {
    auto& of_crossing = planes.emplace_back();
    for (const stop_patterns::PlaneWave& wave : dirt_waves(w)) {
      const double lambda_z_mm2 = w.lambda_nm * 1e-6 * wave.distance_mm;
      const double fringe_width_mm = std::sqrt(lambda_z_mm2) * wave.magnification;
      const bool is_visible = fringe_width_mm > kInvisibleShadow_px * pixel_pitch_mm_ && std::isfinite(lambda_z_mm2);
      of_crossing.push_back(is_visible ? std::optional(DirtFringes::Request{lambda_z_mm2, w.spread_nm / w.lambda_nm})
                                       : std::nullopt);
      if (is_visible) all.push_back(*of_crossing.back());
    }
  }
  const auto fringes = cache_.section<DirtFringes>({lens_.dirt, dirt->extent_mm()});
  Context quiet = context;
  quiet.progress = {};
  if (!fringes->make(*dirt, all, quiet)) return false;
  for (std::size_t k = 0; k < missing.size(); ++k) {
    std::vector<std::shared_ptr<const stop_patterns::DirtDiffraction>> crossings;
    for (const auto& plane : planes[k]) crossings.push_back(plane ? fringes->plane(*plane) : nullptr);
    if (std::ranges::all_of(crossings, [](const auto& plane) { return plane == nullptr; })) continue;
    dirt_[key_of(missing[k].ghost, missing[k].lambda_nm, missing[k].light)] =
        std::make_shared<const DirtShadows>(dirt, std::move(crossings));
  }
  return true;
}

std::shared_ptr<const DirtShadows> StopTransmittances::dirt_of(const Ghost& ghost, double lambda_nm,
                                                               const LightSource& light) const {
  const auto found = dirt_.find(key_of(ghost, lambda_nm, light));
  return found == dirt_.end() || !found->second ? sharp_dirt_ : found->second;
}

}  // namespace contrejour::inline internal
