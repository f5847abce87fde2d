// SPDX-License-Identifier: Apache-2.0
// contrejour measure demo: from a lens to a prediction without a camera. The exact renderer and a simulated sensor
// stand for the laboratory; all further steps are those of the other commands.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/fit_report.h"
#include "cli/light_chart.h"
#include "cli/long_task.h"
#include "cli/measure_fit.h"
#include "cli/options.h"
#include "contrejour/expert/flare_prediction.h"
#include "contrejour/expert/metrics.h"
#include "contrejour/expert/settings.h"
#include "contrejour/expert/station_file.h"
#include "contrejour/expert/sweep.h"
#include "contrejour/image_io.h"

namespace contrejour::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDemoExamples =
    "Photographs are simulated: the lens by the exact renderer, the sensor with its mosaic, noise and saturation, a "
    "head\n"
    "that jitters, a camera that is rolled and off centre. They are merged, a flare is fitted to them, drawn beside "
    "the\n"
    "lens, and both predict safe positions of a light. The folder then holds report.html, demo.flare.toml, pictures\n"
    "and charts.\n\n"
    "Examples:\n"
    "  contrejour measure demo -o demo\n"
    "  contrejour measure demo -o demo --lens heliar --size 1200 --stations 61\n"
    "  contrejour measure demo -o quick --size 160 --stations 11 --max-ghosts 1 --max-small-ghosts 0 --no-comparison";

constexpr double kPartOfField = 0.95;  // of the largest angle at which the light is in the picture
constexpr double kDrawnPart = 0.55;    // of that: the angle of the picture that is drawn at the end
constexpr double kDrawnRotation_rad = 0.6;  // of that light about the axis, which no photograph showed
constexpr int kMapAngles = 16, kMapDirections = 3;
constexpr double kSafePart = 0.1;

struct DemoOptions {
  std::string folder = "contrejour-demo", lens = "tessar";
  int size = 640, stations = 31, threads = 0;
  bool no_comparison = false, json = false;
  FlareFitOptions fit;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string path_in(const DemoOptions& options, const std::string& name) {
  return (fs::path(options.folder) / name).string();
}

Result<void> make_folders(const DemoOptions& options) {
  std::error_code error;
  if (fs::exists(path_in(options, "merged"), error))
    return failure(ErrorCode::Io, "a demo is here already; name another folder with -o, or remove this one",
                   {path_in(options, "merged"), 0, 0});
  for (const char* folder : {"merged", "pictures"}) {
    fs::create_directories(path_in(options, folder), error);
    if (error) return failure(ErrorCode::Io, "the folder cannot be made; name another with -o", {options.folder, 0, 0});
  }
  return {};
}

Result<SweepSettings> demo_sweep(const LensState& lens, const DemoOptions& options, const Context& context) {
  SweepSettings sweep;
  sweep.width = 2 * (options.size / 2);
  sweep.height = 2 * static_cast<int>(0.5 * sweep.width * lens.sensor_height_mm / lens.sensor_width_mm);
  sweep.angles_deg = even_angles_deg(kPartOfField * largest_angle_deg(lens), options.stations);
  const auto light = automatic_light_rate(lens, sweep, context);
  if (!light) return tl::unexpected(light.error());
  sweep.light_rate = *light;
  return sweep;
}

Result<void> capture_station(const LensState& lens, const SweepSettings& sweep, std::size_t k,
                             const DemoOptions& options, const Context& context) {
  const auto station = simulate_station(lens, sweep, k, context);
  if (!station) return tl::unexpected(station.error());
  MergeSettings merging;
  merging.noise = sweep.sensor.noise;
  auto merged = merge_exposures(station->exposures, station->background, merging, context);
  if (!merged) return tl::unexpected(merged.error());
  MergedStation written{static_cast<int>(k) + 1, station->angle_deg, std::move(*merged), {}};
  if (const auto direct = direct_flux(station->direct)) written.direct = *direct;
  return write_station(path_in(options, fmt::format("merged/station-{:04}.exr", k + 1)), written);
}

Result<SweepSettings> capture(const LensState& lens, const DemoOptions& options) {
  const LongTask task("simulating photographs", options.threads);
  Context quiet = task.context();
  quiet.progress = nullptr;
  const auto sweep = demo_sweep(lens, options, quiet);
  if (!sweep) return tl::unexpected(sweep.error());
  for (std::size_t k = 0; k < sweep->angles_deg.size(); ++k) {
    if (auto ok = capture_station(lens, *sweep, k, options, quiet); !ok) return tl::unexpected(ok.error());
    if (task.context().progress)
      task.context().progress(static_cast<double>(k + 1) / static_cast<double>(sweep->angles_deg.size()));
  }
  return sweep;
}

// Pictures of the stations that the fit kept: captured, fitted, residual.
Result<void> write_stations(const FittedFlare& fit, const DemoOptions& options) {
  const double stops = exposure_of(fit);
  for (const FittedStation& station : fit.stations) {
    if (station.captured_picture.pixels.empty()) continue;
    const std::pair<const char*, Image> all[] = {
        {"captured", station.captured_picture}, {"fitted", station.fitted_picture}, {"residual", residual_of(station)}};
    for (const auto& [what, image] : all) {
      const std::string name = fmt::format("pictures/station-{:04}-{}.png", station.station + 1, what);
      if (auto ok = write_preview_png(path_in(options, name), image, {stops, true}); !ok) return ok;
    }
  }
  return {};
}

Frame demo_frame(const LensState& lens, const DemoOptions& options) {
  const int width = std::max(options.size / 2, 2);
  return frame_on_sensor(lens, width,
                         std::max(static_cast<int>(width * lens.sensor_height_mm / lens.sensor_width_mm), 2));
}

// The same light through the lens and through the flare learned, off the photographs' horizon.
Result<void> draw_both(const LensState& lens, const MeasuredFlare& flare, double to_deg, const DemoOptions& options,
                       const Context& context) {
  const double tangent = std::tan(kDrawnPart * to_deg * params::kDegree_rad);
  Light light;
  light.direction =
      normalized(Vec3{tangent * std::cos(kDrawnRotation_rad), tangent * std::sin(kDrawnRotation_rad), 1.0});
  light.radius_rad = SweepSettings{}.source_radius_rad;
  FrameSettings settings;
  settings.frame = demo_frame(lens, options);
  const auto exact = render(AdaptiveOptions{}, lens, std::span(&light, 1), settings, context);
  if (!exact) return tl::unexpected(exact.error());
  light.radius_rad = 0.0;
  Frame frame = settings.frame;
  frame.pixel_pitch_mm /= lens.focal_length_mm;  // the measured flare's ideal lens has a focal length of 1 mm
  const auto learned = render(flare, std::span(&light, 1), frame, context);
  if (!learned) return tl::unexpected(learned.error());
  const double bright = quantile_of_samples(exact->image, 0.998), stops = bright > 0.0 ? std::log2(0.8 / bright) : 0.0;
  auto ok = write_preview_png(path_in(options, "pictures/drawn-lens.png"), exact->image, {stops, true});
  if (ok) ok = write_preview_png(path_in(options, "pictures/drawn-flare.png"), learned->image, {stops, true});
  if (ok) ok = write_exr(path_in(options, "pictures/drawn-flare.exr"), learned->image);
  return ok;
}

Result<void> predict_one(const FlareSource& source, const std::string& title, const std::string& name,
                         const DemoOptions& options, double to_deg, const Context& context) {
  const LensState lens = geometry_of(source);
  LightMapSettings settings;
  settings.to_rad = to_deg * params::kDegree_rad;
  settings.angles = kMapAngles;
  settings.directions = kMapDirections;
  settings.frame.frame = demo_frame(lens, options);
  const auto map = map_lights(source, settings, context);
  if (!map) return tl::unexpected(map.error());
  const double per_pixel = 0.5 * settings.frame.frame.pixel_pitch_mm / lens.focal_length_mm;
  std::ofstream file(path_in(options, name), std::ios::binary);
  file << light_chart({title,
                       &*map,
                       Estimator::MeanTransmission,
                       kSafePart,
                       Vec2{settings.frame.frame.full_width * per_pixel, settings.frame.frame.full_height * per_pixel},
                       {}});
  if (!file.flush()) return failure(ErrorCode::Io, "the chart cannot be written", {path_in(options, name), 0, 0});
  return {};
}

Result<FitResult> fit_demo(const LensState& lens, const DemoOptions& options) {
  FitRequest request;
  request.folder = path_in(options, "merged");
  request.output = path_in(options, "demo.flare.toml");
  request.report = path_in(options, "report.html");
  request.csv = path_in(options, "stations.csv");
  request.with_comparison = !options.no_comparison;
  if (request.with_comparison) request.compare = path_in(options, "costs.svg");
  request.name = lens.name + ", learned";
  request.fit = options.fit;
  request.threads = options.threads;
  return fit_merged(std::move(request));
}

// The optical centre that was simulated, in merged pixels.
Vec2 true_centre(const SweepSettings& sweep) {
  return {0.25 * sweep.width + 0.5 * sweep.centre_offset_px.x, 0.25 * sweep.height + 0.5 * sweep.centre_offset_px.y};
}

struct DemoTimes {
  double capture_s = 0, fit_s = 0, rest_s = 0;
};

void print_demo(const DemoOptions& options, const FitResult& result, const SweepSettings& sweep,
                const DemoTimes& times) {
  const Vec2 off = result.outcome.fit.centre_px - true_centre(sweep);
  if (options.json) {
    Json json = fit_json(result.outcome);
    json["centre_off_px"] = Json::array({off.x, off.y});
    json["times_s"] = {{"capture", times.capture_s}, {"fit", times.fit_s}, {"draw_and_predict", times.rest_s}};
    return print_json(json);
  }
  print(fit_text(result.outcome));
  print(fmt::format(
      "\noptical centre off by {:.2f}, {:.2f} px; {:.0f} s to simulate and merge, {:.0f} to fit and compare, "
      "{:.0f} to draw and predict\n{}: report.html, demo.flare.toml, pictures and charts\n",
      off.x, off.y, times.capture_s, times.fit_s, times.rest_s, options.folder));
}

Result<int> run_demo(const DemoOptions& options) {
  const auto prescription = find_lens(options.lens);
  if (!prescription) return tl::unexpected(prescription.error());
  const auto lens = configure_lens(*prescription, {});
  if (!lens) return tl::unexpected(lens.error());
  if (auto ok = make_folders(options); !ok) return tl::unexpected(ok.error());
  DemoTimes times;
  auto start = std::chrono::steady_clock::now();
  const auto sweep = capture(*lens, options);
  if (!sweep) return tl::unexpected(sweep.error());
  times.capture_s = seconds_since(start);
  start = std::chrono::steady_clock::now();
  const auto result = fit_demo(*lens, options);
  if (!result) return tl::unexpected(result.error());
  times.fit_s = seconds_since(start);
  start = std::chrono::steady_clock::now();
  const LongTask task("drawing and predicting", options.threads);
  const double to_deg = sweep->angles_deg.back();
  const MeasuredFlare& flare = result->outcome.fit.flare;
  auto ok = write_stations(result->outcome.fit, options);
  if (ok) ok = draw_both(*lens, flare, to_deg, options, task.context());
  if (ok) ok = predict_one(*lens, lens->name, "safe-lens.svg", options, to_deg, task.context());
  if (ok) ok = predict_one(flare, flare.name, "safe-flare.svg", options, to_deg, task.context());
  if (!ok) return tl::unexpected(ok.error());
  times.rest_s = seconds_since(start);
  print_demo(options, *result, *sweep, times);
  return kDone;
}

}  // namespace

void add_measure_demo(CLI::App& measure, Action& action) {
  const auto options = std::make_shared<DemoOptions>();
  CLI::App* command = measure.add_subcommand("demo", "go through all steps with simulated photographs");
  command->add_option("-o,--output", options->folder, "the folder (default: contrejour-demo)")->option_text("FOLDER");
  command->add_option("--lens", options->lens, "the lens that is measured (default: tessar)")->option_text("LENS");
  add_number(*command, "--size", options->size, 96, 8000, "width of the simulated sensor in pixels");
  add_number(*command, "--stations", options->stations, 5, 601, "angles, evenly spaced");
  add_number(*command, "--max-ghosts", options->fit.max_ghosts, 1, 200, "ghosts to look for by their edges");
  add_number(*command, "--max-small-ghosts", options->fit.max_small_ghosts, 0, 200,
             "ghosts of a few pixels to look for besides");
  add_number(*command, "--threads", options->threads, 0, 1024, "threads; 0: one for each core");
  command->add_flag("--no-comparison", options->no_comparison, "skip the comparison with walch2018's descent");
  command->add_flag("--json", options->json, "print JSON");
  command->footer(kDemoExamples);
  command->callback([options, &action] { action = [options] { return run_demo(*options); }; });
}

}  // namespace contrejour::cli
