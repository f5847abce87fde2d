// SPDX-License-Identifier: Apache-2.0
#include "studio/core/ghost_ranks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "contrejour/expert/requests.h"
#include "studio/core/ghost_order.h"

namespace contrejour::studio {
namespace {

// Fluxes of ghosts differ by decades, so that three bands suffice to rank them; those of the list would take twice the
// time.
constexpr const char* kRankedBands = "3";

// Lights are placed here; the others do not change which ghosts are bright where.
bool leaves_ranks_alone(const params::Parameter& p) {
  return p.group == "Lights" || p.group == "Light detection" || p.group == "Output" || p.name == "select" ||
         p.name == "ghost" || p.name == "error" || p.name == "starburst";
}

std::string key_of_ranks(const params::Values& values) {
  std::string key;
  for (const params::Parameter& p : params::all_parameters())
    if (!leaves_ranks_alone(p) && values.given(p.name))
      key += fmt::format("{}={}\n", p.name, fmt::join(values.list(p.name), "\t"));
  return key;
}

// The same picture of one light, on the frame's diagonal.
params::Values values_at_radius(const params::Values& values, double radius) {
  params::Values placed;
  for (const params::Parameter& p : params::all_parameters())
    if (p.group != "Lights" && values.given(p.name))
      for (const std::string& text : values.list(p.name)) static_cast<void>(placed.set(p.name, text));
  const double at = 0.5 - 0.5 * radius;
  static_cast<void>(placed.set("light-at", fmt::format("{:.6f},{:.6f}", at, at)));
  static_cast<void>(placed.set("wavelengths", kRankedBands));
  return placed;
}

// The ghosts' light for a light at the radius; the ghosts in their own order.
Result<std::map<Ghost, double>> light_at(const params::Values& values, const LensState& lens, double radius,
                                         const Context& context) {
  const auto request = figures_request(values_at_radius(values, radius), lens);
  if (!request) return tl::unexpected(request.error());
  const auto figures = ghost_figures(lens, *request, context);
  if (!figures) return tl::unexpected(figures.error());
  const Vec2 frame_px{static_cast<double>(request->frame.width), static_cast<double>(request->frame.height)};
  std::map<Ghost, double> light;
  for (const GhostFigures& f : *figures) light[f.ghost] = light_in_frame(f, frame_px);
  return light;
}

constexpr double kStepsBetween = 4;

void add_light_at(const GhostRanks& ranks, double radius, std::vector<double>& sum) {
  const auto outer = std::ranges::upper_bound(ranks.radii, radius);
  const auto far = std::min(static_cast<std::size_t>(outer - ranks.radii.begin()), ranks.radii.size() - 1);
  const std::size_t near = outer == ranks.radii.end() || far == 0 ? far : far - 1;
  const double width = ranks.radii[far] - ranks.radii[near];
  const double part = width > 0 ? (radius - ranks.radii[near]) / width : 0.0;
  const double weight = std::round(kStepsBetween * part) / kStepsBetween;
  for (std::size_t g = 0; g < sum.size(); ++g)
    sum[g] += (1 - weight) * ranks.light[near][g] + weight * ranks.light[far][g];
}

}  // namespace

std::vector<Ghost> brightest_at(const GhostRanks& ranks, std::span<const double> radii) {
  std::vector<double> light(ranks.ghosts.size());
  for (const double radius : radii)
    if (!ranks.radii.empty()) add_light_at(ranks, radius, light);
  std::vector<std::size_t> order(light.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return light[a] > light[b]; });
  std::vector<Ghost> ghosts;
  for (const std::size_t k : order) ghosts.push_back(ranks.ghosts[k]);
  return ghosts;
}

double radius_of(Vec2 uv, Vec2 frame_px) {
  const Vec2 from{(uv.x - 0.5) * frame_px.x, (uv.y - 0.5) * frame_px.y};
  return std::hypot(from.x, from.y) / (0.5 * std::hypot(frame_px.x, frame_px.y));
}

double light_in_frame(const GhostFigures& ghost, Vec2 frame_px) {
  return ghost.relative_flux * part_in_frame(ghost, frame_px);
}

void KeptRanks::forget_others(const params::Values& values, const LensState& lens) {
  std::string key = key_of_ranks(values);
  if (key == key_ && lens.surfaces == surfaces_) return;
  *this = KeptRanks();
  key_ = std::move(key);
  surfaces_ = lens.surfaces;
}

std::shared_ptr<const GhostRanks> KeptRanks::find(const params::Values& values, const LensState& lens) {
  forget_others(values, lens);
  return all_;
}

std::shared_ptr<const GhostRanks> KeptRanks::measure(const params::Values& values, const LensState& lens,
                                                     const Context& context) {
  forget_others(values, lens);
  while (measured_.radii.size() < kRankedRadii.size()) {
    const double radius = kRankedRadii[measured_.radii.size()];
    const auto light = light_at(values, lens, radius, context);
    if (!light) return nullptr;
    measured_.ghosts.clear();
    measured_.radii.push_back(radius);
    std::vector<double>& of_radius = measured_.light.emplace_back();
    for (const auto& [ghost, amount] : *light) {
      measured_.ghosts.push_back(ghost);
      of_radius.push_back(amount);
    }
  }
  if (!all_) all_ = std::make_shared<const GhostRanks>(measured_);
  return all_;
}

}  // namespace contrejour::studio
