// SPDX-License-Identifier: Apache-2.0
#include "polynomial/range_states.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "polynomial/fit_lens.h"

namespace contrejour::inline internal::polynomial {

double between_positions(std::span<const double> low_mm, std::span<const double> high_mm,
                         std::span<const double> z_mm) {
  double along = 0.0, whole = 0.0;
  for (std::size_t k = 0; k < z_mm.size(); ++k) {
    const double moved = high_mm[k] - low_mm[k];
    along += moved * (z_mm[k] - low_mm[k]);
    whole += moved * moved;
  }
  return whole > 0.0 ? along / whole : 0.0;
}

std::vector<double> positions_of(const LensState& lens) {
  std::vector<double> z_mm;
  for (const SurfaceState& surface : lens.surfaces) z_mm.push_back(surface.z_mm);
  z_mm.push_back(lens.sensor_z_mm);
  return z_mm;
}

RangeState::RangeState(const LensState& state, const TablesByWavelength& tables, double field)
    : lens(wide_open(state)), steps(lens, tables), largest_field(field) {}

Result<LensState> RangeStates::configured(double setting_mm) const {
  LensSettings settings = settings_;
  (options_.variable == PolynomialVariable::Zoom ? settings.focal_length_mm.emplace() : settings.object_distance_mm) =
      setting_mm;
  return configure_lens(lens_, settings);
}

void RangeStates::keep(double coordinate, const LensState& lens) {
  states_[coordinate] = std::make_unique<RangeState>(lens, tables_, polynomial::largest_field(lens, options_.fit));
}

// Between two positions of a zoom all spaces vary in proportion.
Result<LensState> RangeStates::zoomed(double coordinate) const {
  const auto part = std::min(static_cast<std::size_t>(coordinate), break_positions_.size() - 2);
  const double within = coordinate - static_cast<double>(part);
  Prescription lens = lens_;
  lens.zoom.clear();
  for (std::size_t k = 0; k + 1 < lens.surfaces.size(); ++k)
    lens.surfaces[k].thickness_mm =
        std::lerp(break_positions_[part][k + 1] - break_positions_[part][k],
                  break_positions_[part + 1][k + 1] - break_positions_[part + 1][k], within);
  LensSettings settings = settings_;
  settings.focal_length_mm.reset();
  return configure_lens(lens, settings);
}

Result<void> RangeStates::find_breaks() {
  const bool is_zoom = options_.variable == PolynomialVariable::Zoom;
  std::vector<double> settings_mm{options_.from_mm, options_.to_mm};
  if (is_zoom)
    for (const ZoomPosition& position : lens_.zoom) settings_mm.push_back(position.focal_length_mm);
  std::vector<std::pair<double, LensState>> found;
  for (const double setting_mm : settings_mm) {
    auto lens = configured(setting_mm);
    if (!lens) return tl::unexpected(lens.error());
    const double at = is_zoom ? lens->focal_length_mm : 1.0 / lens->object_distance_mm;
    found.emplace_back(at, std::move(*lens));
  }
  const double low = std::min(found[0].first, found[1].first), high = std::max(found[0].first, found[1].first);
  const double apart = 1e-6 * (high - low);  // nearer settings are the same state
  if (!(high > low)) return invalid_argument("the range of a polynomial fit must have two ends that differ");
  ends_mm_ = is_zoom ? std::array{low, high} : std::array{1.0 / low, 1.0 / high};
  first_ = std::make_unique<LensState>(found.front().second);
  tables_ = TablesByWavelength(*first_);
  std::ranges::sort(found, {}, [](const auto& one) { return one.first; });
  double last = -1.0;
  for (const auto& [at, lens] : found) {
    if (at < low || at > high || at - last <= apart) continue;
    last = at;
    breaks_.push_back(is_zoom ? static_cast<double>(breaks_.size()) : at);
    break_positions_.push_back(positions_of(lens));
    keep(breaks_.back(), lens);
  }
  return {};
}

Result<std::unique_ptr<RangeStates>> RangeStates::create(const Prescription& lens, const LensSettings& settings,
                                                         const PolynomialRangeOptions& options) {
  std::unique_ptr<RangeStates> states(new RangeStates(lens, settings, options));
  if (const auto found = states->find_breaks(); !found) return tl::unexpected(found.error());
  return states;
}

const RangeState* RangeStates::at(double coordinate) {
  const std::scoped_lock lock(mutex_);
  if (const auto found = states_.find(coordinate); found != states_.end()) return found->second.get();
  const auto lens = options_.variable == PolynomialVariable::Zoom ? zoomed(coordinate) : configured(1.0 / coordinate);
  if (!lens) return nullptr;
  keep(coordinate, *lens);
  return states_[coordinate].get();
}

}  // namespace contrejour::inline internal::polynomial
