// SPDX-License-Identifier: Apache-2.0
#include "cli/ghost_sweep.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "cli/ghost_report.h"
#include "cli/lens_choice.h"
#include "cli/long_task.h"
#include "cli/text_table.h"
#include "contrejour/expert/requests.h"
#include "contrejour/expert/settings.h"
#include "contrejour/expert/trace.h"

namespace contrejour::cli {
namespace {

constexpr double kMaxFieldOverCorner = 1.5;  // because lights outside the picture have ghosts as well
constexpr double kMaxField_deg = 85.0;
constexpr double kMaxFNumber = 22.0;  // or twice the f-number of the lens's maximum aperture, if that is larger

double field_of_corner_deg(const LensState& lens) {
  const double half_mm = 0.5 * std::hypot(lens.sensor_width_mm, lens.sensor_height_mm);
  const Vec3 d = direction_for_image_point(lens, {0.0, half_mm}, lens.design_wavelength_nm);
  return std::atan2(std::hypot(d.x, d.y), d.z) / params::kDegree_rad;
}

Result<std::array<double, 2>> ends_of(const SweepRange& range, const Prescription& lens, const LensState& state) {
  if (range.ends) return *range.ends;
  switch (range.axis) {
    case SweepAxis::Field:
      return std::array{0.0, std::min(kMaxFieldOverCorner * field_of_corner_deg(state), kMaxField_deg)};
    case SweepAxis::FNumber: return std::array{lens.f_number, std::max(kMaxFNumber, 2.0 * lens.f_number)};
    case SweepAxis::Focal: break;
  }
  if (lens.zoom.size() < 2)
    return failure(ErrorCode::InvalidArgument,
                   "--sweep focal needs a zoom lens, and this lens has one focal length; sweep field or fnumber");
  return std::array{lens.zoom.front().focal_length_mm, lens.zoom.back().focal_length_mm};
}

// Angles in equal steps, focal lengths and f-numbers in equal ratios.
std::vector<double> values_between(SweepAxis axis, const std::array<double, 2>& ends, int steps) {
  std::vector<double> values;
  for (int k = 0; k < steps; ++k) {
    const double t = static_cast<double>(k) / (steps - 1);
    values.push_back(axis == SweepAxis::Field ? std::lerp(ends[0], ends[1], t)
                                              : ends[0] * std::pow(ends[1] / ends[0], t));
  }
  values.back() = ends[1];
  return values;
}

// The direction at a field angle in the plane of the given direction and the axis; upwards if that is the axis.
Vec3 direction_at_field(Vec3 direction, double field_deg) {
  const double across = std::hypot(direction.x, direction.y);
  const Vec2 sideways = across > 0.0 ? Vec2{direction.x / across, direction.y / across} : Vec2{0.0, -1.0};
  const double angle = field_deg * params::kDegree_rad;
  return {sideways.x * std::sin(angle), sideways.y * std::sin(angle), std::cos(angle)};
}

// The configured lens and the request of one step.
struct Step {
  LensState lens;
  FiguresRequest request;
};

Result<Step> step_at(const Prescription& lens, const params::Values& values, SweepAxis axis, double value) {
  params::Values own = values;
  if (axis != SweepAxis::Field) {
    const auto set = own.set(axis == SweepAxis::Focal ? "focal" : "fnumber", fmt::format("{}", value));
    if (!set) return tl::unexpected(set.error());
  }
  auto state = params::lens_of(lens, own);
  if (!state) return tl::unexpected(state.error());
  auto request = figures_request(own, *state);
  if (!request) return tl::unexpected(request.error());
  if (axis == SweepAxis::Field) request->light.direction = direction_at_field(request->light.direction, value);
  return Step{std::move(*state), std::move(*request)};
}

}  // namespace

Result<SweepRange> parse_sweep(std::string_view text) {
  const auto parts = params::split(text, ':');
  const auto refused = [&] {
    return failure(
        ErrorCode::InvalidArgument,
        fmt::format("\"{}\" is not a sweep; give field, focal or fnumber, and optionally the range, as in field:0:40",
                    text));
  };
  SweepRange range;
  if (parts[0] == "focal")
    range.axis = SweepAxis::Focal;
  else if (parts[0] == "fnumber")
    range.axis = SweepAxis::FNumber;
  else if (parts[0] != "field")
    return refused();
  if (parts.size() == 1) return range;
  if (parts.size() != 3) return refused();
  const auto from = params::parse_real(parts[1]), to = params::parse_real(parts[2]);
  if (!from || !to || !(*from < *to)) return refused();
  const bool is_field = range.axis == SweepAxis::Field;
  if (*from < 0.0 || (!is_field && *from == 0.0) || (is_field && *to > kMaxField_deg)) return refused();
  range.ends = std::array{*from, *to};
  return range;
}

Result<GhostSweep> sweep_ghosts(const std::string& lens, const params::Values& values, const SweepRange& range,
                                int steps) {
  const auto prescription = prescription_of(lens);
  if (!prescription) return tl::unexpected(prescription.error());
  const auto state = open_lens(lens, values);
  if (!state) return tl::unexpected(state.error());
  const auto ends = ends_of(range, *prescription, *state);
  if (!ends) return tl::unexpected(ends.error());
  GhostSweep sweep{state->name, range.axis, values_between(range.axis, *ends, steps), {}};
  std::map<Ghost, SweptGhost> by_ghost;
  for (std::size_t k = 0; k < sweep.value.size(); ++k) {
    const auto step = step_at(*prescription, values, range.axis, sweep.value[k]);
    if (!step) return tl::unexpected(step.error());
    const LongTask task(fmt::format("step {} of {}", k + 1, sweep.value.size()), values.integer("threads"));
    const auto figures = ghost_figures(step->lens, step->request, task.context());
    if (!figures) return tl::unexpected(figures.error());
    for (const GhostFigures& g : *figures) {
      SweptGhost& swept = by_ghost[g.ghost];
      swept.ghost = g.ghost;
      swept.relative_flux.resize(sweep.value.size(), 0.0);
      swept.peak_irradiance.resize(sweep.value.size(), 0.0);
      swept.relative_flux[k] = g.relative_flux;
      swept.peak_irradiance[k] = g.peak_irradiance;
    }
  }
  for (auto& [ghost, swept] : by_ghost) sweep.ghosts.push_back(std::move(swept));
  return sweep;
}

const std::vector<double>& quantity_of(const SweptGhost& ghost, SweepQuantity quantity) {
  return quantity == SweepQuantity::Flux ? ghost.relative_flux : ghost.peak_irradiance;
}

std::size_t worst_step(const SweptGhost& ghost, SweepQuantity quantity) {
  const auto& values = quantity_of(ghost, quantity);
  return static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
}

void sort_by_worst(GhostSweep& sweep, SweepQuantity quantity) {
  const auto worst = [&](const SweptGhost& g) { return quantity_of(g, quantity)[worst_step(g, quantity)]; };
  std::stable_sort(sweep.ghosts.begin(), sweep.ghosts.end(),
                   [&](const SweptGhost& a, const SweptGhost& b) { return worst(a) > worst(b); });
}

std::string axis_name(SweepAxis axis) {
  switch (axis) {
    case SweepAxis::Field: return "field deg";
    case SweepAxis::Focal: return "focal mm";
    case SweepAxis::FNumber: return "f-number";
  }
  return {};
}

namespace {

std::string axis_key(SweepAxis axis) {
  switch (axis) {
    case SweepAxis::Field: return "field_deg";
    case SweepAxis::Focal: return "focal_length_mm";
    case SweepAxis::FNumber: return "f_number";
  }
  return {};
}

}  // namespace

Json sweep_json(const GhostSweep& sweep) {
  Json ghosts = Json::array();
  for (const SweptGhost& g : sweep.ghosts) {
    const auto worst = [&](SweepQuantity quantity) {
      const std::size_t k = worst_step(g, quantity);
      return Json{{axis_key(sweep.axis), sweep.value[k]},
                  {"relative_flux", g.relative_flux[k]},
                  {"peak_irradiance", g.peak_irradiance[k]}};
    };
    ghosts.push_back({{"surfaces", surfaces_json(g.ghost)},
                      {"order", g.ghost.order},
                      {"worst_flux", worst(SweepQuantity::Flux)},
                      {"worst_peak", worst(SweepQuantity::Peak)},
                      {"relative_flux", g.relative_flux},
                      {"peak_irradiance", g.peak_irradiance}});
  }
  return {{"lens", sweep.lens}, {"sweep", axis_key(sweep.axis)}, {"values", sweep.value}, {"ghosts", ghosts}};
}

std::string sweep_text(const GhostSweep& sweep) {
  TextTable table({"ghost", "worst flux", "at " + axis_name(sweep.axis), "worst peak", "at " + axis_name(sweep.axis)});
  for (const SweptGhost& g : sweep.ghosts) {
    const auto number = [](double value) { return fmt::format("{:.3g}", value); };
    const std::size_t by_flux = worst_step(g, SweepQuantity::Flux), by_peak = worst_step(g, SweepQuantity::Peak);
    table.add({ghost_name(g.ghost), number(g.relative_flux[by_flux]), number(sweep.value[by_flux]),
               number(g.peak_irradiance[by_peak]), number(sweep.value[by_peak])});
  }
  return table.text();
}

std::string sweep_csv(const GhostSweep& sweep) {
  std::string out = "ghost," + axis_key(sweep.axis) + ",relative_flux,peak_irradiance\n";
  for (const SweptGhost& g : sweep.ghosts)
    for (std::size_t k = 0; k < sweep.value.size(); ++k)
      out += fmt::format("{},{},{},{}\n", csv_name(g.ghost), sweep.value[k], g.relative_flux[k], g.peak_irradiance[k]);
  return out;
}

}  // namespace contrejour::cli
