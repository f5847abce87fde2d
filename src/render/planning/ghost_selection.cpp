// SPDX-License-Identifier: Apache-2.0
#include "render/planning/ghost_selection.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>

#include <fmt/format.h>

#include "base/tasks.h"
#include "ghosts/light_frame.h"
#include "render/planning/applied_adjustment.h"
#include "render/pupils/ghost_light.h"
#include "render/radiometry/wavelength_samples.h"

namespace contrejour::inline internal {
namespace {

using pupils::GhostPupil;
using pupils::KeptPupils;
using pupils::PupilRequest;

constexpr std::size_t kMaxMeasured = 5;  // wavelengths of a light; the others are interpolated
constexpr std::size_t kMaxKept = 1U << 16U;  // pupils; beyond this number they are searched again rather than kept

// The pupils of the ghosts that have been searched, by ghost and then by light, and the flux that they add to the
// picture.
struct Measured {
  std::vector<GhostPupil> pupils;
  std::vector<Rgb> flux;  // of each ghost, in pixel values, summed over lights and the frame
};

// The rectangle of the sensor within which a ghost's light counts, displaced by the ghost's offset: the whole frame,
// even where only a window of it is drawn, so that all windows have the same ghosts, together with the part of the
// window outside the frame.
Rectangle visible_mm(const Frame& frame, const AppliedAdjustment& adjustment) {
  const Frame placed = adjustment.placed(frame);
  const double left = std::min(-frame.origin_x, 0), top = std::min(-frame.origin_y, 0);
  const double right = std::max(frame.full_width - frame.origin_x, frame.width);
  const double bottom = std::max(frame.full_height - frame.origin_y, frame.height);
  return {placed.sensor_from_pixel({right, top}), placed.sensor_from_pixel({left, bottom})};
}

// The wavelengths at which a light is measured, and how their fluxes combine to channels.
class MeasuredLight {
 public:
  explicit MeasuredLight(const LensState& lens, const PlannedLight& light)
      : light_(light), windows_(lens, light.source) {
    for (const PlannedPass& pass : light.passes) all_nm_.push_back(pass.lambda_nm);
    const WavelengthSamples samples(all_nm_, kMaxMeasured);
    std::vector<std::size_t> chosen;
    for (std::size_t k = 0; k < samples.size(); ++k) chosen.push_back(samples[k]);
    std::vector<std::size_t> order(chosen.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return chosen[a] < chosen[b]; });
    for (const std::size_t k : order) {
      measured_nm_.push_back(all_nm_[chosen[k]]);
      Rgb gain{};
      for (std::size_t pass = 0; pass < all_nm_.size(); ++pass) {
        const double factor = samples.factors(samples.size(), pass)[k];
        for (std::size_t c = 0; c < 3; ++c) gain[c] += factor * light.passes[pass].gain[c];
      }
      gain_.push_back(gain);
    }
  }

  [[nodiscard]] PupilRequest request(const LensState& lens, const StepsByWavelength& steps, const Ghost& ghost,
                                     const Context& context) const {
    return {steps, ghost, light_.source, windows_.of(has_axial_symmetry(lens, ghost)), all_nm_, 1.0, &context};
  }
  [[nodiscard]] Rgb flux(const PupilRequest& request, const GhostPupil& searched, const IrisShape& iris,
                         const AppliedAdjustment& adjustment, const Frame& frame, KeptGhostFluxes& kept) const {
    Rgb sum{};
    const Rectangle visible = visible_mm(frame, adjustment);
    const std::vector<double> flux = kept.get(request, measured_nm_, visible, [&] {
      return approximate_fluxes_within(request, searched, measured_nm_, iris, visible);
    });
    for (std::size_t k = 0; k < gain_.size(); ++k)
      for (std::size_t c = 0; c < 3; ++c) sum[c] += gain_[k][c] * flux[k];
    return adjustment.tinted(sum);
  }

 private:
  const PlannedLight& light_;
  LightWindows windows_;
  std::vector<double> all_nm_, measured_nm_;  // in increasing order
  std::vector<Rgb> gain_;  // one for each measured wavelength
};

// Measures all pairs of some ghosts and lights, by ghost and then by light.
class GhostMeasuring {
 public:
  GhostMeasuring(const LensState& lens, std::span<const PlannedLight> lights, const TablesByWavelength& tables,
                 const KeptByGhost& kept, const FrameSettings& settings)
      : lens_(lens), pupils_(kept.pupils), fluxes_(kept.fluxes), settings_(settings), steps_(lens, tables),
        iris_(lens.iris) {
    for (const PlannedLight& light : lights) lights_.emplace_back(lens, light);
  }

  // Errors: Cancelled.
  [[nodiscard]] Result<Measured> measure(std::span<const Ghost> ghosts, const Context& context) const {
    const std::vector<AppliedAdjustment> adjustments =
        applied_adjustments(lens_, ghosts, settings_.ghosts, settings_.frame);
    const std::size_t count = ghosts.size() * lights_.size();
    std::vector<Rgb> flux(count);
    Measured out;
    out.pupils.resize(count <= kMaxKept ? count : 0);
    const bool done = parallel_for(count, context, [&](std::size_t k) {
      const std::size_t g = k / lights_.size();
      const PupilRequest request = request_of(k, ghosts[g], context);
      GhostPupil searched = pupils_.search_ghost_pupil(request);
      flux[k] = lights_[k % lights_.size()].flux(request, searched, iris_, adjustments[g], settings_.frame, fluxes_);
      if (!out.pupils.empty()) out.pupils[k] = std::move(searched);
    });
    if (!done) return interrupted();
    out.flux.resize(ghosts.size());
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t c = 0; c < 3; ++c) out.flux[k / lights_.size()][c] += std::abs(flux[k][c]);
    return out;
  }

  // Fits polynomials to the pupils that were searched, at all wavelengths. Returns false when cancelled.
  [[nodiscard]] bool fit(std::span<const Ghost> ghosts, std::vector<GhostPupil>& pupils, const Context& context) const {
    return parallel_for(pupils.size(), context, [&](std::size_t k) {
      pupils[k] = pupils_.fit_ghost_pupil(request_of(k, ghosts[k / lights_.size()], context), std::move(pupils[k]));
    });
  }

 private:
  [[nodiscard]] PupilRequest request_of(std::size_t pair, const Ghost& ghost, const Context& context) const {
    return lights_[pair % lights_.size()].request(lens_, steps_, ghost, context);
  }

  const LensState& lens_;
  KeptPupils& pupils_;
  KeptGhostFluxes& fluxes_;
  const FrameSettings& settings_;
  StepsByWavelength steps_;
  IrisShape iris_;
  std::vector<MeasuredLight> lights_;
};

// Each ghost's fraction of the flux of all ghosts, channel by channel.
std::vector<Rgb> fractions_of(std::vector<Rgb> flux) {
  Rgb whole{};
  for (const Rgb& one : flux)
    for (std::size_t c = 0; c < 3; ++c) whole[c] += one[c];
  for (Rgb& one : flux)
    for (std::size_t c = 0; c < 3; ++c) one[c] = whole[c] > 0.0 ? one[c] / whole[c] : 0.0;
  return flux;
}

double largest(const Rgb& rgb) { return *std::max_element(rgb.begin(), rgb.end()); }

// Indices of the ghosts, the brightest first, ties in ghost order.
std::vector<std::size_t> by_falling_fraction(const std::vector<Rgb>& fraction) {
  std::vector<std::size_t> order(fraction.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return largest(fraction[a]) > largest(fraction[b]); });
  return order;
}

// The smallest number of ghosts such that the others have, in each channel, no more than the fraction of flux that may
// be dropped.
std::size_t count_to_keep(const SelectByFlux& select, const std::vector<Rgb>& fraction,
                          const std::vector<std::size_t>& order) {
  const double allowed = select.drop_percent / 100.0;
  Rgb dropped{};
  std::size_t keep = order.size();
  while (keep > 0) {
    Rgb next = dropped;
    for (std::size_t c = 0; c < 3; ++c) next[c] += fraction[order[keep - 1]][c];
    if (largest(next) > allowed) break;
    dropped = next;
    --keep;
  }
  return keep;
}

Result<void> check_list(const LensState& lens, const std::vector<Ghost>& list) {
  for (const Ghost& g : list) {
    if (has_ghost(lens, g)) continue;
    return failure(
        ErrorCode::InvalidArgument,
        fmt::format("there is no ghost {} in this lens; `contrejour ghosts` lists those there are", ghost_name(g)));
  }
  return {};
}

// The first ghosts of the order, put back into (i, j) order.
GhostChoice first_of(const std::vector<Ghost>& all, std::size_t lights, Measured& measured,
                     const std::vector<Rgb>& fraction, const std::vector<std::size_t>& order, std::size_t count) {
  std::vector<bool> is_kept(all.size(), false);
  for (std::size_t k = 0; k < std::min(count, order.size()); ++k) is_kept[order[k]] = true;
  GhostChoice out;
  Rgb skipped{};
  for (std::size_t g = 0; g < all.size(); ++g) {
    if (!is_kept[g]) {
      for (std::size_t c = 0; c < 3; ++c) skipped[c] += fraction[g][c];
      continue;
    }
    out.ghosts.push_back(all[g]);
    out.flux_fractions.push_back(largest(fraction[g]));
    for (std::size_t light = 0; light < lights && !measured.pupils.empty(); ++light)
      out.pupils.push_back(std::move(measured.pupils[g * lights + light]));
  }
  out.skipped_flux = largest(skipped);
  return out;
}

template <class Condition>
GhostChoice those_where(const std::vector<Ghost>& all, Condition condition) {
  GhostChoice out;
  std::copy_if(all.begin(), all.end(), std::back_inserter(out.ghosts), condition);
  return out;
}

// Visitor of GhostSelection: one overload for each kind of selection.
struct Selector {
  const LensState& lens;
  std::span<const PlannedLight> lights;
  const TablesByWavelength& tables;
  const KeptByGhost& kept;
  const FrameSettings& settings;
  bool measures;
  const Context& context;

  [[nodiscard]] std::vector<Ghost> in_scope() const {
    return enumerate_ghosts(lens, settings.scope, settings.reflections);
  }

  Result<GhostChoice> operator()(const SelectAll&) const { return listed({in_scope(), 0.0}); }
  Result<GhostChoice> operator()(const SelectBrightest& select) const {
    return by_flux([&](const auto&, const auto&) { return static_cast<std::size_t>(std::max(0, select.count)); });
  }
  Result<GhostChoice> operator()(const SelectByFlux& select) const {
    return by_flux([&](const auto& fraction, const auto& order) { return count_to_keep(select, fraction, order); });
  }
  Result<GhostChoice> operator()(const SelectList& select) const {
    const std::set<Ghost> once(select.ghosts.begin(), select.ghosts.end());
    return listed({{once.begin(), once.end()}});
  }
  Result<GhostChoice> operator()(const SelectSurface& select) const {
    return listed(those_where(in_scope(), [&](const Ghost& g) { return g.reflects_at(select.surface); }));
  }

 private:
  // A choice that did not need the ghosts' fluxes, with them if they are requested.
  [[nodiscard]] Result<GhostChoice> listed(GhostChoice choice) const {
    if (!measures) return choice;
    const GhostMeasuring measuring(lens, lights, tables, kept, settings);
    auto measured = measuring.measure(choice.ghosts, context);
    if (!measured) return tl::unexpected<Error>(measured.error());
    for (const Rgb& fraction : fractions_of(measured->flux)) choice.flux_fractions.push_back(largest(fraction));
    choice.pupils = std::move(measured->pupils);
    if (!measuring.fit(choice.ghosts, choice.pupils, context)) return interrupted();
    return choice;
  }

  // count(fractions, order) says how many ghosts to keep, given their fractions of the flux and their indices in
  // decreasing order of these.
  template <class Count>
  [[nodiscard]] Result<GhostChoice> by_flux(Count count) const {
    const auto all = in_scope();
    const GhostMeasuring measuring(lens, lights, tables, kept, settings);
    auto measured = measuring.measure(all, context);
    if (!measured) return tl::unexpected<Error>(measured.error());
    const std::vector<Rgb> fraction = fractions_of(measured->flux);
    const auto order = by_falling_fraction(fraction);
    GhostChoice choice = first_of(all, lights.size(), *measured, fraction, order, count(fraction, order));
    if (!measuring.fit(choice.ghosts, choice.pupils, context)) return interrupted();
    return choice;
  }
};

}  // namespace

Result<void> check_selection(const LensState& lens, const GhostSelection& selection) {
  const auto* const list = std::get_if<SelectList>(&selection);
  return list != nullptr ? check_list(lens, list->ghosts) : Result<void>();
}

Result<GhostChoice> select_ghosts(const LensState& lens, std::span<const PlannedLight> lights,
                                  const TablesByWavelength& tables, const KeptByGhost& kept,
                                  const FrameSettings& settings, bool measures, const Context& context) {
  return std::visit(Selector{lens, lights, tables, kept, settings, measures, context}, settings.selection);
}

}  // namespace contrejour::inline internal
