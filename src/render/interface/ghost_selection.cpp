#include "render/interface/ghost_selection.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>

#include <fmt/format.h>

#include "base/tasks.h"

namespace contrejour {
namespace {

constexpr double kGreen_nm = 550.0;  // ghosts are ranked there

// Flux of each ghost summed over the lights, weighted by their luminance, in green.
Result<std::vector<double>> ghost_fluxes(const LensState& lens, std::span<const Ghost> ghosts,
                                         std::span<const Light> lights, const RenderSettings& settings,
                                         const Context& context) {
  std::vector<double> flux(ghosts.size(), 0.0);
  Context quiet = context;
  quiet.progress = {};
  const GhostMeter meter(lens, kGreen_nm);
  const bool done = parallel_for(ghosts.size(), quiet, [&](std::size_t g) {
    for (const Light& light : lights) {
      const double weight = std::abs(luminance(light.value, settings.colour_space));
      flux[g] += weight * meter.measure(ghosts[g], light.source()).flux_mm2;
    }
  });
  if (!done) return interrupted();
  return flux;
}

// Indices of the ghosts by falling flux, ties in ghost order.
std::vector<std::size_t> by_falling_flux(const std::vector<double>& flux) {
  std::vector<std::size_t> order(flux.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return flux[a] > flux[b]; });
  return order;
}

std::size_t count_to_keep(const SelectByFlux& select, const std::vector<double>& flux,
                          const std::vector<std::size_t>& order) {
  const double allowed = std::accumulate(flux.begin(), flux.end(), 0.0) * select.drop_percent / 100.0;
  double dropped = 0.0;
  std::size_t keep = order.size();
  while (keep > 0 && dropped + flux[order[keep - 1]] <= allowed) dropped += flux[order[--keep]];
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

// The first so many of the order, back in (i, j) order.
GhostChoice first_of(const std::vector<Ghost>& all, const std::vector<double>& flux,
                     const std::vector<std::size_t>& order, std::size_t count) {
  std::vector<bool> is_kept(all.size(), false);
  for (std::size_t k = 0; k < std::min(count, order.size()); ++k) is_kept[order[k]] = true;
  GhostChoice out;
  double total = 0.0;
  double skipped = 0.0;
  for (std::size_t g = 0; g < all.size(); ++g) {
    total += flux[g];
    if (is_kept[g]) {
      out.ghosts.push_back(all[g]);
    } else {
      skipped += flux[g];
    }
  }
  out.skipped_flux = total > 0.0 ? skipped / total : 0.0;
  return out;
}

template <class Condition>
GhostChoice those_where(const std::vector<Ghost>& all, Condition condition) {
  GhostChoice out;
  std::copy_if(all.begin(), all.end(), std::back_inserter(out.ghosts), condition);
  return out;
}

// One selection of ghosts each.
struct Selector {
  const LensState& lens;
  std::span<const Light> lights;
  const RenderSettings& settings;
  const Context& context;

  [[nodiscard]] std::vector<Ghost> in_scope() const {
    return enumerate_ghosts(lens, settings.scope, settings.reflections);
  }

  Result<GhostChoice> operator()(const SelectAll&) const { return GhostChoice{in_scope(), 0.0}; }
  Result<GhostChoice> operator()(const SelectBrightest& select) const {
    return by_flux([&](const auto&, const auto&) { return static_cast<std::size_t>(std::max(0, select.count)); });
  }
  Result<GhostChoice> operator()(const SelectByFlux& select) const {
    return by_flux([&](const auto& flux, const auto& order) { return count_to_keep(select, flux, order); });
  }
  Result<GhostChoice> operator()(const SelectList& select) const {
    if (const auto ok = check_list(lens, select.ghosts); !ok) return tl::unexpected<Error>(ok.error());
    const std::set<Ghost> once(select.ghosts.begin(), select.ghosts.end());
    return GhostChoice{{once.begin(), once.end()}, std::nullopt};
  }
  Result<GhostChoice> operator()(const SelectSurface& select) const {
    return those_where(in_scope(), [&](const Ghost& g) {
      return g.i == select.surface || g.j == select.surface || g.k == select.surface || g.l == select.surface;
    });
  }

 private:
  // count(flux, order): how many to keep, given the fluxes and the ghosts' indices by falling flux.
  template <class Count>
  [[nodiscard]] Result<GhostChoice> by_flux(Count count) const {
    const auto all = in_scope();
    const auto flux = ghost_fluxes(lens, all, lights, settings, context);
    if (!flux) return tl::unexpected<Error>(flux.error());
    const auto order = by_falling_flux(*flux);
    return first_of(all, *flux, order, count(*flux, order));
  }
};

}  // namespace

Result<GhostChoice> select_ghosts(const LensState& lens, std::span<const Light> lights, const RenderSettings& settings,
                                  const Context& context) {
  return std::visit(Selector{lens, lights, settings, context}, settings.selection);
}

}  // namespace contrejour
