// SPDX-License-Identifier: Apache-2.0
// A demonstration: the flare of a lens alone, on a synthetic picture of a night street, and on a moving shot of it; and
// that shot as footage for tests.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "contrejour/apply.h"
#include "contrejour/expert/preview_exposure.h"
#include "contrejour/expert/settings.h"
#include "contrejour/image_io.h"
#include "contrejour/lens.h"
#include "contrejour/render.h"
#include "demo/footage.h"
#include "demo/moving_shot.h"
#include "demo/street.h"

namespace contrejour::demo {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLens = "canon-70-200";
constexpr double kFNumber = 5.6;
constexpr const char* kShotLens = "heliar";
constexpr double kShotFNumber = 8.0;
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

Result<LensState> lens_of(const char* name, double f_number) {
  const auto prescription = find_lens(name);
  if (!prescription) return tl::unexpected(prescription.error());
  LensSettings lens_settings;
  lens_settings.f_number = f_number;
  lens_settings.iris.blades = kBlades;
  return configure_lens(*prescription, lens_settings);
}

// A small shot with few frames, through a lens with few surfaces, so that the demonstration is short.
Result<MovingShot> show_shot(const fs::path& folder) {
  const Step step("A moving shot of the street");
  ShotSettings settings;
  settings.width = 480;
  settings.height = 270;
  settings.frame_count = 24;
  if (auto ok = write_footage(settings, folder); !ok) return tl::unexpected(ok.error());
  const auto lens = lens_of(kShotLens, kShotFNumber);
  if (!lens) return tl::unexpected(lens.error());
  params::Values values;
  const std::pair<const char*, std::string> chosen[] = {
      {"max-lights", "24"}, {"stops", "3"}, {"hfov", fmt::format("{}", settings.hfov_rad / params::kDegree_rad)}};
  for (const auto& [name, text] : chosen)
    if (auto ok = values.set(name, text); !ok) return tl::unexpected(ok.error());
  return flare_footage(settings, *lens, values, folder);
}

// The street has many lights; the faint ones are merged.
Result<params::Values> demo_values() {
  params::Values values;
  if (auto ok = values.set("max-lights", "16"); !ok) return tl::unexpected(ok.error());
  return values;
}

Result<void> create_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return failure(ErrorCode::Io, "the folder cannot be created: " + error.message(), {folder.string()});
  return {};
}

Result<void> run(const fs::path& folder) {
  if (auto ok = create_folder(folder / "shot"); !ok) return ok;
  const auto lens = lens_of(kLens, kFNumber);
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
  const auto shot = show_shot(folder / "shot");
  if (!shot) return tl::unexpected(shot.error());
  fmt::print("{} lights were followed through the shot: {}\nIts frames in order: {}\n", shot->lights,
             fs::absolute(shot->lights_file).string(), fs::absolute(shot->contact_sheet).string());
  return {};
}

Result<void> run_footage(const ShotSettings& settings, const fs::path& folder) {
  if (auto ok = create_folder(folder); !ok) return ok;
  const Step step("Footage");
  return write_footage(settings, folder);
}

void add_footage(CLI::App& app, ShotSettings& settings, std::string& folder) {
  CLI::App* command = app.add_subcommand("footage", "write only the moving shot of the street, and its true lights");
  command->add_option("FOLDER", folder, "the folder for plate.####.exr and true-lights.toml")->required();
  command->add_option("--frames", settings.frame_count, "over which the shot is spread")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command->add_option("--width", settings.width)->check(CLI::Range(16, 8192))->capture_default_str();
  command->add_option("--height", settings.height)->check(CLI::Range(16, 8192))->capture_default_str();
  command->add_option("--seed", settings.seed, "of the camera's shake, the noise and the grain")->capture_default_str();
  command->add_flag("--noise,!--no-noise", settings.noise, "noise and grain (default: on)");
}

}  // namespace
}  // namespace contrejour::demo

int main(int argc, char** argv) {
  CLI::App app("Shows what Contrejour does: pictures of a lens flare, alone, on a night street, and on a moving shot.",
               "contrejour-demo");
  std::string folder = "contrejour-demo";
  app.add_option("FOLDER", folder, "the folder for the pictures")->capture_default_str();
  contrejour::demo::ShotSettings shot;
  contrejour::demo::add_footage(app, shot, folder);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  const bool is_footage = app.got_subcommand("footage");
  const auto done = is_footage ? contrejour::demo::run_footage(shot, folder) : contrejour::demo::run(folder);
  if (done) return 0;
  fmt::print(stderr, "contrejour-demo: {}\n", done.error().to_string());
  return 1;
}
