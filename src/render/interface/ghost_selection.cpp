#include "render/interface/ghost_selection.h"

#include <algorithm>
#include <cmath>
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
      flux[g] += weight * meter.measure(ghosts[g], normalized(light.direction)).flux_mm2;
    }
  });
  if (!done) return failure(ErrorCode::Cancelled, "interrupted");
  return flux;
}

// Indices of the ghosts to keep, given their fluxes; by falling flux, ties in ghost order.
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

Result<void> check_list(const std::vector<Ghost>& list, std::span<const Ghost> all) {
  for (const Ghost& g : list) {
    if (std::find(all.begin(), all.end(), g) == all.end()) {
      return failure(ErrorCode::InvalidArgument,
                     fmt::format("there is no ghost {}-{} in this lens; `contrejour ghosts` lists those there are", g.i, g.j));
    }
  }
  return {};
}

GhostChoice keep_ghosts(const std::vector<Ghost>& all, const std::vector<double>& flux,
                        const std::set<std::size_t>& kept) {
  GhostChoice out;
  double total = 0.0;
  double skipped = 0.0;
  for (std::size_t g = 0; g < all.size(); ++g) {
    total += flux[g];
    if (kept.count(g) > 0) {
      out.ghosts.push_back(all[g]);
    } else {
      skipped += flux[g];
    }
  }
  out.skipped_flux = total > 0.0 ? skipped / total : 0.0;
  return out;
}

// Indices of the ghosts that a selection keeps.
class Kept {
 public:
  Kept(const std::vector<Ghost>& all, const std::vector<double>& flux) : all_(all), flux_(flux) {}

  std::set<std::size_t> operator()(const SelectAll&) const { return first(all_.size()); }
  std::set<std::size_t> operator()(const SelectBrightest& select) const {
    return first(static_cast<std::size_t>(std::max(0, select.count)));
  }
  std::set<std::size_t> operator()(const SelectByFlux& select) const {
    return first(count_to_keep(select, flux_, by_falling_flux(flux_)));
  }
  std::set<std::size_t> operator()(const SelectList& select) const {
    return where([&](const Ghost& g) {
      return std::find(select.ghosts.begin(), select.ghosts.end(), g) != select.ghosts.end();
    });
  }
  std::set<std::size_t> operator()(const SelectSurface& select) const {
    return where([&](const Ghost& g) { return g.i == select.surface || g.j == select.surface; });
  }

 private:
  [[nodiscard]] std::set<std::size_t> first(std::size_t count) const {
    const auto order = by_falling_flux(flux_);
    return {order.begin(), order.begin() + static_cast<std::ptrdiff_t>(std::min(count, order.size()))};
  }
  template <class Condition>
  [[nodiscard]] std::set<std::size_t> where(Condition condition) const {
    std::set<std::size_t> kept;
    for (std::size_t g = 0; g < all_.size(); ++g) {
      if (condition(all_[g])) kept.insert(g);
    }
    return kept;
  }

  const std::vector<Ghost>& all_;
  const std::vector<double>& flux_;
};

}  // namespace

Result<GhostChoice> select_ghosts(const LensState& lens, std::span<const Light> lights, const RenderSettings& settings,
                                  const Context& context) {
  if (std::holds_alternative<SelectAll>(settings.selection)) return GhostChoice{enumerate_ghosts(lens, settings.scope), 0};
  const auto* list = std::get_if<SelectList>(&settings.selection);
  const auto all = enumerate_ghosts(lens, list != nullptr ? GhostScope::All : settings.scope);
  if (list != nullptr) {
    if (const auto ok = check_list(list->ghosts, all); !ok) return tl::unexpected<Error>(ok.error());
  }
  const auto flux = ghost_fluxes(lens, all, lights, settings, context);
  if (!flux) return tl::unexpected<Error>(flux.error());
  return keep_ghosts(all, *flux, std::visit(Kept(all, *flux), settings.selection));
}

}  // namespace contrejour
