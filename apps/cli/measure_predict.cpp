// SPDX-License-Identifier: Apache-2.0
// contrejour measure predict: where flare will hurt, for positions of lights, a panorama or frames.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/apply_frame.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/lens_choice.h"
#include "cli/light_chart.h"
#include "cli/long_task.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/prediction_table.h"
#include "cli/source_choice.h"
#include "contrejour/expert/panorama.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

constexpr const char* kPredictExamples =
    "LENS is a lens or a measured flare (FILE.flare.toml). By default a light is tried at all positions: -o draws "
    "them\n"
    "(green: safe), --csv lists them, and lights given with --light or --light-at are rated among them. With\n"
    "--panorama, views of an HDR panorama are rated among each other, with --frame the frames of a shot; --csv then\n"
    "lists these. docs/physics/flare-prediction.md defines the figures.\n\n"
    "Examples:\n"
    "  contrejour measure predict heliar -f 8 -o safe.svg --csv map.csv\n"
    "  contrejour measure predict mine.flare.toml --light 12,5:20000 --light -3,20:8000 -o safe.svg --json\n"
    "  contrejour measure predict canon-70-200 --focal 70 --panorama hall.exr --views 24 --csv views.csv\n"
    "  contrejour measure predict heliar --frame drive.0001.exr --frame drive.0002.exr --csv drive.csv";

constexpr int kPredictWidth = 384;

struct PredictOptions {
  std::string lens, chart, csv, estimator = "mean_transmission", panorama;
  std::vector<std::string> frames, views;
  int view_count = 12, angles = 31, directions = 7;
  double to_deg = 0.0, safe = 0.1, source_size_deg = 0.5;
  bool json = false;
  params::Values values;
};

// The data that all kinds of prediction share.
struct PredictScene {
  FlareSource source;
  LensState lens;  // its geometry
  Frame frame;
  ColourSpace space = ColourSpace::Rec709;
  FrameSettings settings;
  Estimator estimator = Estimator::MeanTransmission;
  double radius_rad = 0;
};

Estimator estimator_called(const std::string& name) {
  const auto at = std::ranges::find(kEstimatorNames, name);
  return static_cast<Estimator>(at - kEstimatorNames.begin());
}

params::PixelSize predict_size(const params::Values& values, const LensState& lens) {
  if (values.given("size")) return *params::parse_size(*values.text("size"));
  const double aspect = lens.sensor_width_mm > 0.0 ? lens.sensor_height_mm / lens.sensor_width_mm : 2.0 / 3.0;
  return {kPredictWidth, std::max(static_cast<int>(std::lround(kPredictWidth * aspect)), 1)};
}

Result<PredictScene> predict_scene(const PredictOptions& options) {
  auto source = open_source(options.lens, options.values, MeasuredUse::Lights);
  if (!source) return tl::unexpected(source.error());
  PredictScene scene{std::move(*source), {}, {}, {}, {}, {}, {}};
  scene.lens = geometry_of(scene.source);
  scene.frame = params::whole_frame(options.values, scene.lens, predict_size(options.values, scene.lens));
  scene.space = params::colour_space(options.values, ColourSpace::Rec709);
  scene.settings = params::frame_settings(options.values, scene.frame, scene.space);
  scene.estimator = estimator_called(options.estimator);
  scene.radius_rad = 0.5 * options.source_size_deg * params::kDegree_rad;
  return scene;
}

double total_value(const std::vector<Light>& lights, ColourSpace space) {
  double sum = 0.0;
  for (const Light& light : lights) sum += luminance(light.value, space);
  return sum;
}

// The figures of a flare of lights whose direct images sum to `value`.
Result<LightFigures> figures_of_flare(const Image& flare, double value, const PredictScene& scene, const Frame& frame) {
  const auto figures = figures_of(flare, {.space = scene.space});
  if (!figures) return tl::unexpected(figures.error());
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  if (!(value > 0.0)) return LightFigures{*figures, {0.0, 0.0, kInfinite, kInfinite}};
  const auto level = direct_level(value, scene.radius_rad, frame, scene.lens.focal_length_mm);
  if (!level) return tl::unexpected(level.error());
  const auto glare = glare_of(flare, *level, scene.space);
  if (!glare) return tl::unexpected(glare.error());
  return LightFigures{*figures, *glare};
}

Result<PredictionRow> row_of_lights(const std::string& subject, const std::vector<Light>& lights,
                                    const PredictOptions& options, const PredictScene& scene, const Image* below) {
  const LongTask task("predicting", options.values.integer("threads"));
  const auto flare =
      render(params::method_options(options.values), scene.source, lights, scene.settings, task.context());
  if (!flare) return tl::unexpected(flare.error());
  PredictionRow row{subject, lights.size(), {}, {}, {}};
  const auto figures = figures_of_flare(flare->image, total_value(lights, scene.space), scene, scene.frame);
  if (!figures) return tl::unexpected(figures.error());
  row.figures = *figures;
  if (below == nullptr) return row;
  const auto on_scene = figures_on(*below, flare->image, {.space = scene.space});
  if (!on_scene) return tl::unexpected(on_scene.error());
  row.scene = *on_scene;
  return row;
}

using Rows = std::vector<PredictionRow>;

Result<Rows> rows_of_given(const std::vector<Light>& lights, const PredictOptions& options, const PredictScene& scene) {
  Rows rows;
  for (std::size_t k = 0; k < lights.size(); ++k) {
    auto row = row_of_lights(fmt::format("light {}", k + 1), {lights[k]}, options, scene, nullptr);
    if (!row) return tl::unexpected(row.error());
    rows.push_back(std::move(*row));
  }
  if (lights.size() < 2) return rows;
  auto all = row_of_lights("all", lights, options, scene, nullptr);
  if (!all) return tl::unexpected(all.error());
  rows.push_back(std::move(*all));
  return rows;
}

Result<LightMap> map_of(const PredictOptions& options, const PredictScene& scene, double value) {
  LightMapSettings settings;
  settings.to_rad = options.to_deg * params::kDegree_rad;
  settings.angles = options.angles;
  settings.directions = options.directions;
  settings.light.value = {value, value, value};
  settings.light.radius_rad = scene.radius_rad;
  settings.method = params::method_options(options.values);
  settings.frame = scene.settings;
  settings.figures.space = scene.space;
  const LongTask task("predicting", options.values.integer("threads"));
  return map_lights(scene.source, settings, task.context());
}

// The smallest angle from which on every position is safe; none if the last is not.
std::optional<double> safe_from_deg(const LightMap& map, Estimator estimator, double safe) {
  const std::vector<double> values = values_of(map, estimator);
  double from_rad = 0.0;
  const double step_rad = map.to_rad / (map.angles - 1);
  for (std::size_t k = 0; k < values.size(); ++k)
    if (rating_of(values[k], values)->in_range > safe)
      from_rad = std::max(from_rad, map.points[k].angle_rad + step_rad);
  if (from_rad > map.to_rad * 1.0001) return std::nullopt;
  return from_rad / params::kDegree_rad;
}

const LightMapPoint& worst_of(const LightMap& map, Estimator estimator) {
  const std::vector<double> values = values_of(map, estimator);
  return map.points[static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin())];
}

Json map_json(const LightMap& map, Estimator estimator, double safe) {
  const LightMapPoint& worst = worst_of(map, estimator);
  const auto from_deg = safe_from_deg(map, estimator, safe);
  return {{"positions", map.points.size()},
          {"to_deg", map.to_rad / params::kDegree_rad},
          {"worst", value_of(worst.figures, estimator)},
          {"worst_angle_deg", worst.angle_rad / params::kDegree_rad},
          {"worst_direction_deg", worst.direction_rad / params::kDegree_rad},
          {"safe_from_deg", from_deg ? Json(*from_deg) : Json()}};
}

std::string map_text(const LightMap& map, Estimator estimator, double safe) {
  const LightMapPoint& worst = worst_of(map, estimator);
  const auto from_deg = safe_from_deg(map, estimator, safe);
  return fmt::format("{}: worst {:.4g} for a light {:.2f} degrees from the axis, in the direction {:.0f} degrees; {}\n",
                     kEstimatorNames[static_cast<std::size_t>(estimator)], value_of(worst.figures, estimator),
                     worst.angle_rad / params::kDegree_rad, worst.direction_rad / params::kDegree_rad,
                     from_deg ? fmt::format("safe from {:.2f} degrees on", *from_deg)
                              : fmt::format("not safe up to {:.2f} degrees", map.to_rad / params::kDegree_rad));
}

Result<std::vector<CameraView>> views_of(const PredictOptions& options) {
  std::vector<CameraView> views;
  for (const std::string& text : options.views) {
    auto numbers = params::parse_reals(text, 2);
    if (!numbers) numbers = params::parse_reals(text, 3);
    if (!numbers)
      return invalid_argument(fmt::format("--view {} is not AZIMUTH,ELEVATION or AZIMUTH,ELEVATION,ROLL", text));
    views.push_back({(*numbers)[0] * params::kDegree_rad, (*numbers)[1] * params::kDegree_rad,
                     numbers->size() > 2 ? (*numbers)[2] * params::kDegree_rad : 0.0});
  }
  for (int k = 0; views.size() < static_cast<std::size_t>(options.view_count) && options.views.empty(); ++k)
    views.push_back({(360.0 * k / options.view_count - 180.0) * params::kDegree_rad, 0.0, 0.0});
  return views;
}

Result<Rows> rows_of_panorama(const PredictOptions& options, const PredictScene& scene) {
  const auto views = views_of(options);
  if (!views) return tl::unexpected(views.error());
  const auto panorama = read_picture(options.panorama);
  if (!panorama) return tl::unexpected(panorama.error());
  const auto lights = lights_of_panorama(panorama->rgb, params::detection_settings(options.values));
  if (!lights) return failure(lights.error().code, lights.error().message, {options.panorama, 0, 0});
  Rows rows;
  for (const CameraView& view : *views) {
    const auto below = view_of_panorama(panorama->rgb, view, scene.frame, scene.lens.focal_length_mm);
    if (!below) return tl::unexpected(below.error());
    const std::vector<Light> seen = lights_in_view(*lights, view, scene.frame, scene.lens.focal_length_mm);
    const std::string subject =
        fmt::format("{:g},{:g}", view.azimuth_rad / params::kDegree_rad, view.elevation_rad / params::kDegree_rad);
    auto row = row_of_lights(subject, seen, options, scene, &*below);
    if (!row) return tl::unexpected(row.error());
    rows.push_back(std::move(*row));
  }
  return rows;
}

Result<PredictionRow> row_of_frame(const std::string& file, const PredictOptions& options, const PredictScene& scene,
                                   SourceRenderer& renderer) {
  ApplyOptions frame;
  frame.input = file;
  frame.values = options.values;
  auto planned = read_photograph(frame, std::make_shared<const LensState>(scene.lens));
  if (!planned) return tl::unexpected(planned.error());
  const LongTask task("predicting", options.values.integer("threads"));
  const auto flared = render_photograph(std::move(*planned), renderer, task.context());
  if (!flared) return tl::unexpected(flared.error());
  const FlarePlan& plan = flared->planned.plan;
  print_warnings(plan.warnings);
  const Image& flare = flared->flare.image;
  PredictionRow row{file, plan.lights.size(), {}, {}, {}};
  const auto figures = figures_of_flare(flare, total_value(plan.lights, plan.space), scene, plan.grid.frame);
  if (!figures) return tl::unexpected(figures.error());
  row.figures = *figures;
  const auto on_scene = figures_on(flared->planned.picture.rgb, flare, {.space = plan.space});
  if (!on_scene) return tl::unexpected(on_scene.error());
  row.scene = *on_scene;
  return row;
}

Result<Rows> rows_of_frames(const PredictOptions& options, const PredictScene& scene) {
  auto renderer = open_renderer(options.values, scene.source);
  if (!renderer) return tl::unexpected(renderer.error());
  Rows rows;
  for (const std::string& file : options.frames) {
    auto row = row_of_frame(file, options, scene, *renderer);
    if (!row) return tl::unexpected(row.error());
    rows.push_back(std::move(*row));
  }
  return rows;
}

// Rates rows among themselves and writes them.
Result<int> finish_rows(const PredictOptions& options, const PredictScene& scene, Result<Rows> rows) {
  if (!rows) return tl::unexpected(rows.error());
  std::vector<double> values;
  for (const PredictionRow& row : *rows) values.push_back(value_of(row.figures, scene.estimator));
  rate_rows(*rows, scene.estimator, values);
  Outputs outputs;
  const auto csv = outputs.add(options.csv);
  if (!csv) return tl::unexpected(csv.error());
  if (*csv) {
    if (auto ok = (*csv)->write(rows_csv(*rows)); !ok) return tl::unexpected(ok.error());
  }
  if (auto ok = outputs.commit(); !ok) return tl::unexpected(ok.error());
  if (options.json) {
    print_json({{"source", name_of(scene.source)}, {"estimator", options.estimator}, {"rows", rows_json(*rows)}});
  } else {
    print(rows_text(*rows));
  }
  return kDone;
}

std::string chart_of(const PredictOptions& options, const PredictScene& scene, const LightMap& map,
                     const std::vector<Light>& lights) {
  const double per_pixel = 0.5 * scene.frame.pixel_pitch_mm / scene.lens.focal_length_mm;
  return light_chart({name_of(scene.source) + ": positions of a light", &map, scene.estimator, options.safe,
                      Vec2{scene.frame.full_width * per_pixel, scene.frame.full_height * per_pixel}, lights});
}

Result<int> predict_positions(const PredictOptions& options, const PredictScene& scene) {
  Outputs outputs;
  OutputFile *chart = nullptr, *csv = nullptr;
  const std::pair<const std::string&, OutputFile*&> all[] = {{options.chart, chart}, {options.csv, csv}};
  if (auto ok = outputs.add_all(all); !ok) return tl::unexpected(ok.error());
  const auto lights = scaled_lights(
      scene.source, params::given_lights(options.values, scene.lens, scene.frame, scene.space), options.values);
  if (!lights) return tl::unexpected(lights.error());
  const auto map = map_of(options, scene, lights->empty() ? 1.0 : total_value(*lights, scene.space));
  if (!map) return tl::unexpected(map.error());
  auto rows = rows_of_given(*lights, options, scene);
  if (!rows) return tl::unexpected(rows.error());
  rate_rows(*rows, scene.estimator, values_of(*map, scene.estimator));
  Result<void> ok;
  if (chart) ok = chart->write(chart_of(options, scene, *map, *lights));
  if (ok && csv) ok = csv->write(map_csv(*map, scene.estimator));
  if (ok) ok = outputs.commit();
  if (!ok) return tl::unexpected(ok.error());
  if (options.json) {
    print_json({{"source", name_of(scene.source)},
                {"estimator", options.estimator},
                {"map", map_json(*map, scene.estimator, options.safe)},
                {"rows", rows_json(*rows)}});
  } else {
    print(map_text(*map, scene.estimator, options.safe) + rows_text(*rows));
  }
  return kDone;
}

Result<int> run_predict(const PredictOptions& options) {
  const auto scene = predict_scene(options);
  if (!scene) return tl::unexpected(scene.error());
  if (!options.panorama.empty()) return finish_rows(options, *scene, rows_of_panorama(options, *scene));
  if (!options.frames.empty()) return finish_rows(options, *scene, rows_of_frames(options, *scene));
  return predict_positions(options, *scene);
}

void add_predict_scenes(CLI::App& command, PredictOptions& options) {
  CLI::Option* panorama =
      command.add_option("--panorama", options.panorama, "an HDR panorama by latitude and longitude, as EXR")
          ->option_text("FILE");
  command
      .add_option("--view", options.views, "a view of the panorama, in degrees to the right and up; may be repeated")
      ->allow_extra_args(false)
      ->needs(panorama)
      ->option_text("AZ,EL[,ROLL]");
  add_number(command, "--views", options.view_count, 1, 3600, "without --view: evenly spaced headings");
  command.add_option("--frame", options.frames, "a frame of a shot, as EXR or PNG; may be repeated")
      ->allow_extra_args(false)
      ->excludes(panorama)
      ->option_text("FILE");
}

void add_predict_map(CLI::App& command, PredictOptions& options) {
  const std::vector<std::string> names(kEstimatorNames.begin(), kEstimatorNames.end());
  command.add_option("--estimator", options.estimator, "the figure to rate by (default: mean_transmission)")
      ->check(CLI::IsMember(names))
      ->option_text("NAME");
  command.add_option("--safe", options.safe, "positions up to this part of the range are safe (default: 0.1)")
      ->check(CLI::Range(0.0, 1.0))
      ->option_text("N");
  add_number(command, "--angles", options.angles, 2, 2000, "angles from the axis that are tried");
  add_number(command, "--directions", options.directions, 2, 361, "directions that are tried in a quarter");
  command.add_option("--to", options.to_deg, "the largest angle (default: as far as measured; twice a lens's field)")
      ->check(CLI::Range(0.01, 80.0))
      ->option_text("DEG");
  command
      .add_option("--source-size", options.source_size_deg,
                  "diameter of the light's direct image, for transmission (default: 0.5)")
      ->check(CLI::Range(0.001, 60.0))
      ->option_text("DEG");
}

}  // namespace

void add_measure_predict(CLI::App& measure, Action& action) {
  const auto options = std::make_shared<PredictOptions>();
  CLI::App* command = measure.add_subcommand("predict", "say where a light's flare will hurt");
  add_lens_argument(*command, options->lens);
  add_output(*command, "-o,--output", options->chart, {".svg"}, "a chart of safe positions");
  add_output(*command, "--csv", options->csv, {".csv"}, "all positions, views or frames with their figures");
  command->add_flag("--json", options->json, "print JSON");
  add_predict_scenes(*command, *options);
  add_predict_map(*command, *options);
  add_parameters(*command, options->values, {"light", "light-at", "value", "colour", "iso", "shutter"});
  add_lens_parameters(*command, options->values);
  add_parameters(*command, options->values, {"size", "hfov"});
  add_parameters(*command, options->values, {"threshold", "softness", "max-lights", "min-pixels", "max-value"});
  add_parameters(*command, options->values,
                 {"method", "wavelengths", "colour-space", "ghosts", "reflections", "select", "error", "threads"});
  command->footer(kPredictExamples);
  command->callback([options, &action] { action = [options] { return run_predict(*options); }; });
}

}  // namespace contrejour::cli
