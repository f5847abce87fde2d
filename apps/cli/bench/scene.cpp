#include "cli/bench/scene.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <system_error>

#include <fmt/format.h>

#include "cli/bench/tables.h"
#include "cli/flare_report.h"
#include "cli/long_task.h"
#include "contrejour/image_io.h"
#include "contrejour/metrics.h"
#include "contrejour/trace.h"
#include "params/settings.h"

namespace contrejour::cli {
namespace {

namespace fs = std::filesystem;

constexpr Vec2 kLights_uv[] = {{0.70, 0.33}, {0.25, 0.75}};
constexpr const char* kReference = "reference";

Result<Flare> render_scene(const BenchScene& scene, const BenchRequest& request, int threads) {
  RenderSettings settings = scene.settings;
  settings.tiled = request.tiled;
  const LongTask task(fmt::format("{}, {} lights, {}", scene.system->name, scene.light_count, request.method), threads);
  return render(request.method, scene.lens, scene.lights, settings, task.context());
}

fs::path cache_file(const BenchScene& scene, const std::string& folder) {
  const RenderSettings& s = scene.settings;
  return fs::path(folder) / fmt::format("{}-{}-{}x{}-{}nm-{:g}.exr", scene.system->key, scene.light_count,
                                        s.frame.width, s.frame.height, s.wavelengths, s.reference_density);
}

Result<Image> reference_image(const BenchScene& scene, const BenchRunning& running) {
  const BenchRequest request{scene.light_count, kReference, {}};
  if (running.cache.empty()) {
    return render_scene(scene, request, running.threads).map([](Flare flare) { return std::move(flare.image); });
  }
  const fs::path file = cache_file(scene, running.cache);
  if (fs::exists(file)) return read_picture(file).map([](Picture picture) { return std::move(picture.rgb); });
  auto flare = render_scene(scene, request, running.threads);
  if (!flare) return tl::unexpected(flare.error());
  std::error_code ignored;  // if the folder cannot be made, writing says so
  fs::create_directories(running.cache, ignored);
  if (const auto ok = write_exr(file, flare->image); !ok) return tl::unexpected(ok.error());
  return std::move(flare->image);
}

// None where there is no picture to compare with.
std::optional<double> psnr_db(const Image& truth, const Image& image) {
  if (truth.pixels.empty()) return std::nullopt;
  const auto comparison = compare(truth, image);
  if (!comparison) return std::nullopt;
  return comparison->psnr_db.value_or(std::numeric_limits<double>::infinity());
}

// Pictures that rows of one scene are compared with.
struct Truths {
  Image reference, bundle, unmerged;
};

Result<BenchRow> measure(const BenchScene& scene, const BenchRequest& request, const BenchRunning& running,
                         Truths& truths) {
  BenchRow row{scene.system, request, scene.settings, {}, running.runs, {}, {}, {}};
  row.settings.tiled = request.tiled;
  for (int run = 0; run < running.runs; ++run) {
    auto flare = render_scene(scene, request, running.threads);
    if (!flare) return tl::unexpected(flare.error());
    if (run == 0 || total_ms(flare->statistics) < total_ms(row.statistics)) row.statistics = flare->statistics;
    if (run > 0) continue;
    row.reference_db = psnr_db(truths.reference, flare->image);
    row.bundle_db = psnr_db(truths.bundle, flare->image);
    row.unmerged_db = psnr_db(truths.unmerged, flare->image);
    if (same(request, bundle_of(request.lights)))
      truths.bundle = std::move(flare->image);
    else if (same(request, tiled_merged(request.lights, 0)))
      truths.unmerged = std::move(flare->image);
  }
  return row;
}

}  // namespace

Result<BenchScene> bench_scene(const PaperSystem& system, int light_count, const params::Values& values) {
  const auto prescription = find_lens(std::string(system.lens));
  if (!prescription) return tl::unexpected(prescription.error());
  LensSettings lens_settings;
  lens_settings.f_number = system.f_number;
  if (system.focal_length_mm > 0.0) lens_settings.focal_length_mm = system.focal_length_mm;
  auto lens = lens_at(*prescription, lens_settings);
  if (!lens) return tl::unexpected(lens.error());
  BenchScene scene{&system, light_count, std::move(*lens), {}, {}};
  const Frame frame = params::whole_frame(values, scene.lens, *params::parse_size(*values.text("size")));
  for (int k = 0; k < light_count; ++k) {
    Light light;
    light.direction =
        direction_to_land_at(scene.lens, frame.sensor_from_uv(kLights_uv[k]), scene.lens.design_wavelength_nm);
    scene.lights.push_back(light);
  }
  scene.settings = params::render_settings(values, frame, ColourSpace::Rec709);
  scene.settings.scale_grid = true;  // the paper's eq. 13
  return scene;
}

Result<void> measure_scene(const BenchScene& scene, const std::vector<BenchRequest>& requests,
                           const BenchRunning& running, BenchRows& rows) {
  std::vector<BenchRequest> wanted;
  std::copy_if(requests.begin(), requests.end(), std::back_inserter(wanted),
               [&](const BenchRequest& request) { return request.lights == scene.light_count; });
  // Those that others are compared with come first.
  const auto rank = [&](const BenchRequest& request) {
    return same(request, bundle_of(request.lights)) ? 0 : same(request, tiled_merged(request.lights, 0)) ? 1 : 2;
  };
  std::stable_sort(wanted.begin(), wanted.end(),
                   [&](const BenchRequest& a, const BenchRequest& b) { return rank(a) < rank(b); });
  if (wanted.empty()) return {};
  Truths truths;
  if (running.reference) {
    auto image = reference_image(scene, running);
    if (!image) return tl::unexpected(image.error());
    truths.reference = std::move(*image);
  }
  for (const BenchRequest& request : wanted) {
    auto row = measure(scene, request, running, truths);
    if (!row) return tl::unexpected(row.error());
    rows.add(std::move(*row));
  }
  return {};
}

}  // namespace contrejour::cli
