// contrejour bench tables: bodonyi2023's systems on this machine, beside the paper's figures.
#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/bench_report.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/flare_report.h"
#include "cli/long_task.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "contrejour/image_io.h"
#include "contrejour/metrics.h"
#include "contrejour/trace.h"
#include "params/settings.h"

namespace contrejour::cli {
namespace {

namespace fs = std::filesystem;

constexpr Vec2 kLights_uv[] = {{0.70, 0.33}, {0.25, 0.75}};
constexpr const char* kReference = "reference";

constexpr const char* kExamples =
    "Five systems, one and two lights, at the paper's f-numbers and grids (256 x 256, fewer for small ghosts; --grid).\n"
    "--reference adds the PSNR against the reference renderer, which takes hours at full size; --cache keeps its\n"
    "pictures for the next time.\n\n"
    "Examples:\n"
    "  contrejour bench tables\n"
    "  contrejour bench tables --systems heliar,nikon --size 960x540 --reference --cache ~/flares --json tables.json";

struct TablesOptions {
  std::string json, methods = "bundle", systems, cache;
  bool reference = false;
  int runs = 1;
  params::Values values;
};

struct Scene {
  const PaperSystem* system = nullptr;
  int light_count = 1;
  LensState lens;
  std::vector<Light> lights;
  RenderSettings settings;
};

Result<Scene> make_scene(const PaperSystem& system, int light_count, const params::Values& values) {
  const auto prescription = find_lens(std::string(system.lens));
  if (!prescription) return tl::unexpected(prescription.error());
  LensSettings lens_settings;
  lens_settings.f_number = system.f_number;
  if (system.focal_length_mm > 0.0) lens_settings.focal_length_mm = system.focal_length_mm;
  auto lens = lens_at(*prescription, lens_settings);
  if (!lens) return tl::unexpected(lens.error());
  Scene scene{&system, light_count, std::move(*lens), {}, {}};
  const Frame frame = params::whole_frame(values, scene.lens, *params::parse_size(*values.text("size")));
  for (int k = 0; k < light_count; ++k) {
    Light light;
    light.direction = direction_to_land_at(scene.lens, frame.sensor_from_uv(kLights_uv[k]), scene.lens.design_wavelength_nm);
    scene.lights.push_back(light);
  }
  scene.settings = params::render_settings(values, frame, ColourSpace::Rec709);
  scene.settings.scale_grid = true;  // the paper's eq. 13
  return scene;
}

Result<Flare> render_scene(const Scene& scene, const std::string& method, int threads) {
  const LongTask task(fmt::format("{}, {} lights, {}", scene.system->name, scene.light_count, method), threads);
  return render(method, scene.lens, scene.lights, scene.settings, task.context());
}

fs::path cache_file(const Scene& scene, const std::string& folder) {
  const RenderSettings& s = scene.settings;
  return fs::path(folder) / fmt::format("{}-{}-{}x{}-{}nm-{:g}.exr", scene.system->key, scene.light_count, s.frame.width,
                                        s.frame.height, s.wavelengths, s.reference_density);
}

Result<Image> reference_image(const Scene& scene, const TablesOptions& options) {
  const int threads = options.values.integer("threads");
  if (options.cache.empty()) {
    return render_scene(scene, kReference, threads).map([](Flare flare) { return std::move(flare.image); });
  }
  const fs::path file = cache_file(scene, options.cache);
  if (fs::exists(file)) return read_picture(file).map([](Picture picture) { return std::move(picture.rgb); });
  auto flare = render_scene(scene, kReference, threads);
  if (!flare) return tl::unexpected(flare.error());
  std::error_code ignored;  // if the folder cannot be made, writing says so
  fs::create_directories(options.cache, ignored);
  if (const auto ok = write_exr(file, flare->image); !ok) return tl::unexpected(ok.error());
  return std::move(flare->image);
}

Result<BenchRow> measure(const Scene& scene, const std::string& method, const TablesOptions& options,
                         const Image* reference) {
  BenchRow row{scene.system, scene.light_count, scene.settings, {}, options.runs, {}};
  for (int run = 0; run < options.runs; ++run) {
    const auto flare = render_scene(scene, method, options.values.integer("threads"));
    if (!flare) return tl::unexpected(flare.error());
    if (run == 0 || total_ms(flare->statistics) < total_ms(row.statistics)) row.statistics = flare->statistics;
    if (run > 0 || reference == nullptr) continue;
    const auto comparison = compare(*reference, flare->image);
    if (!comparison) return tl::unexpected(comparison.error());
    row.psnr_db = comparison->psnr_db.value_or(std::numeric_limits<double>::infinity());
  }
  return row;
}

std::vector<std::string> words(const std::string& list) {
  std::vector<std::string> out;
  for (const std::string_view word : params::split(list, ',')) out.emplace_back(word);
  return out;
}

bool is_wanted(const PaperSystem& system, const std::string& list) {
  const auto wanted = words(list);
  return list.empty() || std::find(wanted.begin(), wanted.end(), system.key) != wanted.end();
}

Result<void> add_rows(std::vector<BenchRow>& rows, const Scene& scene, const TablesOptions& options) {
  Image reference;
  if (options.reference) {
    auto image = reference_image(scene, options);
    if (!image) return tl::unexpected(image.error());
    reference = std::move(*image);
  }
  for (const std::string& method : words(options.methods)) {
    auto row = measure(scene, method, options, options.reference ? &reference : nullptr);
    if (!row) return tl::unexpected(row.error());
    rows.push_back(std::move(*row));
  }
  return {};
}

Result<int> run_tables(const TablesOptions& options) {
  Outputs outputs;
  fs::path json_file;
  if (!options.json.empty()) {
    const auto file = outputs.add(options.json);
    if (!file) return tl::unexpected(file.error());
    json_file = *file;
  }
  std::vector<BenchRow> rows;
  for (int light_count = 1; light_count <= 2; ++light_count) {
    for (const PaperSystem& system : paper_systems()) {
      if (!is_wanted(system, options.systems)) continue;
      const auto scene = make_scene(system, light_count, options.values);
      if (!scene) return tl::unexpected(scene.error());
      if (const auto ok = add_rows(rows, *scene, options); !ok) return tl::unexpected(ok.error());
    }
  }
  if (!json_file.empty()) {
    if (const auto ok = write_text(json_file, json_text(bench_json(rows))); !ok) return tl::unexpected(ok.error());
  }
  if (const auto ok = outputs.commit(); !ok) return tl::unexpected(ok.error());
  print(bench_text(rows));
  return kDone;
}

std::string problem_with_methods(const std::string& list) {
  for (const std::string& word : words(list)) {
    const auto checked = params::check_value(params::parameter("method"), word);
    if (!checked) return checked.error().message;
  }
  return "";
}

std::string problem_with_systems(const std::string& list) {
  std::vector<std::string_view> known;
  for (const PaperSystem& system : paper_systems()) known.push_back(system.key);
  for (const std::string& word : words(list)) {
    if (std::find(known.begin(), known.end(), word) == known.end()) {
      return fmt::format("\"{}\" is no system; there are {}", word, fmt::join(known, ", "));
    }
  }
  return "";
}

}  // namespace

void add_bench_tables(CLI::App& bench, Action& action) {
  const auto options = std::make_shared<TablesOptions>();
  CLI::App* command = bench.add_subcommand("tables", "the papers' systems: times, counts, PSNR");
  add_output(*command, "--json", options->json, {".json"}, "write the rows to this file");
  command->add_option("--methods", options->methods, "methods, with commas between")->capture_default_str()
      ->check(CLI::Validator(problem_with_methods, "", "methods"))
      ->option_text("LIST");
  command->add_option("--systems", options->systems, "heliar, itoh, nikon, canon-135, canon-200 (default: all)")
      ->check(CLI::Validator(problem_with_systems, "", "systems"))
      ->option_text("LIST");
  command->add_option("--runs", options->runs, "of so many runs the fastest counts")->capture_default_str()->check(CLI::Range(1, 1000));
  command->add_flag("--reference", options->reference, "PSNR against the reference renderer (slow)");
  command->add_option("--cache", options->cache, "keep the reference renderer's pictures here")->option_text("FOLDER");
  add_parameters(*command, options->values, {"size", "wavelengths", "grid", "density", "threads"});
  command->footer(kExamples);
  command->callback([options, &action] { action = [options] { return run_tables(*options); }; });
}

}  // namespace contrejour::cli
