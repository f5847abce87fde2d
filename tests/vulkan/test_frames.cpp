// SPDX-License-Identifier: Apache-2.0
// Frames drawn by the device against those of the CPU's same method.
#include <algorithm>
#include <cstdlib>

#include "device_frames.h"

using namespace contrejour;
using test::frame_by, test::kTwoLights, test::lens_of, test::settings_of, test::OnDevice;

namespace {

// Compares a method on both sides.
void check_same(OnDevice& device, const MethodOptions& method, const LensState& lens, std::span<const Light> lights,
                const FrameSettings& settings, double least_db = 60.0) {
  const Flare exact = frame_by(method, lens, lights, settings, device.cpu_cache);
  const Flare got = frame_by(method, lens, lights, settings, device.cache);
  CHECK(got.statistics.rays == exact.statistics.rays);
  test::check_agreement(device, lens, exact, got, {least_db, 1e-3});
}

// As many frames as the environment says, or two cycles of those of the soak test.
constexpr int kSoakCycle = 60;
int soak_frames() {
  const char* const wanted = std::getenv("CONTREJOUR_SOAK_FRAMES");
  return std::max(wanted == nullptr ? 0 : std::atoi(wanted), 2 * kSoakCycle);
}

MethodOptions bundle_of(int rays) { return BundleOptions{.grid = {.rays = rays}}; }
MethodOptions tiled_of(int rays) { return TiledOptions{.grid = {.rays = rays}}; }

}  // namespace

TEST_CASE("bundle and tiled draw every bundled lens on the device as on the CPU [slow]") {
  OnDevice device;
  if (!device.kept.device) return;
  int blades = 0;
  for (const BundledLens& bundled : bundled_lenses()) {
    blades = (blades + 5) % 9;
    const LensState lens = lens_of(std::string(bundled.name), blades < 3 ? 0 : blades);
    FrameSettings settings = settings_of(lens, 64, 36);
    settings.selection = SelectBrightest{6};
    check_same(device, bundle_of(24), lens, std::span(kTwoLights).first(1), settings);
    check_same(device, tiled_of(24), lens, std::span(kTwoLights).first(1), settings);
  }
  test::check_no_messages();
}

TEST_CASE("several lights, near lights, shifted ghosts and a window of the frame are drawn as on the CPU") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lens = lens_of("heliar", 7, 8.0);
  FrameSettings settings = settings_of(lens, 96, 54);
  settings.selection = SelectBrightest{12};
  check_same(device, bundle_of(48), lens, kTwoLights, settings);
  settings.frame.origin_x = 27;
  settings.frame.origin_y = 11;
  settings.frame.width = 55;
  settings.frame.height = 40;
  std::vector<Light> near = kTwoLights;
  near.back().distance_mm = 800.0;
  check_same(device, bundle_of(32), lens, near, settings);
  check_same(device, tiled_of(32), lens, near, settings);
}

TEST_CASE("every interpolation of tiled is the CPU's") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lens = lens_of("heliar");
  FrameSettings settings = settings_of(lens);
  settings.selection = SelectBrightest{4};
  using Interpolation = TiledOptions::Interpolation;
  for (const auto interpolation : {Interpolation::Triangle, Interpolation::HomogeneousTriangle,
                                   Interpolation::MeanValue, Interpolation::Wachspress, Interpolation::LoopDeRose})
    check_same(device, TiledOptions{.grid = {.rays = 32}, .interpolation = interpolation}, lens,
               std::span(kTwoLights).first(1), settings);
}

TEST_CASE("polygons of few pixels or many are drawn by tile as by one invocation") {
  OnDevice by_tile({.large_pixels = 4}), alone({.large_pixels = 1 << 24});
  if (!by_tile.kept.device) return;
  const LensState lens = lens_of("heliar", 7);
  FrameSettings settings = settings_of(lens);
  settings.selection = SelectBrightest{6};
  for (const MethodOptions& method : {bundle_of(32), tiled_of(32)}) {
    const Flare exact = frame_by(method, lens, kTwoLights, settings, by_tile.cpu_cache);
    const Flare got = frame_by(method, lens, kTwoLights, settings, by_tile.cache);
    check_agreement(by_tile, lens, exact, got, {60.0, 1e-3});
    check_agreement(alone, lens, got, frame_by(method, lens, kTwoLights, settings, alone.cache), {90.0, 1e-5});
    CHECK(frame_by(method, lens, kTwoLights, settings, by_tile.cache).image.pixels == got.image.pixels);
  }
  test::check_no_messages();
}

TEST_CASE("a frame is the same bits from run to run, and from a device that drew others [slow]") {
  OnDevice device, fresh;
  if (!device.kept.device) return;
  const LensState lens = lens_of("heliar"), other = lens_of("canon-70-200");
  FrameSettings settings = settings_of(lens), others = settings_of(other, 64, 36);
  settings.selection = others.selection = SelectBrightest{5};
  for (const MethodOptions& method : {bundle_of(32), tiled_of(32), MethodOptions(AdaptiveOptions{})}) {
    const Flare first = frame_by(method, lens, kTwoLights, settings, device.cache);
    static_cast<void>(frame_by(method, other, std::span(kTwoLights).first(1), others, device.cache));
    CHECK(frame_by(method, lens, kTwoLights, settings, device.cache).image.pixels == first.image.pixels);
    CHECK(frame_by(method, lens, kTwoLights, settings, fresh.cache).image.pixels == first.image.pixels);
  }
}

TEST_CASE("what a device cannot draw the CPU draws, and the statistics say so") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lens = lens_of("heliar");
  FrameSettings settings = settings_of(lens, 64, 36);
  settings.selection = SelectBrightest{2};
  const auto lights = std::span(kTwoLights).first(1);
  for (const MethodOptions& method : {MethodOptions(BundleOptions{.grid = {.rays = 32}, .mirror_symmetry = true}),
                                      MethodOptions(BundleOptions{.grid = {.rays = 32}, .spectral_filter = true})}) {
    const Flare got = frame_by(method, lens, lights, settings, device.cache);
    CHECK(got.statistics.device.starts_with("cpu ("));
    CHECK(got.image.pixels == frame_by(method, lens, lights, settings, device.cpu_cache).image.pixels);
  }
}

TEST_CASE("a device that is lost, hangs or is full fails one frame, and draws the next") {
  const LensState lens = lens_of("heliar");
  FrameSettings settings = settings_of(lens, 64, 36);
  settings.selection = SelectBrightest{2};
  const auto lights = std::span(kTwoLights).first(1);
  enum class Failure { None, Lost, Memory } failure = Failure::None;
  OnDevice device({.before_submission = [&](std::uint64_t) {
    if (failure == Failure::Lost) test::lose_device();
    if (failure == Failure::Memory) test::exhaust_device();
  }});
  if (!device.kept.device) return;
  const Flare whole = frame_by(bundle_of(32), lens, lights, settings, device.cache);
  for (const Failure now : {Failure::Lost, Failure::Memory}) {
    failure = now;
    const auto lost = render_frame(bundle_of(32), {lens, lights, settings, device.cache}, {});
    REQUIRE_FALSE(lost.has_value());
    CHECK(lost.error().message.find(now == Failure::Lost ? "lost" : "memory") != std::string::npos);
    device.kept.is_required = false;
    CHECK(frame_by(bundle_of(32), lens, lights, settings, device.cache).statistics.device.starts_with("cpu ("));
    failure = Failure::None;
    device.kept.is_required = true;
    CHECK(frame_by(bundle_of(32), lens, lights, settings, device.cache).image.pixels == whole.image.pixels);
  }
  test::check_no_messages();
}

TEST_CASE("a submission that takes longer than the limit fails its frame, and the process lives [slow]") {
  OnDevice device({.longest_wait_s = 1e-9});
  if (!device.kept.device) return;
  const LensState lens = lens_of("heliar");
  FrameSettings settings = settings_of(lens);
  settings.selection = SelectBrightest{2};
  const auto slow = render_frame(bundle_of(64), {lens, kTwoLights, settings, device.cache}, {});
  REQUIRE_FALSE(slow.has_value());
  CHECK(slow.error().message.find("no answer") != std::string::npos);
  device.kept.is_required = false;
  CHECK(frame_by(bundle_of(32), lens, kTwoLights, settings, device.cache).statistics.device.starts_with("cpu ("));
  test::messages().clear();  // the layer reports what was left behind
}

TEST_CASE("the device's memory stays as it is over many frames [slow]") {
  OnDevice device;
  if (!device.kept.device) return;
  const std::array lenses{lens_of("heliar"), lens_of("tessar", 6, 11.0), lens_of("heliar", 0, 16.0)};
  std::uint64_t after_first = 0;
  // Each cycle has the same frames, so that all buffers have their size after the first one.
  for (int k = 0; k < soak_frames(); ++k) {
    const int frame = k % kSoakCycle;
    const LensState& lens = lenses[static_cast<std::size_t>(frame % 3)];
    std::vector<Light> lights{{.direction = direction_from_angles(0.1 * frame / kSoakCycle, 0.05)}};
    if (frame % 4 == 0) lights.push_back(kTwoLights.back());
    FrameSettings settings = settings_of(lens, 32 + frame % 5 * 8, 32);
    settings.wavelengths = 1;
    settings.selection = SelectBrightest{2};
    const std::array<MethodOptions, 3> methods{AdaptiveOptions{}, tiled_of(16), bundle_of(16)};
    const auto& method = methods[static_cast<std::size_t>(frame / 3 % 3)];
    static_cast<void>(frame_by(method, lens, lights, settings, device.cache));
    if (k + 1 == kSoakCycle) after_first = device.kept.device->memory_bytes();
    if (frame + 1 == kSoakCycle) REQUIRE(device.kept.device->memory_bytes() == after_first);
  }
  test::check_no_messages();
}
