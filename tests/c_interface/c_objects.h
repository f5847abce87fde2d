// SPDX-License-Identifier: Apache-2.0
// The objects of a C program that renders a small picture, and the same picture by the C++ interface.
#pragma once

#include <algorithm>
#include <cstring>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <contrejour.h>
#include <doctest/doctest.h>

#include "contrejour/contrejour.h"
#include "contrejour/expert/parameter.h"
#include "contrejour/expert/requests.h"
#include "contrejour/expert/settings.h"

namespace contrejour::c_test {

inline constexpr int kWidth = 48, kHeight = 32;

using Texts = std::initializer_list<std::pair<const char*, const char*>>;

// A small, quick picture.
inline const Texts kQuick = {{"fnumber", "8"}, {"size", "48x32"}, {"wavelengths", "3"}, {"error", "0.02"}};

inline params::Values quick_values(const char* light = nullptr) {
  params::Values values;
  for (const auto& [name, text] : kQuick) REQUIRE(values.set(name, text).has_value());
  if (light != nullptr) REQUIRE(values.set("light", light).has_value());
  return values;
}

// The objects of a test, destroyed at its end.
struct CObjects {
  CObjects() {
    REQUIRE(cj_settings_create(&settings, &error) == CJ_OK);
    for (const auto& [name, text] : kQuick) REQUIRE(cj_settings_set(settings, name, text, &error) == CJ_OK);
    REQUIRE(cj_settings_set(settings, "light", "9,5:1000", &error) == CJ_OK);
    REQUIRE(cj_lens_find("cooke-triplet", &lens, &error) == CJ_OK);
    REQUIRE(cj_lens_configure(lens, settings, &state, &error) == CJ_OK);
    REQUIRE(cj_renderer_create(&renderer, &error) == CJ_OK);
    REQUIRE(cj_renderer_set_lens(renderer, state, &error) == CJ_OK);
  }
  CObjects(const CObjects&) = delete;
  CObjects& operator=(const CObjects&) = delete;
  ~CObjects() {
    cj_renderer_destroy(renderer);
    cj_lens_state_destroy(state);
    cj_lens_destroy(lens);
    cj_settings_destroy(settings);
  }

  cj_error error = CJ_INIT(cj_error);
  cj_settings* settings = nullptr;
  cj_lens* lens = nullptr;
  cj_lens_state* state = nullptr;
  cj_renderer* renderer = nullptr;
};

inline cj_image image_over(std::vector<float>& pixels) {
  cj_image image = CJ_INIT(cj_image);
  image.pixels = pixels.data();
  image.width = kWidth;
  image.height = kHeight;
  return image;
}

inline Image picture_in_cpp(const std::vector<float>& pixels) {
  Image image(kWidth, kHeight);
  std::copy(pixels.begin(), pixels.end(), image.pixels.begin());
  return image;
}

inline std::vector<float> black() { return std::vector<float>(std::size_t{3} * kWidth * kHeight, 0.0F); }

inline std::vector<float> rendered(const CObjects& objects, cj_error* error) {
  std::vector<float> pixels = black();
  const cj_image image = image_over(pixels);
  REQUIRE(cj_renderer_render(objects.renderer, objects.settings, nullptr, 0, &image, nullptr, nullptr, error) == CJ_OK);
  return pixels;
}

// The same picture by the C++ interface.
inline Image rendered_in_cpp(const char* light) {
  const params::Values values = quick_values(light);
  const auto lens = params::lens_of(*find_lens("cooke-triplet"), values);
  auto renderer = Renderer::create(params::method_options(values));
  REQUIRE(renderer->set_lens(*lens).has_value());
  return render_picture(*picture_request(values, *lens), *renderer)->image;
}

inline bool same_bits(const std::vector<float>& a, const Image& b) {
  return a.size() == b.pixels.size() && std::memcmp(a.data(), b.pixels.data(), a.size() * sizeof(float)) == 0;
}

}  // namespace contrejour::c_test
