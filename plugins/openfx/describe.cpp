// SPDX-License-Identifier: Apache-2.0
// Describes the effect, its clips and its parameters to the host.
#include <string>

#include "openfx/actions.h"

namespace contrejour::openfx {
namespace {

constexpr const char* kDescription =
    "Physically based lens flare: rays are traced through the surfaces of a real lens, so that each ghost has its true "
    "shape, colour and brightness. Lights are set by position, read from a file, or found in the picture.";

void set_all(const Properties& properties, const char* property, std::initializer_list<const char*> values) {
  int index = 0;
  for (const char* const value : values) properties.set(property, value, index++);
}

void define_clip(const Host& host, EffectHandle effect, const char* clip, bool is_optional) {
  PropertySetHandle set = nullptr;
  if (host.effects->clip_define(effect, clip, &set) != status::kOk) return;
  const Properties properties = host.of(set);
  set_all(properties, name::kSupportedComponents, {value::kRgba, value::kRgb});
  properties.set(name::kSupportsTiles, 0);
  properties.set(name::kTemporalClipAccess, 0);
  properties.set(name::kClipFieldExtraction, value::kFieldDoubled);  // frames of full height, whose geometry is right
  if (is_optional) properties.set(name::kClipOptional, 1);
}

const char* host_type_of(const ParamSpec& spec) {
  switch (spec.type) {
    case ParamType::Real: return type::kDouble;
    case ParamType::Integer: return type::kInteger;
    case ParamType::Boolean: return type::kBoolean;
    case ParamType::Choice: return type::kChoice;
    case ParamType::Position: return type::kDouble2D;
    case ParamType::Colour: return type::kRgb;
    case ParamType::Button: return type::kPushButton;
    case ParamType::Group: return type::kGroup;
    case ParamType::Text:
    case ParamType::File: break;
  }
  return type::kString;
}

// Positions are plain numbers for a host, which then leaves their coordinates alone. MLT passes on the second number of
// a pair only if the pair is a point, and passes normalised ones on as they are.
void set_position(const Host& host, const Properties& properties) {
  properties.set(name::kDoubleType, host.is_mlt() ? value::kDoublePoint : value::kDoublePlain);
  if (host.is_mlt()) properties.set(name::kDefaultCoordinateSystem, value::kNormalised);
  properties.set(name::kDigits, 4);
}

// Both ranges are given for each component: some hosts clamp to -1..1 where one is missing.
template <class Number>
void set_range(const Properties& properties, const ParamSpec& spec) {
  for (int k = 0; k < static_cast<int>(spec.fallback.size()); ++k) {
    properties.set(name::kDefault, static_cast<Number>(spec.fallback[static_cast<std::size_t>(k)]), k);
    properties.set(name::kMin, static_cast<Number>(spec.minimum), k);
    properties.set(name::kMax, static_cast<Number>(spec.maximum), k);
    properties.set(name::kDisplayMin, static_cast<Number>(spec.display_minimum), k);
    properties.set(name::kDisplayMax, static_cast<Number>(spec.display_maximum), k);
  }
}

void set_values(const Host& host, const Properties& properties, const ParamSpec& spec) {
  switch (spec.type) {
    case ParamType::Real:
      // The angles of the table are in degrees, as those of the host: plain numbers, which no host converts.
      properties.set(name::kDoubleType, value::kDoublePlain);
      properties.set(name::kDigits, 4);
      return set_range<double>(properties, spec);
    case ParamType::Position: set_position(host, properties); return set_range<double>(properties, spec);
    case ParamType::Colour: return set_range<double>(properties, spec);
    case ParamType::Integer: return set_range<int>(properties, spec);
    case ParamType::Boolean: return properties.set(name::kDefault, spec.fallback[0] != 0.0 ? 1 : 0);
    case ParamType::Choice:
      for (std::size_t k = 0; k < spec.choices.size(); ++k)
        properties.set(name::kChoiceOption, spec.choices[k], static_cast<int>(k));
      return properties.set(name::kDefault, static_cast<int>(spec.fallback[0]));
    case ParamType::Text:
    case ParamType::File:
      properties.set(name::kStringMode, spec.type == ParamType::File ? value::kFilePath : value::kSingleLine);
      if (spec.type == ParamType::File) properties.set(name::kStringFilePathExists, 1);
      return properties.set(name::kDefault, spec.text);
    case ParamType::Group: return properties.set(name::kGroupOpen, spec.open ? 1 : 0);
    case ParamType::Button: return;
  }
}

void define_parameter(const Host& host, ParamSetHandle parameters, const ParamSpec& spec) {
  PropertySetHandle set = nullptr;
  if (host.parameters->define(parameters, host_type_of(spec), spec.name.c_str(), &set) != status::kOk) return;
  const Properties properties = host.of(set);
  properties.set(name::kLabel, spec.label);
  properties.set(name::kScriptName, spec.name);
  if (!spec.hint.empty()) properties.set(name::kHint, spec.hint);
  if (!spec.group.empty()) properties.set(name::kParent, spec.group);
  set_values(host, properties, spec);
}

}  // namespace

Status describe(const Host& host, EffectHandle effect, const OverlayEntries& overlays) {
  const Properties properties = host.of(effect);
  if (!properties) return status::kErrBadHandle;
  for (const char* const label : {name::kLabel, name::kShortLabel, name::kLongLabel})
    properties.set(label, "Contrejour");
  properties.set(name::kGrouping, "Light");
  properties.set(name::kPluginDescription, kDescription);
  set_all(properties, name::kSupportedContexts, {context::kFilter, context::kGeneral, context::kGenerator});
  // Hosts convert integer pixels themselves. Offered bytes, some would take these first, and a flare would show bands;
  // MLT prefers halves to floats and cuts its 16-bit integers down to them.
  set_all(properties, name::kSupportedPixelDepths, {value::kFloat});
  if (!host.is_mlt()) properties.set(name::kSupportedPixelDepths, value::kHalf, 1);
  properties.set(name::kRenderThreadSafety, value::kFullySafe);
  properties.set(name::kHostFrameThreading, 0);  // the library's own threads share a frame
  properties.set(name::kSupportsTiles, 0);  // any light's flare may reach any pixel
  properties.set(name::kSupportsMultiResolution, 1);
  properties.set(name::kSupportsMultipleClipDepths, 0);
  properties.set(name::kSupportsMultipleClipPars, 0);
  properties.set(name::kTemporalClipAccess, 0);
  properties.set(name::kSingleInstance, 0);
  properties.set(name::kFieldRenderTwice, 0);
  properties.set(name::kNoSpatialAwareness, "false");
  if (host.interacts != nullptr) {
    properties.set(name::kOverlayV1, reinterpret_cast<void*>(overlays.opengl));
    if (host.drawing != nullptr) properties.set(name::kOverlayV2, reinterpret_cast<void*>(overlays.draw_suite));
  }
  return status::kOk;
}

Status describe_in_context(const LoadedPlugin& loaded, EffectHandle effect, const Properties& in) {
  const Host& host = loaded.host;
  // Some hosts pass arguments without a context: what they make is a filter.
  const EffectContext context = context_of(in.text(name::kContext).value_or(context::kFilter));
  if (context != EffectContext::Generator) define_clip(host, effect, clip::kSource, context == EffectContext::General);
  define_clip(host, effect, clip::kOutput, false);
  ParamSetHandle parameters = nullptr;
  if (host.effects->get_param_set(effect, &parameters) != status::kOk) return status::kErrBadHandle;
  for (const ParamSpec& spec : loaded.parameters_in(context)) define_parameter(host, parameters, spec);
  return status::kOk;
}

}  // namespace contrejour::openfx
