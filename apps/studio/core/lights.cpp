// SPDX-License-Identifier: Apache-2.0
#include "studio/core/lights.h"

#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "contrejour/expert/parameter_text.h"

namespace contrejour::studio {
namespace {

constexpr double kFarthest = 20.0;  // frames; the handle of a light that is farther away could not be found again

LightEntry entry_of(const std::string& text) {
  const auto parts = params::split(text, ':');
  LightEntry light;
  if (const auto at = params::parse_reals(parts[0], 2)) light.at = {(*at)[0], (*at)[1]};
  const std::array<std::string*, 4> rest = {&light.value, &light.colour, &light.size, &light.distance};
  for (std::size_t k = 0; k < rest.size() && k + 1 < parts.size(); ++k) *rest[k] = std::string(parts[k + 1]);
  return light;
}

constexpr double kPlaces = 1e5;  // a hundredth of a pixel in any picture: enough for a hand

// Positions between two keys have more places than those that a hand has set.
std::string text_of_place(double value) {
  const bool is_short = std::fabs(std::round(value * kPlaces) / kPlaces - value) < 1e-12;
  return is_short ? fmt::format("{:.5f}", value) : fmt::format("{}", value);
}

std::string text_of(const LightEntry& light) {
  std::string text = fmt::format("{},{}:{}:{}:{}:{}", text_of_place(light.at.x), text_of_place(light.at.y), light.value,
                                 light.colour, light.size, light.distance);
  text.erase(text.find_last_not_of(':') + 1);
  return text;
}

Vec2 within_reach(Vec2 at) {
  const auto near = [](double v) {
    return std::round(kPlaces * std::fmax(-kFarthest, std::fmin(kFarthest, v))) / kPlaces;
  };
  return {near(at.x), near(at.y)};
}

}  // namespace

std::vector<LightEntry> lights_of(const Document& document) {
  std::vector<LightEntry> lights;
  for (const std::string& text : document.list("light-at")) lights.push_back(entry_of(text));
  return lights;
}

Result<Document> with_lights(Document document, const std::vector<LightEntry>& lights) {
  std::vector<std::string> texts;
  for (const LightEntry& light : lights) texts.push_back(text_of(light));
  return with_values(std::move(document), "light-at", texts);
}

Result<Document> with_light_at(const Document& document, std::size_t index, Vec2 at) {
  auto lights = lights_of(document);
  lights.at(index).at = within_reach(at);
  return with_lights(document, lights);
}

Result<Document> with_light(const Document& document, std::size_t index, const LightEntry& light) {
  auto lights = lights_of(document);
  lights.at(index) = light;
  return with_lights(document, lights);
}

Result<Document> with_new_light(const Document& document, const LightEntry& light) {
  auto lights = lights_of(document);
  lights.push_back(light);
  lights.back().at = within_reach(light.at);
  return with_lights(document, lights);
}

Result<Document> without_light(const Document& document, std::size_t index) {
  auto lights = lights_of(document);
  if (lights.size() <= 1) return invalid_argument("this is the only light; add another one before you remove it");
  lights.erase(lights.begin() + static_cast<std::ptrdiff_t>(index));
  return with_lights(document, lights);
}

}  // namespace contrejour::studio
