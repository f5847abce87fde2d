// SPDX-License-Identifier: Apache-2.0
// Frames of grids of rays whose light more than a sharp iris dims at the stop, against the CPU's same method.
#include "device_frames.h"
#include "stop_scenes.h"

using namespace contrejour;
using test::dirt_bars, test::dirty_lens, test::dust_and_scratches, test::star_lens;
using test::frame_by, test::kTwoLights, test::lens_of, test::settings_of, test::OnDevice;

namespace {

constexpr double kLeastGrid_db = 60.0, kMostGridFlux = 1e-3;

MethodOptions fine_bundle(int rays = 96) { return BundleOptions{.grid = {.rays = rays}}; }
MethodOptions fine_tiled(int rays = 64) { return TiledOptions{.grid = {.rays = rays}}; }

FrameSettings stop_settings(const LensState& lens, RingingMode mode = RingingMode::None) {
  FrameSettings settings = settings_of(lens, 96, 54);
  settings.wavelengths = 1;  // with two, red may be a small difference of large values
  settings.ringing.mode = mode;
  settings.selection = SelectBrightest{5};
  return settings;
}

// Checks a frame, that the stop matters (that the plain lens's frame is not as near), and the bits.
void check_stop(OnDevice& device, const MethodOptions& method, const LensState& lens, const FrameSettings& settings,
                std::span<const Light> lights = std::span(kTwoLights).first(1)) {
  const Flare exact = frame_by(method, lens, lights, settings, device.cpu_cache);
  const Flare got = frame_by(method, lens, lights, settings, device.cache);
  test::check_agreement(device, lens, exact, got, {kLeastGrid_db, kMostGridFlux});
  LensState plain = lens;
  plain.dirt = {};
  plain.iris.field = nullptr;
  FrameSettings sharp = settings;
  sharp.ringing.mode = RingingMode::None;
  const Flare without = frame_by(method, plain, lights, sharp, device.cpu_cache);
  CHECK(test::agreement_of(exact.image, without.image).psnr_db < kLeastGrid_db - 6.0);
  CHECK(frame_by(method, lens, lights, settings, device.cache).image.pixels == got.image.pixels);
}

}  // namespace

TEST_CASE("bundle draws fringes of edges, of the whole iris and of a fractional order as the CPU does") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState blades = lens_of("heliar", 7, 16.0), round = lens_of("heliar", 0, 32.0);
  check_stop(device, fine_bundle(), blades, stop_settings(blades, RingingMode::Fresnel));
  check_stop(device, fine_bundle(), round, stop_settings(round, RingingMode::Fresnel), kTwoLights);
  check_stop(device, fine_bundle(48), blades, stop_settings(blades, RingingMode::Hullin));
  test::check_no_messages();
}

TEST_CASE("bundle draws a picture as the iris as the CPU does, with half-tones and fringes") {
  OnDevice device;
  if (!device.kept.device) return;
  for (const bool half_tones : {false, true}) {
    const LensState lens = star_lens(half_tones, 8.0);
    check_stop(device, fine_bundle(), lens, stop_settings(lens));
    check_stop(device, fine_bundle(), lens, stop_settings(lens, RingingMode::Fresnel));
  }
  test::check_no_messages();
}

TEST_CASE("bundle draws dirt in the stop and on the front as the CPU does") {
  OnDevice device;
  if (!device.kept.device) return;
  std::vector<Light> lights = kTwoLights;
  lights.back().distance_mm = 800.0;
  const LensState stop = dirty_lens(dust_and_scratches(DirtPlane::Stop), 8.0);
  const LensState front = dirty_lens(dust_and_scratches(DirtPlane::Front), 8.0);
  check_stop(device, fine_bundle(192), stop, stop_settings(stop));
  check_stop(device, fine_bundle(), front, stop_settings(front), lights);
  Dirt picture;
  picture.picture = dirt_bars();
  picture.plane = DirtPlane::Stop;
  const LensState barred = dirty_lens(picture, 16.0);
  check_stop(device, fine_bundle(), barred, stop_settings(barred, RingingMode::Fresnel));
  test::check_no_messages();
}

TEST_CASE("tiled draws fringes, a picture as the iris and dirt as the CPU does") {
  OnDevice device;
  if (!device.kept.device) return;
  std::vector<Light> lights = kTwoLights;
  lights.back().distance_mm = 800.0;
  const LensState blades = lens_of("heliar", 7, 16.0), round = lens_of("heliar", 0, 32.0);
  check_stop(device, fine_tiled(), blades, stop_settings(blades, RingingMode::Fresnel));
  check_stop(device, fine_tiled(), round, stop_settings(round, RingingMode::Fresnel), lights);
  for (const bool half_tones : {false, true}) {
    const LensState lens = star_lens(half_tones, 8.0);
    check_stop(device, fine_tiled(), lens, stop_settings(lens));
    check_stop(device, fine_tiled(), lens, stop_settings(lens, RingingMode::Fresnel));
  }
  for (const DirtPlane plane : {DirtPlane::Stop, DirtPlane::Front}) {
    const LensState lens = dirty_lens(dust_and_scratches(plane), 8.0);
    check_stop(device, fine_tiled(), lens, stop_settings(lens), lights);
  }
  test::check_no_messages();
}

TEST_CASE("frames of grids with fringes and dirt are the same in bands of rows and in small batches") {
  OnDevice whole, banded({.most_rows = 7}), small({.most_buffer_bytes = 1U << 20U});
  if (!whole.kept.device) return;
  const LensState fringed = lens_of("heliar", 7, 16.0), dirty = dirty_lens(dust_and_scratches(DirtPlane::Front), 8.0);
  for (const LensState& lens : {fringed, dirty}) {
    FrameSettings settings = stop_settings(lens, lens.dirt.any() ? RingingMode::None : RingingMode::Fresnel);
    settings.selection = SelectBrightest{2};
    for (const MethodOptions& method : {fine_bundle(48), fine_tiled(48)}) {
      const Flare got = frame_by(method, lens, kTwoLights, settings, whole.cache);
      for (OnDevice* const other : {&banded, &small})
        check_agreement(*other, lens, got, frame_by(method, lens, kTwoLights, settings, other->cache), {90.0, 1e-5});
    }
  }
  test::check_no_messages();
}

TEST_CASE("grids leave shapes of dirt with fringes to the CPU") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lens = dirty_lens(dust_and_scratches(DirtPlane::Stop), 16.0);
  for (const MethodOptions& method : {fine_bundle(32), fine_tiled(32)}) {
    const Flare flare =
        frame_by(method, lens, std::span(kTwoLights).first(1), stop_settings(lens, RingingMode::Fresnel), device.cache);
    CHECK(flare.statistics.device.find("dirt with ringing is drawn by the CPU") != std::string::npos);
  }
}
