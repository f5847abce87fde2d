// SPDX-License-Identifier: Apache-2.0
// Frames of `adaptive` with a picture as the iris, which a device looks up pixel by pixel, against the CPU's at a sixth
// of the error.
#include <cmath>

#include "device_frames.h"

using namespace contrejour;
using test::frame_by, test::kTwoLights, test::lens_of, test::settings_of, test::OnDevice;

namespace {

constexpr double kPictureError = 0.003;

// A star with a hole; half_tones: with waves of light and dark.
LensState star_lens(bool half_tones, double f_number) {
  constexpr int kSide = 128;
  std::vector<float> level;
  for (int k = 0; k < kSide * kSide; ++k) {
    const double x = 2.0 * (k % kSide + 0.5) / kSide - 1.0, y = 2.0 * (k / kSide + 0.5) / kSide - 1.0;
    const bool open =
        std::hypot(x, y) < 0.6 + 0.3 * std::cos(5.0 * std::atan2(y, x)) && std::hypot(x - 0.1, y - 0.1) > 0.15;
    const double tone = half_tones ? 0.65 + 0.35 * std::sin(9.0 * x) * std::cos(7.0 * y) : 1.0;
    level.push_back(open ? static_cast<float>(tone) : 0.0F);
  }
  const auto field = IrisField::from_levels(level, kSide, kSide);
  REQUIRE(field.has_value());
  REQUIRE((*field)->has_half_tones() == half_tones);
  LensState lens = lens_of("heliar", 0, f_number);
  lens.iris.field = *field;
  lens.iris.rotation_rad = 0.3;
  return lens;
}

void check_picture(const Dirt& dirt = {}) {
  OnDevice device;
  if (!device.kept.device) return;
  LensState lens = star_lens(false, 8.0);
  lens.dirt = dirt;
  FrameSettings settings = settings_of(lens, 96, 54);
  settings.wavelengths = 3;
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

TEST_CASE("a picture with half-tones as the iris is left to the CPU") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lens = star_lens(true, 8.0);
  const FrameSettings settings = settings_of(lens, 64, 36);
  const auto light = std::span(kTwoLights).first(1);
  const Flare flare = frame_by(AdaptiveOptions{0.01}, lens, light, settings, device.cache);
  CHECK(flare.statistics.device.find("a picture with half-tones as the iris is drawn by the CPU") != std::string::npos);
}

TEST_CASE("adaptive draws a picture as the iris with dirt in the stop on the device") {
  Dirt dirt;
  dirt.dust_per_cm2 = 20.0;
  dirt.dust_mm = 0.5;
  dirt.plane = DirtPlane::Stop;
  check_picture(dirt);
}
