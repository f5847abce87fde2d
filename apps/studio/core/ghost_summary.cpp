// SPDX-License-Identifier: Apache-2.0
#include "studio/core/ghost_summary.h"

#include <algorithm>

#include <fmt/format.h>

#include "studio/core/ghost_edits.h"
#include "studio/core/lights.h"

namespace contrejour::studio {
namespace {

constexpr std::size_t kThatMatter = 10;

std::string reason_of(const Document& document) {
  const std::string select = document.text("select");
  if (has_solo(document)) return "solo";
  if (select.starts_with("surface:")) return "of surface " + select.substr(select.find(':') + 1);
  return "the others are muted";
}

std::string text_of(const Document& document, const std::vector<GhostFigures>& figures) {
  double all = 0, first = 0, drawn = 0;
  std::size_t count = 0;
  const DrawnGhosts is_drawn(document);
  for (std::size_t k = 0; k < figures.size(); ++k) {
    const double flux = figures[k].relative_flux;
    all += flux;
    if (k < kThatMatter) first += flux;
    if (!is_drawn(figures[k].ghost)) continue;
    drawn += flux;
    ++count;
  }
  if (count == figures.size())
    return fmt::format("{} ghosts, {:.2f} % of the light; ten carry {:.0f} % of it", count, 100 * all,
                       all > 0 ? 100 * first / all : 0.0);
  return fmt::format("{} of {} ghosts shown ({}), {:.3g} % of the light", count, figures.size(), reason_of(document),
                     100 * drawn);
}

}  // namespace

std::string summary_of_ghosts(const Document& document, const std::vector<GhostFigures>& figures, std::size_t light,
                              std::size_t listed) {
  if (figures.empty()) return "measuring\u2026";
  const std::string whose = lights_of(document).size() > 1 ? fmt::format("Light {}: ", light + 1) : "";
  const std::string list = listed < figures.size() ? fmt::format("{} listed of ", listed) : "";
  return whose + list + text_of(document, figures);
}

}  // namespace contrejour::studio
