// SPDX-License-Identifier: Apache-2.0
// Instances with pictures, and what the library gives for the same settings.
#pragma once

#include <doctest/doctest.h>

#include <cstring>
#include <memory>
#include <string>
#include <utility>

#include "contrejour/expert/settings.h"
#include "contrejour/render.h"
#include "test_host.h"

namespace contrejour::openfx {

inline constexpr int kWidth = 64, kHeight = 48;
inline constexpr RectI kBounds{0, 0, kWidth, kHeight};
// Binary fractions: the position that the library is given is the same number.
inline constexpr double kLightX = 0.75, kLightY = 0.625;
inline constexpr const char* kLightAt = "0.75,0.375:20000";

// Few wavelengths take less than half the time.
inline constexpr const char* kWavelengths = "3";

// An instance, destroyed before its pictures, with all its images given back.
class Scene {
 public:
  Scene(const TestHost& host, const char* context, RectI bounds = kBounds, double width = kWidth,
        double height = kHeight)
      : output(HostPicture::of(bounds)), source(HostPicture::of(bounds)), host_(host),
        effect_(host.create(context, width, height)) {
    effect_->clip(clip::kOutput)->picture = &output;
    if (std::strcmp(context, context::kGenerator) != 0) effect_->clip(clip::kSource)->picture = &source;
    effect_->set("light1Position", {kLightX, kLightY});
    effect_->set_text("wavelengths", kWavelengths);
  }
  ~Scene() {
    CHECK(effect_->images_out == 0);
    host_.destroy(*effect_);
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  [[nodiscard]] EffectStruct& effect() const { return *effect_; }
  [[nodiscard]] Status render(RenderArguments arguments) const { return host_.render(*effect_, arguments); }
  [[nodiscard]] Status render() const { return render({.window = output.bounds}); }

  HostPicture output, source;

 private:
  const TestHost& host_;
  std::unique_ptr<EffectStruct> effect_;
};

// With a scene's wavelengths.
inline params::Values values_of(std::initializer_list<std::pair<const char*, const char*>> given) {
  params::Values values;
  REQUIRE(values.set("wavelengths", kWavelengths).has_value());
  for (const auto& [name, text] : given) REQUIRE(values.set(name, text).has_value());
  return values;
}

// The flare of a whole frame, rows from the top.
inline Image library_flare(const params::Values& values, const std::string& lens, int width = kWidth,
                           int height = kHeight) {
  auto prescription = find_lens(lens);
  REQUIRE(prescription.has_value());
  const auto state = params::lens_of(std::move(*prescription), values);
  REQUIRE(state.has_value());
  const Frame frame = params::whole_frame(values, *state, {width, height});
  const auto lights = params::lights(values, *state, frame, ColourSpace::Rec709);
  REQUIRE(lights.has_value());
  auto flare = contrejour::render(params::method_options(values), *state, *lights,
                                  params::frame_settings(values, frame, ColourSpace::Rec709));
  REQUIRE(flare.has_value());
  return std::move(flare->image);
}

// The number of samples of the first three channels that differ from an image's of the same frame, bit for bit.
inline int differing_samples(HostPicture& picture, const Image& image) {
  int count = 0;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x)
      for (int c = 0; c < 3; ++c) {
        const float ours = picture.at(picture.bounds.x1 + x, picture.bounds.y1 + y, c);
        const float theirs = image.at(x, image.height - 1 - y, c);
        if (std::memcmp(&ours, &theirs, sizeof ours) != 0) ++count;
      }
  return count;
}

inline double sum_of(HostPicture& picture) {
  double sum = 0.0;
  for (int y = picture.bounds.y1; y < picture.bounds.y2; ++y)
    for (int x = picture.bounds.x1; x < picture.bounds.x2; ++x)
      for (int c = 0; c < 3; ++c) sum += static_cast<double>(picture.at(x, y, c));
  return sum;
}

// A dim gradient with one bright area, alpha 0.5.
inline void paint_street(HostPicture& picture) {
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      const bool is_lamp = x >= 44 && x < 47 && y >= 30 && y < 33;
      for (int c = 0; c < 3; ++c)
        picture.set(picture.bounds.x1 + x, picture.bounds.y1 + y, c,
                    is_lamp ? 4000.0F : 0.1F + 0.001F * static_cast<float>(x + y * c));
      if (picture.channels > 3) picture.set(picture.bounds.x1 + x, picture.bounds.y1 + y, 3, 0.5F);
    }
}

}  // namespace contrejour::openfx
