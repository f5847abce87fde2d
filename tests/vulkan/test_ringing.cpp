// SPDX-License-Identifier: Apache-2.0
// Frames of `adaptive` with diffraction fringes, which a device draws by tables of its own, against the CPU's at a
// tenth of the error.
#include "device_frames.h"

using namespace contrejour;
using test::agreement_of, test::frame_by, test::kTwoLights, test::lens_of, test::settings_of, test::OnDevice;

namespace {

constexpr double kError = 0.003;

FrameSettings fringed_settings(const LensState& lens, int width, int height, RingingMode mode) {
  FrameSettings settings = settings_of(lens, width, height);
  settings.wavelengths = 3;
  settings.ringing.mode = mode;
  return settings;
}

// Checks the device's picture, and that its fringes are visible: that a sharp iris does not come as near.
void check_fringes(OnDevice& device, const LensState& lens, std::span<const Light> lights,
                   const FrameSettings& settings) {
  const Flare exact = frame_by(AdaptiveOptions{0.1 * kError}, lens, lights, settings, device.cpu_cache);
  const Flare got = frame_by(AdaptiveOptions{kError}, lens, lights, settings, device.cache);
  test::check_agreement(device, lens, exact, got, {-20.0 * std::log10(kError), 0.01});
  FrameSettings sharp = settings;
  sharp.ringing.mode = RingingMode::None;
  const Flare without = frame_by(AdaptiveOptions{0.1 * kError}, lens, lights, sharp, device.cpu_cache);
  CHECK(agreement_of(exact.image, without.image).psnr_db < agreement_of(exact.image, got.image).psnr_db - 6.0);
  CHECK(frame_by(AdaptiveOptions{kError}, lens, lights, settings, device.cache).image.pixels == got.image.pixels);
}

}  // namespace

TEST_CASE("adaptive draws fringes of edges and of the whole iris on the device") {
  OnDevice device;
  if (!device.kept.device) return;
  for (const double f_number : {16.0, 22.0}) {
    const LensState lens = lens_of("heliar", 7, f_number);
    check_fringes(device, lens, std::span(kTwoLights).first(1), fringed_settings(lens, 160, 90, RingingMode::Fresnel));
  }
  test::check_no_messages();
}

TEST_CASE("adaptive draws fringes of a round iris, and of two lights, on the device") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lens = lens_of("heliar", 0, 32.0);
  check_fringes(device, lens, kTwoLights, fringed_settings(lens, 128, 72, RingingMode::Fresnel));
  test::check_no_messages();
}

TEST_CASE("adaptive draws the pattern of a fractional Fourier transform on the device [slow]") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lens = lens_of("heliar", 6, 11.0);
  check_fringes(device, lens, std::span(kTwoLights).first(1), fringed_settings(lens, 128, 72, RingingMode::Hullin));
  test::check_no_messages();
}

TEST_CASE("patterns of other frames leave no trace on the device") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lens = lens_of("heliar", 7, 8.0);
  const auto light = std::span(kTwoLights).first(1);
  const FrameSettings fringed = fringed_settings(lens, 96, 54, RingingMode::Fresnel);
  const FrameSettings sharp = fringed_settings(lens, 96, 54, RingingMode::None);
  const Flare first = frame_by(AdaptiveOptions{}, lens, light, sharp, device.cache);
  const Flare with = frame_by(AdaptiveOptions{}, lens, light, fringed, device.cache);
  CHECK(frame_by(AdaptiveOptions{}, lens, light, sharp, device.cache).image.pixels == first.image.pixels);
  CHECK(frame_by(AdaptiveOptions{}, lens, light, fringed, device.cache).image.pixels == with.image.pixels);
  test::check_no_messages();
}
