// SPDX-License-Identifier: Apache-2.0
// A demonstration: the flare of a lens alone, and on a synthetic picture of a night street.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "contrejour/apply.h"
#include "contrejour/expert/preview_exposure.h"
#include "contrejour/expert/settings.h"
#include "contrejour/image_io.h"
#include "contrejour/lens.h"
#include "contrejour/render.h"
#include "demo/street.h"

namespace contrejour::demo {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLens = "canon-70-200";
constexpr double kFNumber = 5.6;
constexpr int kBlades = 8;

// Prints the name of a step, and at its end how long it took.
class Step {
 public:
  explicit Step(const std::string& what) : started_(std::chrono::steady_clock::now()) {
    fmt::print("{} ...", what);
    std::fflush(stdout);
  }
  ~Step() {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - started_;
    fmt::print(" {:.1f} s\n", spent.count());
  }
  Step(const Step&) = delete;
  Step& operator=(const Step&) = delete;

 private:
  std::chrono::steady_clock::time_point started_;
};

Result<void> write_both(const fs::path& folder, const std::string& name, const Image& image, double stops) {
  if (auto ok = write_exr(folder / (name + ".exr"), image); !ok) return ok;
  return write_preview_png(folder / (name + ".png"), image, {stops});
}

Result<void> show_lens_flare(const LensState& lens, const params::Values& values, const fs::path& folder) {
  const Step step("Flare of one light");
  const Frame frame = frame_on_sensor(lens, 960, 540);
  const auto lights = params::lights(values, lens, frame, ColourSpace::Rec709);
  if (!lights) return tl::unexpected(lights.error());
  const auto settings = params::frame_settings(values, frame, ColourSpace::Rec709);
  const auto flare = render(params::method_options(values), lens, *lights, settings);
  if (!flare) return tl::unexpected(flare.error());
  return write_both(folder, "flare", flare->image, params::automatic_exposure(flare->image));
}

Result<Image> show_street(const LensState& lens, const fs::path& folder) {
  const Step step("A night street");
  StreetSettings settings;
  settings.hfov_rad = 2.0 * std::atan(0.5 * lens.sensor_width_mm / lens.focal_length_mm);
  Image street = make_street(settings);
  if (auto ok = write_both(folder, "street", street, 0.0); !ok) return tl::unexpected(ok.error());
  return street;
}

Result<std::size_t> show_applied(const LensState& lens, const params::Values& values, const Image& street,
                                 const fs::path& folder) {
  const Step step("The street through the lens");
  Picture picture = picture_of(street);
  const auto applied = apply_flare(picture, lens, values);
  if (!applied) return tl::unexpected(applied.error());
  if (auto ok = write_both(folder, "street-flare-only", applied->flare.image, 0.0); !ok)
    return tl::unexpected(ok.error());
  if (auto ok = write_both(folder, "street-with-flare", picture.rgb, 0.0); !ok) return tl::unexpected(ok.error());
  return applied->plan.lights.size();
}

// The street has many lights; the faint ones are merged.
Result<params::Values> demo_values() {
  params::Values values;
  if (auto ok = values.set("max-lights", "16"); !ok) return tl::unexpected(ok.error());
  return values;
}

Result<void> run(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return failure(ErrorCode::Io, "the folder cannot be created: " + error.message(), {folder.string()});
  const auto prescription = find_lens(kLens);
  if (!prescription) return tl::unexpected(prescription.error());
  LensSettings lens_settings;
  lens_settings.f_number = kFNumber;
  lens_settings.iris.blades = kBlades;
  const auto lens = configure_lens(*prescription, lens_settings);
  if (!lens) return tl::unexpected(lens.error());
  fmt::print("{}, {:.0f} mm, f/{:g}\n", lens->name, lens->focal_length_mm, lens->f_number);

  const auto values = demo_values();
  if (!values) return tl::unexpected(values.error());
  if (auto ok = show_lens_flare(*lens, *values, folder); !ok) return ok;
  const auto street = show_street(*lens, folder);
  if (!street) return tl::unexpected(street.error());
  const auto lights = show_applied(*lens, *values, *street, folder);
  if (!lights) return tl::unexpected(lights.error());
  fmt::print("\n{} lights were detected in the street. The pictures, each also as EXR, are:\n", *lights);
  for (const char* name : {"flare", "street", "street-with-flare", "street-flare-only"}) {
    fmt::print("  {}\n", (fs::absolute(folder) / (std::string(name) + ".png")).string());
  }
  return {};
}

}  // namespace
}  // namespace contrejour::demo

int main(int argc, char** argv) {
  CLI::App app("Shows what Contrejour does: pictures of a lens flare, alone and on a night street.", "contrejour-demo");
  std::string folder = "contrejour-demo";
  app.add_option("FOLDER", folder, "the folder for the pictures")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  const auto done = contrejour::demo::run(folder);
  if (done) return 0;
  fmt::print(stderr, "contrejour-demo: {}\n", done.error().to_string());
  return 1;
}
