// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/polynomial_pictures.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/bench/thesis_figures.h"
#include "cli/long_task.h"
#include "cli/text_table.h"
#include "contrejour/expert/metrics.h"
#include "contrejour/expert/published_pictures.h"
#include "contrejour/image_io.h"

namespace contrejour::cli {
namespace {

namespace fs = std::filesystem;
using namespace published;

struct NamedPicture {
  std::string name;
  Image image;
};

Image grey_picture(const Image& one_channel, double scale) {
  Image grey(one_channel.width, one_channel.height, 3);
  for (std::size_t k = 0; k < one_channel.pixels.size(); ++k)
    for (std::size_t c = 0; c < 3; ++c) grey.pixels[3 * k + c] = static_cast<float>(scale) * one_channel.pixels[k];
  return grey;
}

// Pictures of one size in rows of `columns`, with a line between them.
Image side_by_side(const std::vector<NamedPicture>& pictures, int columns, double scale) {
  constexpr int kLine = 2;
  const int width = pictures.front().image.width + kLine, height = pictures.front().image.height + kLine;
  const int rows = (static_cast<int>(pictures.size()) + columns - 1) / columns;
  Image all(columns * width - kLine, rows * height - kLine, 3);
  std::ranges::fill(all.pixels, 0.25F);
  for (int k = 0; k < static_cast<int>(pictures.size()); ++k) {
    const Image grey = grey_picture(pictures[static_cast<std::size_t>(k)].image, scale);
    for (int y = 0; y < grey.height; ++y) {
      const auto from = grey.pixels.begin() + static_cast<std::ptrdiff_t>(y) * grey.width * 3;
      const std::ptrdiff_t row = (k / columns) * height + y, column = (k % columns) * width;
      std::copy_n(from, grey.width * 3, all.pixels.begin() + (row * all.width + column) * 3);
    }
  }
  return all;
}

Result<void> write_both(const fs::path& folder, const std::string& name, const Image& rgb) {
  if (auto ok = write_exr(folder / (name + ".exr"), rgb); !ok) return ok;
  return write_preview_png(folder / (name + ".png"), rgb);
}

// Writes a series; the first picture is the one that the others are compared with, and sets the exposure.
Result<std::string> write_series(const fs::path& folder, const std::string& series, int columns,
                                 const std::vector<NamedPicture>& pictures) {
  constexpr double kBrightQuantile = 0.985, kBrightLevel = 0.7;
  const double bright = quantile_of_samples(pictures.front().image, kBrightQuantile);
  const double scale = bright > 0.0 ? kBrightLevel / bright : 1.0;
  TextTable table({"<picture", "PSNR dB", "flux ratio"});
  for (const NamedPicture& picture : pictures) {
    if (auto ok = write_both(folder, series + "-" + picture.name, grey_picture(picture.image, scale)); !ok)
      return tl::unexpected(ok.error());
    const auto compared = compare(pictures.front().image, picture.image);
    if (!compared) return tl::unexpected(compared.error());
    table.add({picture.name, compared->psnr_db ? fmt::format("{:.1f}", *compared->psnr_db) : "equal",
               fmt::format("{:.3f}", compared->flux_ratio.front())});
  }
  if (auto ok = write_both(folder, series, side_by_side(pictures, columns, scale)); !ok)
    return tl::unexpected(ok.error());
  return fmt::format("\nPictures {}\n{}", series, table.text());
}

struct FittedPair {
  Polynomial x, y;
};

Result<FittedPair> fit_two_lenses(const TwoLenses& system, ElementPair ghost) {
  const RaySamples rays = random_samples(system, ghost, thesis::kSamples, 1);
  const auto x = DenseFit::fit(rays.x(), thesis::kDegree), y = DenseFit::fit(rays.y(), thesis::kDegree);
  if (!x) return tl::unexpected(x.error());
  if (!y) return tl::unexpected(y.error());
  return FittedPair{x->polynomial(), y->polynomial()};
}

// From the traced picture to the published one, one step after the other: rays that fail and the stop are unknown to
// polynomials; the sensor's place at the fit; the tracer's cylinders.
Result<std::string> draw_two_lenses_series(const PolynomialPictureOptions& options, const Context& context) {
  constexpr ElementPair kGhost{0, 1};
  constexpr double kHalfSize = 3.0;
  struct Step {
    const char* name;
    TwoLenses system;
    bool fitted;
  };
  using Tracer = TwoLenses::Tracer;
  const Step steps[] = {{"traced", {Tracer::Spheres, kTwoLensesDrawnSensor_z}, false},
                        {"polynomials", {Tracer::Spheres, kTwoLensesDrawnSensor_z}, true},
                        {"sensor-at-7", {Tracer::Spheres}, true},
                        {"cylinders", {Tracer::AsPublished, kTwoLensesDrawnSensor_z}, true},
                        {"as-published", {}, true},
                        {"as-published-traced", {}, false}};
  std::vector<NamedPicture> pictures;
  for (const Step& step : steps) {
    TwoLensesPicture picture;
    picture.system = step.system;
    picture.ghost = kGhost;
    picture.half_size = kHalfSize;
    picture.points = options.full ? 2000 : 800;
    FittedPair fitted;
    if (step.fitted) {
      auto pair = fit_two_lenses(step.system, kGhost);
      if (!pair) return tl::unexpected(pair.error());
      fitted = std::move(*pair);
      picture.x = &fitted.x, picture.y = &fitted.y;
    }
    auto image = draw_two_lenses(picture, context);
    if (!image) return tl::unexpected(image.error());
    pictures.push_back({step.name, std::move(*image)});
  }
  return write_series(options.folder, "two-lenses", 3, pictures);
}

Result<std::string> draw_heliar_series(const PolynomialPictureOptions& options, const Context& context) {
  const auto prescription = find_lens("heliar");
  if (!prescription) return tl::unexpected(prescription.error());
  LensSettings settings{.f_number = 16.0};
  settings.iris.blades = 6;
  const auto lens = configure_lens(*prescription, settings);
  if (!lens) return tl::unexpected(lens.error());
  PictureOptions picture;
  picture.light = {0.2, 0.1};
  if (options.full) picture.points = 1000, picture.samples = 2000, picture.degree = 6;
  std::vector<NamedPicture> pictures;
  auto traced = draw_traced_ghosts(*lens, picture, context);
  if (!traced) return tl::unexpected(traced.error());
  pictures.push_back({"traced", std::move(*traced)});
  const std::pair<const char*, PictureFaults> faults[] = {{"polynomials", {}},
                                                          {"output-order", {.output_order = true}},
                                                          {"stop-counted", {.stop_counted = true}},
                                                          {"next-ghost", {.next_ghost = true}},
                                                          {"no-stop-position", {.no_stop_position = true}},
                                                          {"extrapolated", {.extrapolated = true}}};
  for (const auto& [name, fault] : faults) {
    picture.faults = fault;
    auto image = draw_fitted_ghosts(*lens, picture, context);
    if (!image) return tl::unexpected(image.error());
    pictures.push_back({name, std::move(*image)});
  }
  return write_series(options.folder, "heliar", 2, pictures);
}

}  // namespace

Result<std::string> draw_polynomial_pictures(const PolynomialPictureOptions& options, const Context& context) {
  const Context quiet = without_progress(context);
  auto two = draw_two_lenses_series(options, quiet);
  if (!two) return two;
  auto heliar = draw_heliar_series(options, quiet);
  if (!heliar) return heliar;
  return *two + *heliar;
}

}  // namespace contrejour::cli
