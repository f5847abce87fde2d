// SPDX-License-Identifier: Apache-2.0
#include "cli/ghost_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "cli/text_table.h"

namespace contrejour::cli {
namespace {

constexpr double kSortedLast = std::numeric_limits<double>::infinity();

// The key that ghosts are sorted by, in increasing order.
double rank_of(const GhostFigures& g, GhostOrder order) {
  switch (order) {
    case GhostOrder::Flux: return -g.relative_flux;
    case GhostOrder::Peak: return -g.peak_irradiance;
    case GhostOrder::Size: return g.relative_flux > 0.0 ? g.size_mm.x * g.size_mm.y : kSortedLast;
    case GhostOrder::Focus: return g.first_order.focus_mm ? std::abs(*g.first_order.focus_mm) : kSortedLast;
  }
  return 0.0;
}

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

std::string flags_text(const GhostFigures& g) {
  std::string flags = g.in_focus ? "focus" : "";
  if (g.pupil_ghost) flags += flags.empty() ? "pupil" : ",pupil";
  return flags;
}

}  // namespace

void sort_ghosts(std::vector<GhostFigures>& figures, GhostOrder order) {
  std::stable_sort(figures.begin(), figures.end(),
                   [&](const GhostFigures& a, const GhostFigures& b) { return rank_of(a, order) < rank_of(b, order); });
}

Json surfaces_json(const Ghost& ghost) {
  Json surfaces = {ghost.i, ghost.j};
  if (ghost.reflects_four_times()) surfaces.insert(surfaces.end(), {ghost.k, ghost.l});
  return surfaces;
}

Json ghosts_json(const std::vector<GhostFigures>& figures) {
  Json ghosts = Json::array();
  for (const GhostFigures& g : figures) {
    ghosts.push_back({{"surfaces", surfaces_json(g.ghost)},
                      {"order", g.ghost.order},
                      {"relative_flux", g.relative_flux},
                      {"peak_irradiance", g.peak_irradiance},
                      {"reflectance", g.reflectance},
                      {"centroid_px", {g.centroid_px.x, g.centroid_px.y}},
                      {"size_px", {g.size_px.x, g.size_px.y}},
                      {"centroid_mm", {g.centroid_mm.x, g.centroid_mm.y}},
                      {"size_mm", {g.size_mm.x, g.size_mm.y}},
                      {"rgb", g.rgb},
                      {"paraxial_focus_mm", or_null(g.first_order.focus_mm)},
                      {"paraxial_blur_mm", g.first_order.blur_mm},
                      {"stop_image_mm", or_null(g.first_order.stop_image_mm)},
                      {"in_focus", g.in_focus},
                      {"pupil_ghost", g.pupil_ghost}});
  }
  return ghosts;
}

std::string ghosts_text(const std::vector<GhostFigures>& figures) {
  TextTable table({"ghost", "flux", "peak", "R x R", "x px", "y px", "w px", "h px", "x mm", "y mm", "w mm", "h mm",
                   "R", "G", "B", "focus mm", "blur mm", "<flags"});
  for (const GhostFigures& g : figures) {
    const auto number = [](double value) { return fmt::format("{:.3g}", value); };
    const auto pixels = [](double value) { return fmt::format("{:.1f}", value); };
    const auto mm = [](double value) { return fmt::format("{:.3f}", value); };
    const auto focus_mm = g.first_order.focus_mm;
    table.add({ghost_name(g.ghost), number(g.relative_flux), number(g.peak_irradiance), number(g.reflectance),
               pixels(g.centroid_px.x), pixels(g.centroid_px.y), pixels(g.size_px.x), pixels(g.size_px.y),
               mm(g.centroid_mm.x), mm(g.centroid_mm.y), mm(g.size_mm.x), mm(g.size_mm.y), number(g.rgb[0]),
               number(g.rgb[1]), number(g.rgb[2]), focus_mm ? pixels(*focus_mm) : "-", number(g.first_order.blur_mm),
               flags_text(g)});
  }
  return table.text();
}

std::string csv_name(const Ghost& ghost) {
  const std::string plain = ghost_name(ghost);
  return plain.find(',') == std::string::npos ? plain : "\"" + plain + "\"";
}

std::string ghosts_csv(const std::vector<GhostFigures>& figures) {
  std::string out =
      "ghost,relative_flux,peak_irradiance,reflectance,centroid_x_px,centroid_y_px,width_px,height_px,centroid_x_mm,"
      "centroid_y_mm,width_mm,height_mm,r,g,b,paraxial_focus_mm,paraxial_blur_mm,stop_image_mm,in_focus,pupil_ghost\n";
  const auto or_empty = [](const std::optional<double>& value) { return value ? fmt::format("{}", *value) : ""; };
  for (const GhostFigures& g : figures) {
    out += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", csv_name(g.ghost),
                       g.relative_flux, g.peak_irradiance, g.reflectance, g.centroid_px.x, g.centroid_px.y, g.size_px.x,
                       g.size_px.y, g.centroid_mm.x, g.centroid_mm.y, g.size_mm.x, g.size_mm.y, g.rgb[0], g.rgb[1],
                       g.rgb[2], or_empty(g.first_order.focus_mm), g.first_order.blur_mm,
                       or_empty(g.first_order.stop_image_mm), g.in_focus ? 1 : 0, g.pupil_ghost ? 1 : 0);
  }
  return out;
}

}  // namespace contrejour::cli
