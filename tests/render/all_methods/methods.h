// SPDX-License-Identifier: Apache-2.0
// Every registered renderer, with its bounds. The cases of this folder are the same for all.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/expert/metrics.h"
#include "contrejour/render.h"
#include "support/approx.h"
#include "support/flares.h"
#include "support/kept_picture.h"
#include "support/scenes.h"

namespace contrejour::test {

struct Bounds {
  std::string_view method;
  double psnr_db = 50;        // the lowest, against `reference`
  double flux = 0.005;        // the largest relative error of a flare's flux
  double addition = 1e-5;  // of the peak: two lights against the sum of each, a window against its part of the frame
  double jump = 0.02;  // of the peak, beyond the reference's own change, as the light moves 0.01 pixel
  double rms = 1.0;  // of the frame's peak, the largest: a method's own guarantee
  MethodTraits traits = {};
};

// A method that is not listed must meet the defaults.
inline Bounds bounds_of(std::string_view method) {
  const Bounds all[] = {
      {.method = "reference", .psnr_db = 200.0, .flux = 1e-6},
      {.method = "bundle", .psnr_db = 57.0},
      // One sample for each pixel: edges are steps, and ghosts of a few pixels have errors in flux.
      {.method = "tiled", .psnr_db = 28.0, .flux = 0.08, .jump = 1.0},
      // The distribution of its error depends on all the light in the frame: this is the largest difference of two
      // pictures that may each have an RMS error of 0.003.
      {.method = "adaptive", .psnr_db = 50.0, .addition = 1e-2, .rms = AdaptiveOptions{}.error},
      // The same, and the error of the fit.
      {.method = "polynomial", .psnr_db = 48.0, .addition = 1e-2, .rms = 1.2 * AdaptiveOptions{}.error},
  };
  Bounds found{.method = method};
  for (const Bounds& bounds : all)
    if (bounds.method == method) found = bounds;
  found.traits = method_traits(method).value_or(MethodTraits{});
  return found;
}

// Calls body(bounds) for every method.
template <class Body>
void for_each_method(Body body) {
  for (const std::string_view method : render_methods()) {
    const std::string name(method);
    CAPTURE(name);
    body(bounds_of(method));
  }
}

inline Image image_of(const Bounds& method, const LensState& lens, std::span<const Light> lights,
                      const Settings& settings) {
  return flare_of(method.method, lens, lights, settings).image;
}

inline Image image_of(const Bounds& method, const LensState& lens, const Light& light, const Settings& settings) {
  return image_of(method, lens, std::span(&light, 1), settings);
}

inline Image truth_of(const LensState& lens, const Light& light, const Settings& settings) {
  return image_of(bounds_of("reference"), lens, light, settings);
}

// The same picture, kept as golden/NAME.exr. Two of them are rendered in every run ("the reference renders what is kept
// of it"), so that a change of the reference does not go unseen.
inline Image kept_truth_of(const std::string& name, const LensState& lens, const Light& light,
                           const Settings& settings) {
  return kept_picture(name, [&] { return truth_of(lens, light, settings); });
}

// A frame on the lens's sensor at 550 nm, with a coarse, quick grid.
inline Settings small_frame(const LensState& lens, int width, int height) {
  Settings settings = green(frame_on_sensor(lens, width, height));
  settings.set_grid(128);
  return settings;
}

inline double peak_of(const Image& image) { return *std::max_element(image.pixels.begin(), image.pixels.end()); }

inline double largest_difference(const Image& a, const Image& b) {
  REQUIRE(a.pixels.size() == b.pixels.size());
  double worst = 0.0;
  for (std::size_t k = 0; k < a.pixels.size(); ++k) {
    worst = std::max(worst, std::abs(static_cast<double>(a.pixels[k]) - b.pixels[k]));
  }
  return worst;
}

inline double psnr_db(const Image& truth, const Image& image) {
  const auto difference = compare(truth, image);
  REQUIRE(difference.has_value());
  return difference->psnr_db.value_or(1000.0);
}

inline double rms_difference(const Image& a, const Image& b) {
  REQUIRE(a.pixels.size() == b.pixels.size());
  double squares = 0.0;
  for (std::size_t k = 0; k < a.pixels.size(); ++k) {
    squares += std::pow(static_cast<double>(a.pixels[k]) - b.pixels[k], 2.0);
  }
  return std::sqrt(squares / static_cast<double>(a.pixels.size()));
}

// Checks PSNR, error and flux against the truth, by the method's bounds.
inline void check_against(const Image& truth, const Image& image, const Bounds& bounds) {
  CHECK(rms_difference(truth, image) <= bounds.rms * peak_of(truth));
  CHECK(psnr_db(truth, image) >= bounds.psnr_db);
  CHECK(sum(image) / sum(truth) == test::approx(1.0).epsilon(bounds.flux));
}

}  // namespace contrejour::test
