// SPDX-License-Identifier: Apache-2.0
// sabatschus2022 draws ghosts from the points of many rays ("dense") and from triangles between few ("sparse"), and
// compares their times (5.1). Here points, random or on a grid, traced or from polynomials, and cells.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/bench/polynomial_pictures.h"
#include "cli/long_task.h"
#include "cli/text_table.h"
#include "contrejour/expert/metrics.h"
#include "contrejour/expert/published_pictures.h"
#include "contrejour/render.h"

namespace contrejour::cli {
namespace {

using namespace published;
using Draw = std::function<Result<Image>()>;

constexpr double kLambda_nm = 550.0;

// A picture's channel that has the light, scaled so that its pixels sum to 1: units differ between ways of drawing.
Image normalised_picture(const Image& image) {
  Image one(image.width, image.height, 1);
  const auto channels = static_cast<std::size_t>(image.channels), middle = channels / 2;
  double sum = 0.0;
  for (std::size_t k = 0; k < one.pixels.size(); ++k) sum += image.pixels[k * channels + middle];
  for (std::size_t k = 0; k < one.pixels.size(); ++k)
    one.pixels[k] = static_cast<float>(image.pixels[k * channels + middle] / sum);
  return one;
}

Draw cells_by(std::string method, const LensState& lens, const PictureOptions& picture, const Context& context) {
  FrameSettings settings;
  settings.frame = frame_on_sensor(lens, picture.width, picture.height);
  settings.scope = GhostScope::OneSideOfStop;
  settings.lambda_nm = {picture.lambda_nm};
  Light light;
  light.direction = normalized({picture.light.x, picture.light.y, 1.0});
  light.spectrum = EqualEnergy{};
  return [=, &lens]() -> Result<Image> {
    auto flare = render(method, lens, std::span(&light, 1), settings, context);
    if (!flare) return tl::unexpected(flare.error());
    return std::move(flare->image);
  };
}

}  // namespace

Result<std::string> compare_density(const PolynomialPictureOptions& options, const Context& context) {
  const Context quiet = without_progress(context);
  const auto prescription = find_lens("heliar");
  if (!prescription) return tl::unexpected(prescription.error());
  const auto lens = configure_lens(*prescription, {.f_number = 16.0});
  if (!lens) return tl::unexpected(lens.error());
  PictureOptions picture;
  picture.light = {0.2, 0.1};
  picture.width = 480, picture.height = 320, picture.lambda_nm = kLambda_nm;
  const auto points = [&](bool fitted, bool random, int side) -> Draw {
    PictureOptions one = picture;
    one.points = side;
    one.random_points = random;
    return
        [=, &lens]() { return fitted ? draw_fitted_ghosts(*lens, one, quiet) : draw_traced_ghosts(*lens, one, quiet); };
  };
  std::vector<std::pair<std::string, Draw>> ways;
  const std::vector<int> sides = options.full ? std::vector{512, 1024, 2048, 4096, 8192} : std::vector{256, 512, 1024};
  ways.emplace_back("reference", cells_by("reference", *lens, picture, quiet));
  ways.emplace_back("adaptive", cells_by("adaptive", *lens, picture, quiet));
  ways.emplace_back("bundle", cells_by("bundle", *lens, picture, quiet));
  for (const int side : sides) {
    ways.emplace_back(fmt::format("random points, polynomials, {}^2", side), points(true, true, side));
    if (side > 2048) continue;  // minutes
    ways.emplace_back(fmt::format("random points, traced, {}^2", side), points(false, true, side));
    ways.emplace_back(fmt::format("points of a grid, polynomials, {}^2", side), points(true, false, side));
  }
  TextTable table({"<drawn by", "processor s", "PSNR dB"});
  Image reference;
  for (const auto& [name, draw] : ways) {
    const std::clock_t start = std::clock();
    const auto drawn = draw();
    if (!drawn) return tl::unexpected(drawn.error());
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    const Image image = normalised_picture(*drawn);
    if (reference.width == 0) reference = image;
    const auto compared = compare(reference, image);
    if (!compared) return tl::unexpected(compared.error());
    table.add({name, fmt::format("{:.3f}", seconds),
               compared->psnr_db ? fmt::format("{:.1f}", *compared->psnr_db) : "reference"});
  }
  return fmt::format(
      "\nPoints and cells (5.1): heliar at f/16, one wavelength, {} x {}, pictures scaled to one sum\n{}",
      picture.width, picture.height, table.text());
}

}  // namespace contrejour::cli
