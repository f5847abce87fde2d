// SPDX-License-Identifier: Apache-2.0
// Frames of `adaptive` with a picture as the iris, which a device looks up pixel by pixel, against the CPU's at a sixth
// of the error.
#include <cmath>

#include "device_frames.h"
#include "stop_scenes.h"

using namespace contrejour;
using test::frame_by, test::kTwoLights, test::settings_of, test::star_lens, test::OnDevice;

namespace {

constexpr double kPictureError = 0.003;

void check_picture(const Dirt& dirt = {}, const RingingOptions& ringing = {}) {
  OnDevice device;
  if (!device.kept.device) return;
  LensState lens = star_lens(false, 8.0);
  lens.dirt = dirt;
  FrameSettings settings = settings_of(lens, 96, 54);
  settings.wavelengths = 3;
  settings.ringing = ringing;
  settings.selection = SelectBrightest{10};
  const auto light = std::span(kTwoLights).first(1);
  const Flare exact = frame_by(AdaptiveOptions{kPictureError / 6.0}, lens, light, settings, device.cpu_cache);
  const Flare got = frame_by(AdaptiveOptions{kPictureError}, lens, light, settings, device.cache);
  test::check_agreement(device, lens, exact, got, {-20.0 * std::log10(kPictureError), 0.01});
  CHECK(frame_by(AdaptiveOptions{kPictureError}, lens, light, settings, device.cache).image.pixels == got.image.pixels);
  test::check_no_messages();
}

}  // namespace

TEST_CASE("adaptive draws a picture as the iris on the device") { check_picture(); }

// The CPU's `adaptive` is off by a per cent of flux with half-tones, so that `bundle` is what the device is compared
// with.
TEST_CASE("adaptive draws a picture with half-tones as the iris on the device [slow]") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lens = star_lens(true, 8.0);
  FrameSettings settings = settings_of(lens, 96, 54);
  settings.wavelengths = 3;
  settings.selection = SelectBrightest{10};
  const auto light = std::span(kTwoLights).first(1);
  const Flare exact = frame_by(BundleOptions{}, lens, light, settings, device.cpu_cache);
  const Flare got = frame_by(AdaptiveOptions{kPictureError}, lens, light, settings, device.cache);
  test::check_agreement(device, lens, exact, got, {-20.0 * std::log10(kPictureError) - 3.0, 0.003});
  test::check_no_messages();
}

TEST_CASE("adaptive draws a picture as the iris with one pattern of fringes on the device [slow]") {
  check_picture({}, {.mode = RingingMode::Hullin});
}

TEST_CASE("a picture as the iris with Fresnel's fringes is left to the CPU") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lens = star_lens(true, 8.0);
  FrameSettings settings = settings_of(lens, 64, 36);
  settings.ringing.mode = RingingMode::Fresnel;
  const auto light = std::span(kTwoLights).first(1);
  const Flare flare = frame_by(AdaptiveOptions{0.01}, lens, light, settings, device.cache);
  CHECK(flare.statistics.device.find("Fresnel's fringes is drawn by the CPU") != std::string::npos);
}

TEST_CASE("adaptive draws a picture as the iris with dirt in the stop on the device [slow]") {
  Dirt dirt;
  dirt.dust_per_cm2 = 20.0;
  dirt.dust_mm = 0.5;
  dirt.plane = DirtPlane::Stop;
  check_picture(dirt);
}
