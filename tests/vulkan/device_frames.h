// SPDX-License-Identifier: Apache-2.0
// Frames that the tests draw on a device and on the CPU.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "contrejour/lens.h"
#include "device.h"
#include "render/session/render_frame.h"

namespace contrejour::test {

inline LensState lens_of(const std::string& name, int blades = 0, double f_number = 0.0) {
  const auto prescription = find_lens(name);
  REQUIRE(prescription.has_value());
  LensSettings settings;
  settings.iris.blades = blades;
  if (f_number > 0.0) settings.f_number = f_number;
  const auto lens = configure_lens(*prescription, settings);
  REQUIRE(lens.has_value());
  return *lens;
}

inline FrameSettings settings_of(const LensState& lens, int width = 80, int height = 45) {
  FrameSettings settings;
  settings.frame = frame_on_sensor(lens, width, height);
  settings.wavelengths = 2;
  return settings;
}

struct Agreement {
  double psnr_db = 0, flux_error = 0;  // of the channel that differs most
};

// The sums of an image's channels.
inline std::array<double, 3> fluxes_of(const Image& image) {
  std::array<double, 3> sum{};
  for (std::size_t k = 0; k < image.pixels.size(); ++k) sum[k % 3] += image.pixels[k];
  return sum;
}

inline Agreement agreement_of(const Image& a, const Image& b) {
  double squares = 0, peak = 0;
  const std::array<double, 3> sum_a = fluxes_of(a), sum_b = fluxes_of(b);
  for (std::size_t k = 0; k < a.pixels.size(); ++k) {
    squares += std::pow(static_cast<double>(a.pixels[k]) - b.pixels[k], 2);
    peak = std::max<double>(peak, a.pixels[k]);
  }
  const double rms = std::sqrt(squares / static_cast<double>(a.pixels.size()));
  Agreement agreement{rms > 0.0 ? 20.0 * std::log10(peak / rms) : 200.0, 0.0};
  for (std::size_t c = 0; c < 3; ++c)
    agreement.flux_error = std::max(agreement.flux_error, std::abs(sum_b[c] / sum_a[c] - 1.0));
  return agreement;
}

inline Flare frame_by(const MethodOptions& method, const LensState& lens, std::span<const Light> lights,
                      const FrameSettings& settings, RenderCache& cache) {
  auto flare = render_frame(method, {lens, lights, settings, cache}, {});
  REQUIRE_MESSAGE(flare.has_value(), (flare ? std::string() : flare.error().message));
  return std::move(*flare);
}

// A cache with a device, which is null where there is none, and one without: what a frame leaves in the one (pupils,
// for example) it has to leave in the other, too, if the two are to count the same rays.
struct OnDevice {
  RenderCache cache, cpu_cache;
  KeptDevice& kept = *cache.section<KeptDevice>({});
  explicit OnDevice(DeviceOptions options = {}) {
    kept.device = open_device(std::move(options));
    kept.is_required = true;
  }
};

// Checks that the device drew a frame, and how far it is from one of the CPU.
inline void check_agreement(const OnDevice& device, const LensState& lens, const Flare& exact, const Flare& got,
                            const Agreement& least) {
  CHECK(got.statistics.device == device.kept.device->info().name);
  const Agreement c = agreement_of(exact.image, got.image);
  INFO(lens.name, ": ", c.psnr_db, " dB, flux off by ", c.flux_error);
  CHECK(c.psnr_db > least.psnr_db);
  CHECK(c.flux_error < least.flux_error);
}

inline const std::vector<Light> kTwoLights{{.direction = direction_from_angles(0.11, 0.06)},
                                           {.direction = direction_from_angles(-0.05, 0.13), .value = {4.0, 2.0, 1.0}}};

}  // namespace contrejour::test
