// SPDX-License-Identifier: Apache-2.0
// Frames of `adaptive` that a device draws by its own data flow, against the CPU's at a thirtieth of the error.
#include <cstdlib>

#include "device_frames.h"

using namespace contrejour;
using test::agreement_of, test::frame_by, test::kTwoLights, test::lens_of, test::settings_of, test::OnDevice;

namespace {

constexpr double kFine = 1e-4;

void check_near(OnDevice& device, const LensState& lens, std::span<const Light> lights, const FrameSettings& settings,
                double error = 0.003) {
  FrameSettings colour = settings;
  colour.wavelengths = 3;
  RenderCache on_cpu;
  const Flare exact = frame_by(AdaptiveOptions{kFine}, lens, lights, colour, on_cpu);
  const Flare got = frame_by(AdaptiveOptions{error}, lens, lights, colour, device.cache);
  CHECK(got.statistics.device == device.kept.device->info().name);
  const test::Agreement c = agreement_of(exact.image, got.image);
  INFO(lens.name, ": ", c.psnr_db, " dB, flux off by ", c.flux_error);
  CHECK(c.psnr_db > -20.0 * std::log10(error));
  CHECK(c.flux_error < 0.03);
}

// The number of frames of the soak: a few, or as many as the environment says.
int soak_frames() {
  const char* const wanted = std::getenv("CONTREJOUR_SOAK_FRAMES");
  return wanted == nullptr ? 60 : std::atoi(wanted);
}

}  // namespace

TEST_CASE("adaptive draws every bundled lens on the device within the error [slow]") {
  OnDevice device;
  if (!device.kept.device) return;
  int blades = 0;
  for (const BundledLens& bundled : bundled_lenses()) {
    blades = (blades + 5) % 9;
    const LensState lens = lens_of(std::string(bundled.name), blades < 3 ? 0 : blades, 8.0);
    if (!lens.has_axial_symmetry()) continue;  // left to the CPU
    FrameSettings settings = settings_of(lens, 64, 36);
    settings.selection = SelectBrightest{6};
    check_near(device, lens, std::span(kTwoLights).first(1), settings);
  }
  test::check_no_messages();
}

TEST_CASE("adaptive draws near lights, several lights and a window of the frame on the device") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lens = lens_of("heliar", 7, 8.0);
  FrameSettings settings = settings_of(lens, 96, 54);
  check_near(device, lens, kTwoLights, settings);
  check_near(device, lens, kTwoLights, settings, 0.0005);
  settings.frame.origin_x = 27;
  settings.frame.origin_y = 11;
  settings.frame.width = 55;
  settings.frame.height = 40;
  std::vector<Light> near = kTwoLights;
  near.back().distance_mm = 800.0;
  check_near(device, lens, near, settings);
}

TEST_CASE("a frame of adaptive is the same bits from run to run, and from a device that drew others") {
  OnDevice device, fresh;
  if (!device.kept.device) return;
  const LensState lens = lens_of("heliar"), other = lens_of("tessar");
  const FrameSettings settings = settings_of(lens), others = settings_of(other, 64, 36);
  const MethodOptions method = AdaptiveOptions{};
  const Flare first = frame_by(method, lens, kTwoLights, settings, device.cache);
  for (const MethodOptions& between : {method, MethodOptions(BundleOptions{.grid = {.rays = 24}})}) {
    static_cast<void>(frame_by(between, other, std::span(kTwoLights).first(1), others, device.cache));
    CHECK(frame_by(method, lens, kTwoLights, settings, device.cache).image.pixels == first.image.pixels);
  }
  CHECK(frame_by(method, lens, kTwoLights, settings, fresh.cache).image.pixels == first.image.pixels);
}

TEST_CASE("adaptive: after the first frames the device's memory stays as it is") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lenses[] = {lens_of("heliar"), lens_of("tessar", 6, 11.0), lens_of("heliar", 0, 16.0)};
  std::uint64_t after_first = 0;
  for (int k = 0; k < soak_frames(); ++k) {
    const LensState& lens = lenses[k % 3];
    std::vector<Light> lights{{.direction = direction_from_angles(0.0001 * (k % 1000), 0.05)}};
    if (k % 4 == 0) lights.push_back(kTwoLights.back());
    FrameSettings settings = settings_of(lens, 32 + k % 5 * 8, 32);
    settings.selection = SelectBrightest{2};
    static_cast<void>(frame_by(AdaptiveOptions{}, lens, lights, settings, device.cache));
    if (k == 30) after_first = device.kept.device->memory_bytes();
  }
  CHECK(device.kept.device->memory_bytes() == after_first);
  test::check_no_messages();
}
