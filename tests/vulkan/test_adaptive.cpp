// SPDX-License-Identifier: Apache-2.0
// Frames of `adaptive` that a device draws by its own data flow, against the CPU's at a thirtieth of the error.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "device_frames.h"

using namespace contrejour;
using test::frame_by, test::kTwoLights, test::lens_of, test::settings_of, test::OnDevice;

namespace {

constexpr double kFine = 1e-4;

void check_near(OnDevice& device, const LensState& lens, std::span<const Light> lights, const FrameSettings& settings,
                double error = 0.003, double flux_error = 0.03) {
  FrameSettings colour = settings;
  colour.wavelengths = 3;
  const Flare exact = frame_by(AdaptiveOptions{kFine}, lens, lights, colour, device.cpu_cache);
  const Flare got = frame_by(AdaptiveOptions{error}, lens, lights, colour, device.cache);
  test::check_agreement(device, lens, exact, got, {-20.0 * std::log10(error), flux_error});
}

LensState zoomed(const char* name, double focal_length_mm, double f_number) {
  const auto zoom = configure_lens(*find_lens(name), {.focal_length_mm = focal_length_mm, .f_number = f_number});
  REQUIRE(zoom.has_value());
  return *zoom;
}

// Some ghosts of a light.
struct SomeGhosts {
  LensState lens;
  FrameSettings settings;
  Light light;
};

SomeGhosts some_ghosts(LensState lens, int width, int height, std::vector<Ghost> ghosts, Vec3 direction) {
  FrameSettings settings = settings_of(lens, width, height);
  settings.selection = SelectList{std::move(ghosts)};
  return {std::move(lens), std::move(settings), {.direction = direction}};
}

// A ghost of which no ray passes at both ends of the spectrum. Drawn at three wavelengths, it passes only at the last.
SomeGhosts red_ghost() {
  return some_ghosts(zoomed("canon-70-200", 135.0, 8.0), 160, 90, {{10, 20}}, direction_from_angles(0.0533, 0.0225));
}

// A ghost whose pupil is long and thin, and grows towards red.
SomeGhosts sliver() {
  return some_ghosts(zoomed("nikon-80-200", 140.0, 8.0), 64, 36, {{9, 13}}, direction_from_angles(0.05137, 0.02166));
}

SomeGhosts of_fisheye(int width, int height, std::vector<Ghost> ghosts) {
  return some_ghosts(lens_of("muller-fisheye-10", 0, 8.0), width, height, std::move(ghosts),
                     direction_from_angles(0.43416, 0.17563));
}

void check_near(OnDevice& device, const SomeGhosts& some, double error, double flux_error) {
  check_near(device, some.lens, {&some.light, 1}, some.settings, error, flux_error);
}

// The same with as many wavelengths as each ghost needs.
void check_by_need(OnDevice& device, const SomeGhosts& some, const test::Agreement& least) {
  FrameSettings settings = some.settings;
  settings.wavelengths = kAutoWavelengths;
  const std::span lights(&some.light, 1);
  const Flare exact = frame_by(AdaptiveOptions{5e-4}, some.lens, lights, settings, device.cpu_cache);
  const Flare got = frame_by(AdaptiveOptions{}, some.lens, lights, settings, device.cache);
  test::check_agreement(device, some.lens, exact, got, least);
  test::check_no_messages();
}

bool has_searched(const Flare& flare) {
  return std::ranges::any_of(flare.statistics.time_ms,
                             [](const auto& stage) { return stage.first == "device: pupils"; });
}

}  // namespace

TEST_CASE("adaptive draws every bundled lens on the device within the error [slow]") {
  OnDevice device;
  if (!device.kept.device) return;
  int blades = 0;
  for (const BundledLens& bundled : bundled_lenses()) {
    blades = (blades + 5) % 9;
    const LensState lens = lens_of(std::string(bundled.name), blades < 3 ? 0 : blades, 8.0);
    FrameSettings settings = settings_of(lens, 64, 36);
    settings.selection = SelectBrightest{6};
    check_near(device, lens, std::span(kTwoLights).first(1), settings);
  }
  test::check_no_messages();
}

TEST_CASE("adaptive draws several lights on the device, whatever the error [slow]") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lens = lens_of("heliar", 7, 8.0);
  const FrameSettings settings = settings_of(lens, 96, 54);
  check_near(device, lens, kTwoLights, settings);
  check_near(device, lens, kTwoLights, settings, 0.0005);
}

TEST_CASE("adaptive draws near lights and a window of the frame on the device") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lens = lens_of("heliar", 7, 8.0);
  FrameSettings settings = settings_of(lens, 96, 54);
  settings.frame.origin_x = 27;
  settings.frame.origin_y = 11;
  settings.frame.width = 55;
  settings.frame.height = 40;
  std::vector<Light> near = kTwoLights;
  near.back().distance_mm = 800.0;
  check_near(device, lens, near, settings);
}

TEST_CASE("adaptive finds pupils on the device whatever the direction of the light about the axis") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lens = lens_of("tessar", 6, 11.0);
  FrameSettings settings = settings_of(lens, 64, 36);
  settings.frame.pixel_pitch_mm *= 2.0;
  constexpr double kField_rad = 0.16;
  for (const double degrees : {0.0, 37.0, 90.0, 135.0, 233.0, 270.0}) {
    CAPTURE(degrees);
    const double angle = degrees * std::numbers::pi / 180.0;
    const Light light{.direction = direction_from_angles(kField_rad * std::cos(angle), kField_rad * std::sin(angle))};
    check_near(device, lens, {&light, 1}, settings);
  }
}

TEST_CASE("edges of ghosts lie where the CPU draws them, whatever bends the map to the stop") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState zoom = zoomed("nikon-80-200", 140.0, 16.0);
  FrameSettings settings = settings_of(zoom, 320, 180);
  settings.selection = SelectList{{{1, 8}, {1, 10}, {1, 11}}};
  const Light light{.direction = direction_from_angles(0.052, 0.022)};
  check_near(device, zoom, {&light, 1}, settings);
}

TEST_CASE("a ghost that the lens lets through at its last wavelength only is drawn on the device") {
  OnDevice device;
  if (!device.kept.device) return;
  check_near(device, red_ghost(), 0.003, 0.03);
}

TEST_CASE("a ghost of which no ray passes at both ends of the spectrum has as many wavelengths as its smear needs") {
  OnDevice device;
  if (!device.kept.device) return;
  check_by_need(device, red_ghost(), {60.0, 0.03});  // it has 0.85 of its red with three
}

TEST_CASE("a frame whose only light is a spot smaller than a pixel is drawn on the device") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lens = lens_of("muller-fisheye-10", 0, 11.0);
  FrameSettings settings = settings_of(lens, 160, 90);
  settings.selection = SelectList{{{1, 3}}};
  const Light light{.direction = direction_from_angles(0.215, 0.081)};
  check_near(device, lens, {&light, 1}, settings);
}

TEST_CASE("small pupils of a lens without axial symmetry are found on the device [slow]") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lens = lens_of("schneider-anamorphic-31", 0, 11.0);
  FrameSettings settings = settings_of(lens, 80, 45);
  settings.selection = SelectList{{{1, 4}, {8, 12}, {11, 15}}};
  const Light light{.direction = direction_from_angles(-0.2, 0.1)};
  check_near(device, lens, {&light, 1}, settings);
}

TEST_CASE("fluxes are right to 0.15 per cent, though most ghosts are dim and have few cells [slow]") {
  OnDevice device;
  if (!device.kept.device) return;
  for (const char* name : {"tessar", "distagon-25"}) {
    const LensState lens = lens_of(name, 0, 4.5);
    FrameSettings settings = settings_of(lens, 160, 90);
    settings.wavelengths = 3;
    const Light light{.direction = direction_from_angles(0.07, -0.05)};
    const Flare exact = frame_by(AdaptiveOptions{2e-4}, lens, {&light, 1}, settings, device.cpu_cache);
    const Flare got = frame_by(AdaptiveOptions{}, lens, {&light, 1}, settings, device.cache);
    test::check_agreement(device, lens, exact, got, {-20.0 * std::log10(AdaptiveOptions{}.error), 0.0015});
  }
  test::check_no_messages();
}

TEST_CASE("a ghost larger than the frame is as bright as the CPU's, though its cells are coarse") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lens = lens_of("tessar", 0, 4.5);
  FrameSettings settings = settings_of(lens, 96, 54);
  const Light light{.direction = direction_from_angles(0.08, -0.04)};
  for (const SelectList& ghost : {SelectList{{{6, 8}}}, SelectList{{{2, 3}}}}) {
    settings.selection = ghost;
    check_near(device, lens, {&light, 1}, settings, 0.1, 0.007);
  }
}

TEST_CASE("a frame whose rays do not fit into a buffer is drawn in parts [slow]") {
  OnDevice device({.most_buffer_bytes = 1U << 20U});
  if (!device.kept.device) return;
  const LensState lens = lens_of("heliar", 7, 8.0);
  FrameSettings settings = settings_of(lens, 64, 36);
  settings.wavelengths = 3;
  std::vector<Light> lights;
  for (int k = 0; k < 9; ++k)
    lights.push_back({.direction = direction_from_angles(0.03 * (k % 3) - 0.02, 0.03 * (k / 3) - 0.035)});
  constexpr std::uint64_t kRayBytes = 24;
  const Flare got = frame_by(AdaptiveOptions{}, lens, lights, settings, device.cache);
  CHECK(kRayBytes * got.statistics.rays > device.kept.device->info().storage_range_bytes);
  const Flare exact = frame_by(AdaptiveOptions{5e-4}, lens, lights, settings, device.cpu_cache);
  test::check_agreement(device, lens, exact, got, {-20.0 * std::log10(AdaptiveOptions{}.error), 0.01});
  CHECK(frame_by(AdaptiveOptions{}, lens, lights, settings, device.cache).image.pixels == got.image.pixels);
  test::check_no_messages();
}

TEST_CASE("a frame whose polygons do not fit into a buffer is drawn in bands, and long lists of tiles in parts") {
  constexpr double kError = 0.0022;
  OnDevice whole, banded({.most_buffer_bytes = 1U << 21U});
  if (!whole.kept.device) return;
  const LensState lens = lens_of("heliar");
  FrameSettings settings = settings_of(lens, 64, 36);
  settings.wavelengths = 3;
  const Light near_axis{.direction = direction_from_angles(0.012, 0.006)};
  const Flare exact = frame_by(AdaptiveOptions{kFine}, lens, {&near_axis, 1}, settings, whole.cpu_cache);
  const Flare got = frame_by(AdaptiveOptions{kError}, lens, {&near_axis, 1}, settings, whole.cache);
  constexpr std::uint64_t kTiles = 12, kListPart = 1024, kRecordBytes = 64;
  CHECK(got.statistics.primitives > kTiles * kListPart);  // a list at least has several parts
  test::check_agreement(whole, lens, exact, got, {-20.0 * std::log10(kError), 0.02});
  const Flare in_bands = frame_by(AdaptiveOptions{kError}, lens, {&near_axis, 1}, settings, banded.cache);
  CHECK(got.statistics.primitives * kRecordBytes > banded.kept.device->info().storage_range_bytes);
  test::check_agreement(banded, lens, exact, in_bands, {-20.0 * std::log10(kError), 0.02});
  const Flare again = frame_by(AdaptiveOptions{kError}, lens, {&near_axis, 1}, settings, banded.cache);
  CHECK(again.image.pixels == in_bands.image.pixels);
  test::check_no_messages();
}

// With bands as wide as those of larger images it has 62 dB.
TEST_CASE("a spot of several colours is drawn on the device with as many wavelengths as it needs") {
  OnDevice device;
  if (!device.kept.device) return;
  check_by_need(device, of_fisheye(160, 90, {{1, 3}, {6, 8}}), {67.0, 0.01});
}

// The light of bands that have the transmittance of the rays in common alone is up to 8 per cent off.
TEST_CASE("a ghost whose pupil grows with the wavelength has its light on the device with as many as it needs") {
  OnDevice device;
  if (!device.kept.device) return;
  check_by_need(device, sliver(), {53.0, 0.04});
}

// The arms of this ghost's pupil are thinner than a cell of the search; without them it lacks 5 per cent.
TEST_CASE("thin parts of a pupil are drawn on the device") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lens = lens_of("nikon-80-200", 0, 5.6);
  FrameSettings settings = settings_of(lens, 64, 36);
  settings.selection = SelectList{{{4, 9}}};
  const Light light{.direction = direction_from_angles(0.045, 0.0253)};
  check_near(device, lens, {&light, 1}, settings, AdaptiveOptions{}.error, 0.002);
  test::check_no_messages();
}

// Only the scan finds this pupil, in one cell of the window, beyond which its ends reach: a fifth of the ghost's light.
TEST_CASE("the ends of a long, thin pupil are drawn on the device") {
  OnDevice device;
  if (!device.kept.device) return;
  check_near(device, sliver(), AdaptiveOptions{}.error, 0.005);
  test::check_no_messages();
}

// Only scans find these pupils, a five-hundredth of the window wide.
TEST_CASE("pupils smaller than a cell of the second level of the search are drawn on the device") {
  OnDevice device;
  if (!device.kept.device) return;
  for (const Ghost& ghost : {Ghost{1, 5}, Ghost{3, 9}})
    check_near(device, of_fisheye(64, 36, {ghost}), AdaptiveOptions{}.error, 0.01);
  test::check_no_messages();
}

TEST_CASE("the device keeps the pupils of lights that stand still, and draws the bits of a frame by itself") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lens = lens_of("heliar", 7, 8.0), closed = lens_of("heliar", 7, 11.0);
  FrameSettings settings = settings_of(lens, 64, 36);
  settings.selection = SelectBrightest{3};
  FrameSettings wide = settings, fringed = settings;
  wide.frame.width = 70;
  fringed.ringing.mode = RingingMode::Fresnel;
  const Light light = kTwoLights.front(), other = kTwoLights.back();
  const Light third{.direction = direction_from_angles(0.02, -0.09)};
  Light bright = light;
  bright.value = {5.0, 3.0, 2.0};
  const auto check = [&](const LensState& of_lens, const Light& here, const FrameSettings& with, bool is_kept) {
    const Flare got = frame_by(AdaptiveOptions{}, of_lens, {&here, 1}, with, device.cache);
    static_cast<void>(frame_by(AdaptiveOptions{}, lens, {&third, 1}, settings, device.cache));
    const Flare searched = frame_by(AdaptiveOptions{}, of_lens, {&here, 1}, with, device.cache);
    CHECK(got.image.pixels == searched.image.pixels);
    CHECK(has_searched(searched));
    CHECK(has_searched(got) == !is_kept);
  };
  check(lens, light, settings, false);
  check(lens, bright, settings, true);
  check(lens, light, wide, true);
  check(lens, other, settings, false);
  check(lens, light, settings, false);
  check(lens, light, fringed, false);
  check(closed, light, settings, false);
  test::check_no_messages();
}

TEST_CASE("the statistics count a device's rays and invocations, and the bytes between it and the host") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lens = lens_of("heliar");
  FrameSettings settings = settings_of(lens, 48, 27);
  settings.selection = SelectBrightest{2};
  const auto lights = std::span(kTwoLights).first(1);
  const RenderStatistics first = frame_by(AdaptiveOptions{}, lens, lights, settings, device.cache).statistics;
  const RenderStatistics second = frame_by(AdaptiveOptions{}, lens, lights, settings, device.cache).statistics;
  CHECK(first.rays > second.rays);  // which does not search
  CHECK(second.rays >= 4 * 256);  // the measures of two ghosts at two wavelengths
  CHECK(second.device_bytes >= std::uint64_t{4 * 3 * 48 * 27});
  if (device.kept.device->info().kind == "processor")
    CHECK(first.device_invocations - second.device_invocations >= first.rays - second.rays);
  const RenderStatistics of_cpu = frame_by(AdaptiveOptions{}, lens, lights, settings, device.cpu_cache).statistics;
  CHECK(of_cpu.device_invocations == 0);
  CHECK(of_cpu.device_bytes == 0);
  test::check_no_messages();
}

// Processors have code of their own for rays in pairs, sums and tiles. What it draws, the code for GPUs has to draw,
// too.
TEST_CASE("a processor draws the same with the code for GPUs [slow]") {
  OnDevice own, as_gpu({.draws_as_gpu = true});
  if (!own.kept.device) return;
  const LensState heliar = lens_of("heliar", 7, 8.0), anamorphic = lens_of("schneider-anamorphic-31", 0, 8.0);
  const auto check_same = [&](const MethodOptions& method, const LensState& lens, const FrameSettings& settings) {
    const auto lights = std::span(kTwoLights).first(1);
    const Flare expected = frame_by(method, lens, lights, settings, own.cache);
    const Flare got = frame_by(method, lens, lights, settings, as_gpu.cache);
    test::check_agreement(as_gpu, lens, expected, got, {90.0, 1e-5});
    CHECK(got.statistics.rays == expected.statistics.rays);
  };
  FrameSettings settings = settings_of(heliar, 48, 27);
  check_same(AdaptiveOptions{}, heliar, settings);
  settings.ringing.mode = RingingMode::Fresnel;
  check_same(AdaptiveOptions{}, heliar, settings);
  FrameSettings of_anamorphic = settings_of(anamorphic, 32, 24);
  of_anamorphic.wavelengths = 3;
  of_anamorphic.selection = SelectBrightest{4};
  check_same(AdaptiveOptions{}, anamorphic, of_anamorphic);
  test::check_no_messages();
}
