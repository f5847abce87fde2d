// SPDX-License-Identifier: Apache-2.0
// Settings and presets for C callers.
#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "c_interface/boundary.h"
#include "c_interface/objects.h"
#include "contrejour/expert/nearest_name.h"
#include "contrejour/expert/parameter.h"

namespace contrejour {
namespace {

// The parameter of this name or former name.
Result<const params::Parameter*> find_parameter(const char* name) {
  if (const auto given = require(name, "name"); !given) return tl::unexpected(given.error());
  std::vector<std::string_view> names;
  for (const params::Parameter& p : params::all_parameters()) {
    if (p.name == name || (!p.former.empty() && p.former == name)) return &p;
    names.push_back(p.name);
  }
  const std::string nearest = nearest_name(name, names);
  return invalid_argument(
      fmt::format("there is no parameter \"{}\"; {}", std::string_view(name).substr(0, 60),
                  nearest.empty() ? "cj_parameter_get() lists them" : "did you mean " + nearest + "?"));
}

// The values given to a parameter, or its default.
std::vector<std::string> texts_of(const params::Values& values, const params::Parameter& p) {
  if (p.repeats) return values.list(p.name);
  const auto text = values.text(p.name);
  return text ? std::vector<std::string>{*text} : std::vector<std::string>{};
}

Result<void> set_text(params::Values& values, const char* name, const char* text) {
  const auto found = find_parameter(name);
  if (!found) return tl::unexpected(found.error());
  if (const auto given = require(text, "text"); !given) return given;
  auto set = values.set((*found)->name, text);
  if (!set) set.error().message = fmt::format("{}: {}", (*found)->name, set.error().message);
  return set;
}

// All values but those of one parameter.
Result<params::Values> without(const params::Values& values, const params::Parameter& left_out) {
  params::Values rest;
  for (const params::Parameter& p : params::all_parameters()) {
    if (&p == &left_out || !values.given(p.name)) continue;
    for (std::string& text : texts_of(values, p))
      if (auto set = rest.set(p.name, std::move(text)); !set) return tl::unexpected(set.error());
  }
  return rest;
}

void copy_text(std::string_view text, char* buffer, std::size_t size, std::size_t* length) {
  if (length != nullptr) *length = text.size();
  if (buffer == nullptr || size == 0) return;
  const std::size_t count = std::min(text.size(), size - 1);
  std::copy_n(text.begin(), count, buffer);
  buffer[count] = '\0';
}

const std::vector<std::string>& preset_names() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const params::BundledPreset& preset : params::bundled_presets()) names.emplace_back(preset.name);
    return names;
  }();
  return kNames;
}

}  // namespace
}  // namespace contrejour

using contrejour::Result;

cj_status cj_settings_create(cj_settings** settings, cj_error* error) {
  return contrejour::guarded_create(settings, error, []() -> Result<cj_settings> { return cj_settings{}; });
}

cj_status cj_settings_copy(const cj_settings* settings, cj_settings** copy, cj_error* error) {
  return contrejour::guarded_create(copy, error, [&]() -> Result<cj_settings> {
    if (const auto given = contrejour::require(settings, "settings"); !given) return tl::unexpected(given.error());
    return *settings;
  });
}

void cj_settings_destroy(cj_settings* settings) { delete settings; }

cj_status cj_settings_set(cj_settings* settings, const char* name, const char* text, cj_error* error) {
  return contrejour::guarded(error, [&]() -> Result<void> {
    if (const auto given = contrejour::require(settings, "settings"); !given) return given;
    return contrejour::set_text(settings->values, name, text);
  });
}

cj_status cj_settings_reset(cj_settings* settings, const char* name, cj_error* error) {
  return contrejour::guarded(error, [&]() -> Result<void> {
    if (const auto given = contrejour::require(settings, "settings"); !given) return given;
    const auto found = contrejour::find_parameter(name);
    if (!found) return tl::unexpected(found.error());
    auto rest = contrejour::without(settings->values, **found);
    if (!rest) return tl::unexpected(rest.error());
    settings->values = std::move(*rest);
    return {};
  });
}

cj_status cj_settings_count(const cj_settings* settings, const char* name, size_t* count, cj_error* error) {
  return contrejour::guarded(error, [&]() -> Result<void> {
    if (const auto given = contrejour::require(settings, "settings"); !given) return given;
    if (const auto given = contrejour::require(count, "count"); !given) return given;
    const auto found = contrejour::find_parameter(name);
    if (!found) return tl::unexpected(found.error());
    *count = contrejour::texts_of(settings->values, **found).size();
    return {};
  });
}

cj_status cj_settings_get(const cj_settings* settings, const char* name, size_t index, char* buffer, size_t size,
                          size_t* length, cj_error* error) {
  return contrejour::guarded(error, [&]() -> Result<void> {
    if (const auto given = contrejour::require(settings, "settings"); !given) return given;
    const auto found = contrejour::find_parameter(name);
    if (!found) return tl::unexpected(found.error());
    const auto texts = contrejour::texts_of(settings->values, **found);
    if (index >= texts.size())
      return contrejour::invalid_argument(
          fmt::format("{} has {} values, counted from 0", (*found)->name, texts.size()));
    contrejour::copy_text(texts[index], buffer, size, length);
    return {};
  });
}

cj_status cj_settings_load_preset(cj_settings* settings, const char* name_or_file, cj_error* error) {
  return contrejour::guarded(error, [&]() -> Result<void> {
    if (const auto given = contrejour::require(settings, "settings"); !given) return given;
    if (const auto given = contrejour::require(name_or_file, "name_or_file"); !given) return given;
    auto preset = contrejour::params::find_preset(name_or_file);
    if (!preset) return tl::unexpected(preset.error());
    settings->values = settings->values.over(preset->values);
    settings->lens = std::move(preset->lens);
    return {};
  });
}

const char* cj_settings_lens(const cj_settings* settings) { return settings != nullptr ? settings->lens.c_str() : ""; }

size_t cj_bundled_preset_count(void) {
  return contrejour::guarded_value(size_t{0}, [] { return contrejour::preset_names().size(); });
}

const char* cj_bundled_preset_name(size_t index) {
  return contrejour::guarded_value<const char*>(nullptr,
                                                [&] { return contrejour::text_at(contrejour::preset_names(), index); });
}
