// SPDX-License-Identifier: Apache-2.0
// Identity, regions, clip preferences, and the button that loads a look.
#include <algorithm>

#include "contrejour/expert/parameter_text.h"
#include "contrejour/preset.h"
#include "openfx/actions.h"
#include "openfx/read_parameters.h"
#include "openfx/regions.h"

namespace contrejour::openfx {
namespace {

// Sets a parameter of the host to a value of the library's.
void set_parameter(const Instance& instance, std::size_t k, const params::Values& values) {
  const ParamSpec& spec = instance.specs()[k];
  const ParameterSuite& suite = *instance.host().parameters;
  const ParamHandle param = instance.handle(k);
  const std::string text = values.text(spec.row->name).value_or("");
  switch (spec.type) {
    case ParamType::Real: suite.set_value(param, text.empty() ? spec.fallback[0] : *params::parse_real(text)); return;
    case ParamType::Integer:
      suite.set_value(param, text.empty() ? static_cast<int>(spec.fallback[0]) : *params::parse_integer(text));
      return;
    case ParamType::Boolean: suite.set_value(param, text == "on" ? 1 : 0); return;
    case ParamType::Choice: {
      const auto found = std::ranges::find(spec.choices, text);
      suite.set_value(param, found == spec.choices.end() ? 0 : static_cast<int>(found - spec.choices.begin()));
      return;
    }
    default: {
      std::string joined = text;
      if (spec.row->repeats) {
        joined.clear();
        for (const std::string& part : values.list(spec.row->name)) joined += (joined.empty() ? "" : "; ") + part;
      }
      suite.set_value(param, joined.c_str());
    }
  }
}

void set_own_choice(const Instance& instance, const char* name, int index) {
  const auto k = instance.find(name);
  if (k && instance.handle(*k) != nullptr) instance.host().parameters->set_value(instance.handle(*k), index);
}

// A lens that no menu has stays the look's file's affair.
void set_lens(const Instance& instance, const std::string& lens) {
  const auto menu = lens_menu();
  const auto found = std::ranges::find(menu, lens);
  if (found != menu.end()) set_own_choice(instance, own::kLens, static_cast<int>(found - menu.begin()) + 1);
  const auto file = instance.find(own::kLensFile);
  if (found == menu.end() && !lens.empty() && file && instance.handle(*file) != nullptr)
    instance.host().parameters->set_value(instance.handle(*file), lens.c_str());
}

void load_look(Instance& instance, Time time) {
  const auto read = read_parameters(instance, time);
  if (!read || read->look.empty()) return;
  const auto look = params::find_preset(read->look);
  if (!look) return instance.show_fault(look.error().to_string());
  const ParameterSuite& suite = *instance.host().parameters;
  suite.edit_begin(instance.parameter_set(), "Load look");
  for (std::size_t k = 0; k < instance.specs().size(); ++k) {
    const ParamSpec& spec = instance.specs()[k];
    if (spec.row == nullptr || !params::belongs_to_preset(*spec.row) || instance.handle(k) == nullptr) continue;
    set_parameter(instance, k, look->values);
  }
  if (read->lens.empty()) set_lens(instance, look->lens);
  set_own_choice(instance, own::kLook, 0);
  const auto file = instance.find(own::kLookFile);
  if (file && instance.handle(*file) != nullptr) suite.set_value(instance.handle(*file), "");
  suite.edit_end(instance.parameter_set());
}

}  // namespace

Status is_identity(const Instance& instance, const Properties& in, const Properties& out) {
  const auto time = in.real(name::kTime);
  if (!time || !instance.is_connected(instance.clip(clip::kSource))) return status::kReplyDefault;
  const auto read = read_parameters(instance, *time);
  if (!read || read->output != OutputPicture::SourceAndFlare || read->alpha != OutputAlpha::Source)
    return status::kReplyDefault;
  const bool is_off = read->own.given("gain") && read->own.number("gain") == 0.0;
  if (!is_off && !read->is_without_lights()) return status::kReplyDefault;
  out.set(name::kName, clip::kSource);
  out.set(name::kTime, *time);
  return status::kOk;
}

Status region_of_definition(const Instance& instance, const Properties& in, const Properties& out) {
  const auto time = in.real(name::kTime);
  if (!time) return status::kReplyDefault;
  out.set(name::kRegionOfDefinition, output_region(instance, *time, sensor_frame_choice(instance, *time)));
  return status::kOk;
}

// Lights are found in the whole source, whatever part of the output is asked for.
Status regions_of_interest(const Instance& instance, const Properties& in, const Properties& out) {
  const auto time = in.real(name::kTime);
  if (!time) return status::kReplyDefault;
  const auto region = source_region(instance, *time);
  if (!region) return status::kReplyDefault;
  out.set(name::kClipRoiOfSource, *region);
  return status::kOk;
}

// A file of lights changes with the frame, which the host cannot see.
Status clip_preferences(const Instance& instance, const Properties& out) {
  const auto read = read_parameters(instance, 0.0);
  if (!read || read->lights_file.empty()) return status::kReplyDefault;
  out.set(name::kFrameVarying, 1);
  return status::kOk;
}

Status instance_changed(Instance& instance, const Properties& in) {
  if (in.text(name::kChangeReason) != value::kUserEdited || in.text(name::kName) != own::kLoadLook)
    return status::kReplyDefault;
  load_look(instance, in.real(name::kTime).value_or(0.0));
  return status::kOk;
}

}  // namespace contrejour::openfx
