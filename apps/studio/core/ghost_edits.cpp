// SPDX-License-Identifier: Apache-2.0
#include "studio/core/ghost_edits.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "contrejour/expert/parameter_text.h"

namespace contrejour::studio {
namespace {

std::vector<Ghost> solo_ghosts(const Document& document) {
  const auto selection = params::parse_selection(document.text("select"));
  const auto* list = selection ? std::get_if<SelectList>(&*selection) : nullptr;
  return list != nullptr ? list->ghosts : std::vector<Ghost>{};
}

bool is_of_ghost(const std::string& text, const Ghost& ghost) {
  const auto adjustment = params::parse_ghost_adjustment(text);
  return adjustment && adjustment->surface == 0 && adjustment->ghost == ghost;
}

bool changes_nothing(const GhostAdjustment& a) {
  return a.gain == 1.0 && a.colour == Rgb{1, 1, 1} && a.offset == Vec2{};
}

std::string text_of_adjustment(const GhostAdjustment& a) {
  return fmt::format("{}:gain={},colour={},{},{},offset={},{}", ghost_name(a.ghost), a.gain, a.colour[0], a.colour[1],
                     a.colour[2], a.offset.x, a.offset.y);
}

Result<Document> with_adjustment(Document document, const GhostAdjustment& adjustment) {
  std::vector<std::string> texts = document.list("ghost");
  std::erase_if(texts, [&](const std::string& text) { return is_of_ghost(text, adjustment.ghost); });
  if (!changes_nothing(adjustment)) texts.push_back(text_of_adjustment(adjustment));
  return with_values(std::move(document), "ghost", texts);
}

}  // namespace

GhostAdjustment adjustment_of(const Document& document, const Ghost& ghost) {
  for (const std::string& text : document.list("ghost"))
    if (is_of_ghost(text, ghost)) return *params::parse_ghost_adjustment(text);
  GhostAdjustment none;
  none.ghost = ghost;
  return none;
}

bool is_muted(const Document& document, const Ghost& ghost) { return adjustment_of(document, ghost).gain == 0.0; }

bool is_solo(const Document& document, const Ghost& ghost) {
  const auto solo = solo_ghosts(document);
  return std::find(solo.begin(), solo.end(), ghost) != solo.end();
}

bool has_solo(const Document& document) { return !solo_ghosts(document).empty(); }

DrawnGhosts::DrawnGhosts(const Document& document) : solo_(solo_ghosts(document)) {
  for (const std::string& text : document.list("ghost")) {
    const auto adjustment = params::parse_ghost_adjustment(text);
    if (adjustment && adjustment->surface == 0 && adjustment->gain == 0.0) muted_.push_back(adjustment->ghost);
  }
  const auto selection = params::parse_selection(document.text("select"));
  const auto* surface = selection ? std::get_if<SelectSurface>(&*selection) : nullptr;
  if (surface != nullptr) surface_ = surface->surface;
}

bool DrawnGhosts::operator()(const Ghost& ghost) const {
  const auto has = [&](const std::vector<Ghost>& ghosts) { return std::ranges::find(ghosts, ghost) != ghosts.end(); };
  if (has(muted_) || (surface_ > 0 && !ghost.reflects_at(surface_))) return false;
  return solo_.empty() || has(solo_);
}

bool is_drawn(const Document& document, const Ghost& ghost) { return DrawnGhosts(document)(ghost); }

Result<Document> with_mute(Document document, const Ghost& ghost, bool muted) {
  return with_gain(std::move(document), ghost, muted ? 0.0 : 1.0);
}

Result<Document> with_solo(Document document, const Ghost& ghost, bool solo) {
  std::vector<Ghost> ghosts = solo_ghosts(document);
  std::erase(ghosts, ghost);
  if (solo) ghosts.push_back(ghost);
  if (ghosts.empty()) return without_value(std::move(document), "select");
  std::sort(ghosts.begin(), ghosts.end());
  std::vector<std::string> names;
  for (const Ghost& g : ghosts) names.push_back(ghost_name(g));
  return with_value(std::move(document), "select", fmt::format("list:{}", fmt::join(names, ",")));
}

Result<Document> with_gain(Document document, const Ghost& ghost, double gain) {
  GhostAdjustment adjustment = adjustment_of(document, ghost);
  adjustment.gain = gain;
  return with_adjustment(std::move(document), adjustment);
}

Result<Document> with_tint(Document document, const Ghost& ghost, const Rgb& colour) {
  GhostAdjustment adjustment = adjustment_of(document, ghost);
  adjustment.colour = colour;
  return with_adjustment(std::move(document), adjustment);
}

Result<Document> with_ghosts_of_surface(Document document, int surface) {
  const std::string selection = fmt::format("surface:{}", surface);
  if (document.text("select") == selection) return without_value(std::move(document), "select");
  return with_value(std::move(document), "select", selection);
}

Document with_all_ghosts(Document document) {
  return without_value(without_value(std::move(document), "select"), "ghost");
}

}  // namespace contrejour::studio
