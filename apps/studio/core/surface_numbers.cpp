// SPDX-License-Identifier: Apache-2.0
#include "studio/core/surface_numbers.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "contrejour/expert/ghost_id.h"
#include "contrejour/expert/parameter_text.h"

namespace contrejour::studio {
namespace {

using Texts = std::vector<std::string>;

int new_number(const SurfaceNumbers& numbers, int surface) {
  const bool is_known = surface >= 1 && static_cast<std::size_t>(surface) <= numbers.size();
  return is_known ? numbers[static_cast<std::size_t>(surface) - 1] : 0;
}

// A reversed lens passes the ghost's surfaces from the other end.
std::optional<Ghost> renumbered(Ghost ghost, const SurfaceNumbers& numbers) {
  const bool four = ghost.reflects_four_times();
  ghost.i = new_number(numbers, ghost.i);
  ghost.j = new_number(numbers, ghost.j);
  if (four) ghost.k = new_number(numbers, ghost.k), ghost.l = new_number(numbers, ghost.l);
  const bool is_gone = ghost.i == 0 || ghost.j == 0 || (four && (ghost.k == 0 || ghost.l == 0));
  if (is_gone || (four && ghost.i > ghost.j)) return std::nullopt;  // four reflections backwards are another ghost
  if (ghost.i > ghost.j) std::swap(ghost.i, ghost.j);
  return ghost;
}

// "12:v-coat:550"
std::string renumbered_coating(const std::string& text, const SurfaceNumbers& numbers) {
  const auto coating = params::parse_coating_at(text);
  const int surface = coating ? new_number(numbers, coating->surface) : 0;
  return surface > 0 ? fmt::format("{}{}", surface, text.substr(text.find(':'))) : "";
}

// "2-5:gain=2", "12:gain=2"
std::string renumbered_adjustment(const std::string& text, const SurfaceNumbers& numbers) {
  const auto adjustment = params::parse_ghost_adjustment(text);
  if (!adjustment) return "";
  const std::string rest = text.substr(std::min(text.find(':'), text.size()));
  if (adjustment->surface > 0) {
    const int surface = new_number(numbers, adjustment->surface);
    return surface > 0 ? fmt::format("{}{}", surface, rest) : "";
  }
  const auto ghost = renumbered(adjustment->ghost, numbers);
  return ghost ? ghost_name(*ghost) + rest : "";
}

// "surface:3", "list:2-5,3-7"; others name no surface.
std::string renumbered_selection(const std::string& text, const SurfaceNumbers& numbers) {
  const auto selection = params::parse_selection(text);
  if (!selection) return "";
  if (const auto* of = std::get_if<SelectSurface>(&*selection)) {
    const int surface = new_number(numbers, of->surface);
    return surface > 0 ? fmt::format("surface:{}", surface) : "";
  }
  const auto* list = std::get_if<SelectList>(&*selection);
  if (list == nullptr) return text;
  Texts names;
  for (const Ghost& ghost : list->ghosts)
    if (const auto now = renumbered(ghost, numbers)) names.push_back(ghost_name(*now));
  return names.empty() ? "" : fmt::format("list:{}", fmt::join(names, ","));
}

void renumber(Document& document, const char* name, const SurfaceNumbers& numbers,
              const std::function<std::string(const std::string&, const SurfaceNumbers&)>& of_text) {
  const auto found = document.texts.find(name);
  if (found == document.texts.end()) return;
  Texts texts;
  for (const std::string& text : found->second)
    if (std::string now = of_text(text, numbers); !now.empty()) texts.push_back(std::move(now));
  if (texts.empty())
    document.texts.erase(found);
  else
    found->second = std::move(texts);
}

}  // namespace

SurfaceNumbers numbers_after_insertion(std::size_t count, std::size_t row) {
  SurfaceNumbers numbers;
  for (std::size_t k = 0; k < count; ++k) numbers.push_back(static_cast<int>(k <= row ? k + 1 : k + 2));
  return numbers;
}

SurfaceNumbers numbers_after_deletion(std::size_t count, std::size_t row) {
  SurfaceNumbers numbers;
  for (std::size_t k = 0; k < count; ++k) numbers.push_back(k == row ? 0 : static_cast<int>(k < row ? k + 1 : k));
  return numbers;
}

SurfaceNumbers numbers_after_reversal(std::size_t count) {
  SurfaceNumbers numbers;
  for (std::size_t k = 0; k < count; ++k) numbers.push_back(static_cast<int>(count - k));
  return numbers;
}

Document with_surface_numbers(Document document, const SurfaceNumbers& numbers) {
  renumber(document, "coating-at", numbers, renumbered_coating);
  renumber(document, "ghost", numbers, renumbered_adjustment);
  renumber(document, "select", numbers, renumbered_selection);
  return document;
}

}  // namespace contrejour::studio
