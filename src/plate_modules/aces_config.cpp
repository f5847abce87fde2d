// SPDX-License-Identifier: Apache-2.0
#include "plate_modules/aces_config.h"

#include <initializer_list>
#include <map>
#include <string>
#include <string_view>

namespace contrejour::inline internal {
namespace {

namespace aces = OCIO_NAMESPACE;

// Short names of what cameras record.
const std::map<std::string_view, const char*>& short_names() {
  static const std::map<std::string_view, const char*> names = {
      {"ARRI_ALEXA-LOGC-EI800-AWG", "logc3"},   {"CANON_CLOG2-CGAMUT", "clog2"}, {"CANON_CLOG3-CGAMUT", "clog3"},
      {"PANASONIC_VLOG-VGAMUT", "vlog"},        {"RED_LOG3G10-RWG", "log3g10"},  {"SONY_SLOG3-SGAMUT3", "slog3"},
      {"SONY_SLOG3-SGAMUT3.CINE", "slog3-cine"}};
  return names;
}

aces::BuiltinTransformRcPtr builtin(const std::string& style, aces::TransformDirection direction) {
  auto transform = aces::BuiltinTransform::Create();
  transform->setStyle(style.c_str());
  transform->setDirection(direction);
  return transform;
}

aces::ColorSpaceRcPtr space_named(const std::string& name, const std::string& family) {
  auto space = aces::ColorSpace::Create(aces::REFERENCE_SPACE_SCENE);
  space->setName(name.c_str());
  space->setFamily(family.c_str());
  space->setBitDepth(aces::BIT_DEPTH_F32);
  return space;
}

// Every "X_to_ACES2065-1" that is a coding of scenes is a space X.
void add_builtin_spaces(aces::Config& config) {
  const auto registry = aces::BuiltinTransformRegistry::Get();
  constexpr std::string_view kEnd = "_to_ACES2065-1";
  for (std::size_t k = 0; k < registry->getNumBuiltins(); ++k) {
    const std::string style = registry->getBuiltinStyle(k);
    if (!std::string_view(style).ends_with(kEnd)) continue;
    const std::string name = style.substr(0, style.size() - kEnd.size());
    auto space = space_named(name, "scene");
    if (const auto found = short_names().find(name); found != short_names().end()) space->addAlias(found->second);
    space->setTransform(builtin(style, aces::TRANSFORM_DIR_FORWARD), aces::COLORSPACE_DIR_TO_REFERENCE);
    config.addColorSpace(space);
  }
}

// Rec.709 primaries from ACES, and then the inverse of this curve.
void add_rec709_space(aces::Config& config, const std::string& name, const aces::TransformRcPtr& curve) {
  auto steps = aces::GroupTransform::Create();
  steps->appendTransform(builtin("ACEScg_to_ACES2065-1", aces::TRANSFORM_DIR_INVERSE));
  steps->appendTransform(builtin("UTILITY - ACES-AP1_to_LINEAR-REC709_BFD", aces::TRANSFORM_DIR_FORWARD));
  if (curve) steps->appendTransform(curve);
  auto space = space_named(name, curve ? "display" : "scene");
  space->setTransform(steps, aces::COLORSPACE_DIR_FROM_REFERENCE);
  config.addColorSpace(space);
}

aces::TransformRcPtr srgb_curve() {
  auto curve = aces::ExponentWithLinearTransform::Create();  // IEC 61966-2-1
  const double gamma[4] = {2.4, 2.4, 2.4, 1.0}, offset[4] = {0.055, 0.055, 0.055, 0.0};
  curve->setGamma(gamma);
  curve->setOffset(offset);
  curve->setNegativeStyle(aces::NEGATIVE_MIRROR);
  curve->setDirection(aces::TRANSFORM_DIR_INVERSE);
  return curve;
}

aces::TransformRcPtr rec1886_curve() {
  auto curve = aces::ExponentTransform::Create();  // ITU-R BT.1886 with black at zero
  const double gamma[4] = {2.4, 2.4, 2.4, 1.0};
  curve->setValue(gamma);
  curve->setNegativeStyle(aces::NEGATIVE_MIRROR);
  curve->setDirection(aces::TRANSFORM_DIR_INVERSE);
  return curve;
}

// How a scene becomes light of a display.
void add_view_transform(aces::Config& config, const char* name, const char* style) {
  auto transform = aces::ViewTransform::Create(aces::REFERENCE_SPACE_SCENE);
  transform->setName(name);
  transform->setTransform(builtin(style, aces::TRANSFORM_DIR_FORWARD), aces::VIEWTRANSFORM_DIR_FROM_REFERENCE);
  config.addViewTransform(transform);
}

// Light of a display as its codes, and the views on it.
void add_display(aces::Config& config, const std::string& name, const char* style,
                 std::initializer_list<const char*> views) {
  auto space = aces::ColorSpace::Create(aces::REFERENCE_SPACE_DISPLAY);
  const std::string space_name = name + " - Display";
  space->setName(space_name.c_str());
  space->setFamily("display");
  space->setBitDepth(aces::BIT_DEPTH_F32);
  space->setTransform(builtin(style, aces::TRANSFORM_DIR_FORWARD), aces::COLORSPACE_DIR_FROM_REFERENCE);
  config.addColorSpace(space);
  for (const char* view : views) config.addDisplayView(name.c_str(), view, view, space_name.c_str(), "", "", "");
}

// The output transforms of ACES 1 for displays of standard range, and none at all.
void add_displays(aces::Config& config) {
  constexpr const char *kVideo = "ACES SDR video", *kCinema = "ACES SDR cinema", *kPlain = "Un-tone-mapped";
  add_view_transform(config, kVideo, "ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0");
  add_view_transform(config, kCinema, "ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-CINEMA_1.0");
  add_view_transform(config, kPlain, "UTILITY - ACES-AP0_to_CIE-XYZ-D65_BFD");
  add_display(config, "sRGB", "DISPLAY - CIE-XYZ-D65_to_sRGB", {kVideo, kPlain});
  add_display(config, "Rec.709 video", "DISPLAY - CIE-XYZ-D65_to_REC.1886-REC.709", {kVideo, kPlain});
  add_display(config, "P3 D65", "DISPLAY - CIE-XYZ-D65_to_G2.6-P3-D65", {kCinema, kPlain});
}

}  // namespace

aces::ConstConfigRcPtr aces_config() {
  auto config = aces::Config::Create();
  config->setMajorVersion(2);
  config->addColorSpace(space_named("ACES2065-1", "scene"));
  add_builtin_spaces(*config);
  add_rec709_space(*config, "Linear Rec.709", nullptr);
  add_rec709_space(*config, "sRGB", srgb_curve());
  add_rec709_space(*config, "Rec.1886", rec1886_curve());
  add_displays(*config);
  config->setRole("aces_interchange", "ACES2065-1");
  config->setRole("scene_linear", "ACEScg");
  return config;
}

}  // namespace contrejour::inline internal
