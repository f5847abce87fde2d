// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <system_error>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "cli/bench/r2_sequence.h"
#include "cli/bench/repeats.h"
#include "cli/bench/tables.h"
#include "cli/flare_report.h"
#include "cli/long_task.h"
#include "contrejour/expert/metrics.h"
#include "contrejour/expert/settings.h"
#include "contrejour/expert/trace.h"
#include "contrejour/image_io.h"

namespace contrejour::cli {
namespace {

namespace fs = std::filesystem;

constexpr Vec2 kPaperLights_uv[] = {{0.70, 0.33}, {0.25, 0.75}};
constexpr int kPapersWavelengths = 3;  // hullin2011 7.2, standard quality
constexpr const char* kReference = "reference";

// Further lights than the paper's fill the frame evenly.
Vec2 light_uv(std::size_t k) { return k < std::size(kPaperLights_uv) ? kPaperLights_uv[k] : r2_point(k); }

bool is_of(const BenchRequest& request, const BenchScene& scene) {
  return static_cast<std::size_t>(request.lights) == scene.lights.size() && request.variant == scene.variant;
}

bool has_papers_lights(const BenchScene& scene) { return scene.lights.size() <= std::size(kPaperLights_uv); }

// Many lights, and bundle and tiled at full aperture, take seconds to minutes: they are run once.
int runs_of(const BenchScene& scene, const BenchRequest& request, const BenchRunning& running) {
  const bool is_long = !has_papers_lights(scene) || (request.variant.full_aperture && request.method != "adaptive");
  return is_long ? 1 : running.runs;
}

// The user's options, except that grids are scaled by the paper's eq. 13 and that `tiled` has the request's options.
Result<MethodOptions> options_of(const BenchScene& scene, const BenchRequest& request) {
  auto options = params::method_options(scene.values, request.method);
  if (!options) return options;
  if (auto* const bundle = options->get_if<BundleOptions>()) bundle->grid.scale = true;
  if (auto* const tiled = options->get_if<TiledOptions>()) {
    const GridOptions grid = tiled->grid;
    *tiled = request.tiled;
    tiled->grid = grid;
    tiled->grid.scale = true;
  }
  return options;
}

Result<Flare> render_scene(const BenchScene& scene, const BenchRequest& request, int threads) {
  const auto options = options_of(scene, request);
  if (!options) return tl::unexpected(options.error());
  const LongTask task(fmt::format("{}, {} lights, {}", scene.system->name, scene.lights.size(), request.method),
                      threads);
  return render(*options, scene.lens, scene.lights, scene.settings, task.context());
}

fs::path cache_file(const BenchScene& scene, const std::string& folder) {
  const FrameSettings& s = scene.settings;
  std::string name = fmt::format("{}-{}-{}x{}-{}nm-{:g}", scene.system->key, scene.lights.size(), s.frame.width,
                                 s.frame.height, s.wavelengths, params::reference_options(scene.values).density);
  if (std::holds_alternative<SelectList>(s.selection)) name += "-paper-ghosts";
  if (!scene.coating.empty()) name += "-" + scene.coating;
  if (scene.variant.full_aperture) name += "-full-aperture";
  std::ranges::replace(name, '/', '_');  // for the name of a file with reflectances
  return fs::path(folder) / (name + ".exr");
}

// nullopt if there is no picture to compare with.
std::optional<double> psnr_db(const Image& truth, const Image& image) {
  if (truth.pixels.empty()) return std::nullopt;
  const auto comparison = compare(truth, image);
  if (!comparison) return std::nullopt;
  return comparison->psnr_db.value_or(std::numeric_limits<double>::infinity());
}

// The pictures that rows of one scene are compared with.
struct Truths {
  Image reference, bundle, unmerged;
};

Result<BenchRow> measure(const BenchScene& scene, const BenchRequest& request, const BenchRunning& running,
                         Truths& truths) {
  auto options = options_of(scene, request);
  if (!options) return tl::unexpected(options.error());
  BenchRow row{.system = scene.system,
               .request = request,
               .f_number = scene.lens.f_number,
               .options = std::move(*options),
               .settings = scene.settings,
               .statistics = {},
               .runs = runs_of(scene, request, running),
               .reference_db = {},
               .bundle_db = {},
               .unmerged_db = {}};
  const int requested = std::exchange(row.runs, 0);
  double all_ms = 0.0;
  for (int run = 0; another_run(run, requested, all_ms); ++run) {
    ++row.runs;
    auto flare = render_scene(scene, request, running.threads);
    if (!flare) return tl::unexpected(flare.error());
    all_ms += total_ms(flare->statistics);
    if (run == 0 || total_ms(flare->statistics) < total_ms(row.statistics)) row.statistics = flare->statistics;
    if (run > 0) continue;
    row.reference_db = psnr_db(truths.reference, flare->image);
    row.bundle_db = psnr_db(truths.bundle, flare->image);
    row.unmerged_db = psnr_db(truths.unmerged, flare->image);
    if (request.method == "bundle")
      truths.bundle = std::move(flare->image);
    else if (same(request, tiled_merged(request.lights, 0)))
      truths.unmerged = std::move(flare->image);
  }
  return row;
}

Result<LensState> lens_of(const PaperSystem& system, const SceneVariant& variant, const params::Values& values) {
  const auto prescription = find_lens(std::string(system.lens));
  if (!prescription) return tl::unexpected(prescription.error());
  LensSettings settings;
  if (const auto coating = values.text("coating")) settings.coating = *params::parse_coating(*coating);
  if (!variant.full_aperture) settings.f_number = system.f_number;
  if (system.focal_length_mm > 0.0) settings.focal_length_mm = system.focal_length_mm;
  return configure_lens(*prescription, settings);
}

}  // namespace

Result<BenchScene> bench_scene(const PaperSystem& system, int light_count, const SceneVariant& variant,
                               const params::Values& values) {
  auto lens = lens_of(system, variant, values);
  if (!lens) return tl::unexpected(lens.error());
  BenchScene scene{&system, variant, std::move(*lens), {}, {}, values};
  params::PixelSize size = *params::parse_size(*values.text("size"));
  size.width *= variant.scale;
  size.height *= variant.scale;
  const Frame frame = params::whole_frame(values, scene.lens, size);
  for (std::size_t k = 0; k < static_cast<std::size_t>(light_count); ++k) {
    Light light;
    light.direction =
        direction_for_image_point(scene.lens, frame.sensor_from_uv(light_uv(k)), scene.lens.design_wavelength_nm);
    scene.lights.push_back(light);
  }
  scene.settings = params::frame_settings(values, frame, ColourSpace::Rec709);
  scene.settings.scope = GhostScope::OneSideOfStop;  // the paper's ghosts
  scene.coating = values.text("coating").value_or("");
  if (!values.given("wavelengths")) scene.settings.wavelengths = kPapersWavelengths;
  if (variant.wavelengths > 0) scene.settings.wavelengths = variant.wavelengths;
  return scene;
}

Result<Image> reference_picture(const BenchScene& scene, const BenchRunning& running) {
  const BenchRequest request{static_cast<int>(scene.lights.size()), kReference};
  if (running.cache.empty()) {
    return render_scene(scene, request, running.threads).map([](Flare flare) { return std::move(flare.image); });
  }
  const fs::path file = cache_file(scene, running.cache);
  if (fs::exists(file)) return read_picture(file).map([](Picture picture) { return std::move(picture.rgb); });
  auto flare = render_scene(scene, request, running.threads);
  if (!flare) return tl::unexpected(flare.error());
  std::error_code ignored;  // if the folder cannot be created, writing reports the error
  fs::create_directories(running.cache, ignored);
  if (const auto ok = write_exr(file, flare->image); !ok) return tl::unexpected(ok.error());
  return std::move(flare->image);
}

SelectList papers_ghosts(const BenchScene& scene) {
  SelectList list;
  const int last = static_cast<int>(scene.lens.surfaces.size());
  for (const Ghost& ghost : enumerate_ghosts(scene.lens, GhostScope::OneSideOfStop))
    if (ghost.i != last && ghost.j != last) list.ghosts.push_back(ghost);
  return list;
}

Result<void> measure_scene(const BenchScene& scene, const std::vector<BenchRequest>& requests,
                           const BenchRunning& running, BenchRows& rows) {
  std::vector<BenchRequest> own_requests;
  std::copy_if(requests.begin(), requests.end(), std::back_inserter(own_requests),
               [&](const BenchRequest& request) { return is_of(request, scene); });
  // Renders that others are compared with are made first.
  const auto rank = [&](const BenchRequest& request) {
    return request.method == "bundle" ? 0 : same(request, tiled_merged(request.lights, 0)) ? 1 : 2;
  };
  std::stable_sort(own_requests.begin(), own_requests.end(),
                   [&](const BenchRequest& a, const BenchRequest& b) { return rank(a) < rank(b); });
  if (own_requests.empty()) return {};
  Truths truths;
  if (running.reference && scene.variant == SceneVariant{} && has_papers_lights(scene)) {
    auto image = reference_picture(scene, running);
    if (!image) return tl::unexpected(image.error());
    truths.reference = std::move(*image);
  }
  for (const BenchRequest& request : own_requests) {
    auto row = measure(scene, request, running, truths);
    if (!row) return tl::unexpected(row.error());
    rows.add(std::move(*row));
  }
  return {};
}

Result<void> measure_again(const BenchScene& scene, const std::vector<BenchRequest>& requests,
                           const BenchRunning& running, BenchRows& rows) {
  constexpr double kMilliseconds = 100.0;
  for (const BenchRequest& request : requests) {
    if (!is_of(request, scene)) continue;
    const BenchRow& measured = rows.at(*scene.system, request);
    if (measured.runs == 1 || total_ms(measured.statistics) > kMilliseconds) continue;
    Truths none;
    const auto row = measure(scene, request, running, none);
    if (!row) return tl::unexpected(row.error());
    rows.add_again(*row);
  }
  return {};
}

}  // namespace contrejour::cli
