// SPDX-License-Identifier: Apache-2.0
// The line at the bottom: what went wrong or was done last, the pixel under the mouse, the ghosts there.
#include <cmath>

#include <fmt/format.h>

#include "studio/core/ghost_edits.h"
#include "studio/core/ghosts_under.h"
#include "studio/ui/panels.h"
#include "studio/ui/theme.h"

namespace contrejour::studio {
namespace {

constexpr std::size_t kNamedGhosts = 5;

std::string ghosts_text(const Ui& ui) {
  const auto& figures = ui.studio.figures();
  auto under = ghosts_under(figures, {static_cast<double>(ui.state.probe.x), static_cast<double>(ui.state.probe.y)},
                            ui.studio.footprints());
  const Document& document = ui.studio.document();
  std::erase_if(under, [&](std::size_t k) { return !is_drawn(document, figures[k].ghost); });
  if (under.empty()) return "no ghost here";
  std::string text = under.size() == 1 ? "ghost" : "ghosts";
  for (std::size_t k = 0; k < std::min(under.size(), kNamedGhosts); ++k)
    text.append(" ").append(ghost_name(figures[under[k]].ghost));
  if (under.size() > kNamedGhosts) text += fmt::format(" and {} more", under.size() - kNamedGhosts);
  return text;
}

// Scene-linear, of the whole picture's pixels, and stops over mid grey.
std::string pixel_text(const Ui& ui) {
  const PictureAnswer& picture = ui.studio.shown().picture;
  if (!picture.image) return "";
  const double divisor = std::sqrt(picture.pixel_area);
  const int x = static_cast<int>(static_cast<double>(ui.state.probe.x) / divisor),
            y = static_cast<int>(static_cast<double>(ui.state.probe.y) / divisor);
  if (x < 0 || y < 0 || x >= picture.image->width || y >= picture.image->height) return "";
  const auto value = [&](int c) { return static_cast<double>(picture.image->at(x, y, c)) / picture.pixel_area; };
  const double luminance = 0.2126 * value(0) + 0.7152 * value(1) + 0.0722 * value(2);
  const std::string stops = luminance > 0 ? fmt::format("{:+.1f} EV", std::log2(luminance / 0.18)) : "black";
  return fmt::format("{}, {}    R {:.4g}  G {:.4g}  B {:.4g}    {}", static_cast<int>(ui.state.probe.x),
                     static_cast<int>(ui.state.probe.y), value(0), value(1), value(2), stops);
}

}  // namespace

void draw_status_bar(Ui& ui) {
  const bool has_problem = !ui.studio.problem().empty();
  const std::string left = has_problem ? ui.studio.problem() : ui.studio.message();
  ImGui::AlignTextToFramePadding();
  // The problem has the whole line while the mouse is not in the picture.
  const float room = ImGui::GetContentRegionAvail().x, half = 0.5F * room;
  fitting_text(left.empty() ? "Drag the light. Click a ghost to see its path." : left,
               ui.state.probe.x < 0 ? room : half - scaled(20), has_problem ? colours::kBad : colours::dim());
  ui.registry.record("status", left);
  if (ui.state.probe.x < 0) return;
  const std::string probe = pixel_text(ui) + "    " + ghosts_text(ui);
  ImGui::SameLine(half);
  fitting_text(probe, half - scaled(10), colours::text());
  ui.registry.record("status/probe", probe);
}

}  // namespace contrejour::studio
