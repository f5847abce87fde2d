// SPDX-License-Identifier: Apache-2.0
// Frames of `adaptive` of lenses with dirt, which a device looks up pixel by pixel, against the CPU's at a sixth of the
// error.
#include "device_frames.h"
#include "stop_scenes.h"

using namespace contrejour;
using test::agreement_of, test::frame_by, test::kTwoLights, test::lens_of, test::settings_of, test::OnDevice;
using test::dirt_bars, test::dirty_lens, test::dust_and_scratches;

namespace {

constexpr double kDirtError = 0.003;

// Checks the device's picture, that the dirt is visible (that a clean lens does not come as near), and that the bits
// are the same each time.
void check_dirt(OnDevice& device, const LensState& lens, std::span<const Light> lights, const FrameSettings& settings) {
  const Flare exact = frame_by(AdaptiveOptions{kDirtError / 6.0}, lens, lights, settings, device.cpu_cache);
  const Flare got = frame_by(AdaptiveOptions{kDirtError}, lens, lights, settings, device.cache);
  test::check_agreement(device, lens, exact, got, {-20.0 * std::log10(kDirtError), 0.01});
  LensState clean = lens;
  clean.dirt = {};
  const Flare without = frame_by(AdaptiveOptions{kDirtError / 6.0}, clean, lights, settings, device.cpu_cache);
  CHECK(agreement_of(exact.image, without.image).psnr_db < agreement_of(exact.image, got.image).psnr_db - 6.0);
  CHECK(frame_by(AdaptiveOptions{kDirtError}, lens, lights, settings, device.cache).image.pixels == got.image.pixels);
}

// Lavapipe takes long to draw shadows: few ghosts and pixels.
FrameSettings dirt_settings(const LensState& lens, int width = 128, int height = 72) {
  FrameSettings settings = settings_of(lens, width, height);
  settings.wavelengths = 3;
  settings.selection = SelectBrightest{10};
  return settings;
}

}  // namespace

TEST_CASE("adaptive draws shadows of dirt in the stop and on the front on the device [slow]") {
  OnDevice device;
  if (!device.kept.device) return;
  for (const DirtPlane plane : {DirtPlane::Stop, DirtPlane::Front}) {
    const LensState lens = dirty_lens(dust_and_scratches(plane), 8.0);
    check_dirt(device, lens, std::span(kTwoLights).first(1), dirt_settings(lens));
  }
  test::check_no_messages();
}

TEST_CASE("adaptive draws shadows of dirt on the front for two lights, one of them near, on the device [slow]") {
  OnDevice device;
  if (!device.kept.device) return;
  std::vector<Light> lights = kTwoLights;
  lights.back().distance_mm = 800.0;
  const LensState lens = dirty_lens(dust_and_scratches(DirtPlane::Front), 5.6);
  check_dirt(device, lens, lights, dirt_settings(lens));
  test::check_no_messages();
}

// With two wavelengths the red of Rec.709 is a small difference of both, since the gain of the shorter one is negative:
// its own relative error says little. In ACEScg no gain is negative, so that every channel shows the fluxes' errors.
TEST_CASE("the fluxes of two wavelengths and two lights are right on the device, with dirt and without [slow]") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState dirty = dirty_lens(dust_and_scratches(DirtPlane::Stop), 8.0);
  LensState clean = dirty;
  clean.dirt = {};
  FrameSettings settings = dirt_settings(clean, 96, 54);
  settings.wavelengths = 2;
  settings.selection = SelectBrightest{6};
  for (const ColourSpace space : {ColourSpace::AcesCg, ColourSpace::Rec709}) {
    settings.colour_space = space;
    for (const LensState& lens : {clean, dirty}) {
      const Flare exact = frame_by(AdaptiveOptions{kDirtError / 6.0}, lens, kTwoLights, settings, device.cpu_cache);
      const Flare got = frame_by(AdaptiveOptions{kDirtError}, lens, kTwoLights, settings, device.cache);
      CHECK(got.statistics.device == device.kept.device->info().name);
      const auto wanted = test::fluxes_of(exact.image), drawn = test::fluxes_of(got.image);
      const double most = *std::ranges::max_element(wanted);
      for (std::size_t c = 0; c < 3; ++c) {
        INFO("channel ", c, " has ", wanted[c], ", drawn ", drawn[c]);
        CHECK(std::abs(drawn[c] - wanted[c]) < 0.005 * (space == ColourSpace::AcesCg ? wanted[c] : most));
      }
    }
  }
  test::check_no_messages();
}

TEST_CASE("adaptive draws a picture of dirt on the device [slow]") {
  OnDevice device;
  if (!device.kept.device) return;
  Dirt dirt;
  dirt.plane = DirtPlane::Stop;
  dirt.picture = dirt_bars();
  const LensState lens = dirty_lens(dirt, 8.0);
  check_dirt(device, lens, std::span(kTwoLights).first(1), dirt_settings(lens));
  test::check_no_messages();
}

TEST_CASE("adaptive draws fringes of the iris with a picture of dirt on the device [slow]") {
  OnDevice device;
  if (!device.kept.device) return;
  Dirt dirt;
  dirt.picture = dirt_bars();
  dirt.plane = DirtPlane::Front;
  const LensState lens = dirty_lens(dirt, 16.0);
  FrameSettings settings = dirt_settings(lens);
  settings.ringing.mode = RingingMode::Fresnel;
  check_dirt(device, lens, std::span(kTwoLights).first(1), settings);
  test::check_no_messages();
}

TEST_CASE("dirt with fringes is left to the CPU") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lens = dirty_lens(dust_and_scratches(DirtPlane::Stop), 16.0);
  FrameSettings settings = dirt_settings(lens, 64, 36);
  settings.ringing.mode = RingingMode::Fresnel;
  const Flare flare =
      frame_by(AdaptiveOptions{kDirtError}, lens, std::span(kTwoLights).first(1), settings, device.cache);
  CHECK(flare.statistics.device.find("dirt with ringing is drawn by the CPU") != std::string::npos);
}

TEST_CASE("dirt of other frames leaves no trace on the device [slow]") {
  OnDevice device;
  if (!device.kept.device) return;
  const auto light = std::span(kTwoLights).first(1);
  const LensState dirty = dirty_lens(dust_and_scratches(DirtPlane::Stop), 8.0);
  LensState clean = dirty;
  clean.dirt = {};
  const FrameSettings settings = dirt_settings(clean, 64, 36);
  const Flare first = frame_by(AdaptiveOptions{}, clean, light, settings, device.cache);
  const Flare with = frame_by(AdaptiveOptions{}, dirty, light, settings, device.cache);
  CHECK(frame_by(AdaptiveOptions{}, clean, light, settings, device.cache).image.pixels == first.image.pixels);
  CHECK(frame_by(AdaptiveOptions{}, dirty, light, settings, device.cache).image.pixels == with.image.pixels);
  test::check_no_messages();
}
