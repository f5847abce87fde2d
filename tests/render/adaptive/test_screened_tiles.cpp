// SPDX-License-Identifier: Apache-2.0
// Polygons behind stop patterns, pixel by pixel: every way of evaluating the transmittance against the simplest one.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <doctest/doctest.h>

#include "render/adaptive/plain_image.h"
#include "render/adaptive/scene.h"
#include "render/stop_patterns/stop_pattern.h"

using namespace contrejour;
using namespace contrejour::adaptive;
using test::Fuzz;
using test::PlainImage;

namespace {

constexpr int kScreenedWidth = TileGrid::kWidth + 30, kScreenedHeight = TileGrid::kHeight + 9;
constexpr double kRadius_px = 30.0;  // of the stop

// The stop about a place in the frame, slightly bent: a field of a cell that is this many pixels wide and high.
CellSeries pixels_about(Vec2 middle, double size) { return {middle, {0.5 * size, 0}, {0, -0.5 * size}, {}, {}, {}}; }
CellSeries stop_about(double size) {
  const double half = 0.5 * size / kRadius_px;
  return {{0.05, -0.1}, {half, 0.1 * half}, {-0.2 * half, half}, {0.1 * half, 0}, {0, 0.05 * half}, {0, -0.1 * half}};
}

std::shared_ptr<const IrisShape> blades() {
  Iris iris;
  iris.blades = 5;
  iris.curvature = 0.4;
  return std::make_shared<const IrisShape>(iris);
}

std::shared_ptr<stop_patterns::BandStopPattern> edges(const std::shared_ptr<const IrisShape>& iris) {
  auto band = std::make_shared<stop_patterns::BandStopPattern>();
  const auto profile = std::make_shared<const stop_patterns::EdgeProfile>(0.05);
  int k = 0;
  for (const double f : {200.0, 160.0, 120.0}) {
    const auto pattern = std::make_shared<const StopPattern>(iris, stop_patterns::EdgePattern(iris, profile, f));
    band->parts.push_back({pattern, {}});
    band->parts.back().channel[static_cast<std::size_t>(k++)] = 1.0F;
  }
  band->edges = band->parts.front().pattern->edges();
  band->unit = band->edges->unit();
  band->dark_beyond = 2.0 * band->unit;
  band->level_within = 4.0 * band->unit;
  return band;
}

// A smooth pattern, brightest off the middle, with a colour of its own.
std::shared_ptr<stop_patterns::BandStopPattern> patterns(const std::shared_ptr<const IrisShape>& iris) {
  auto band = std::make_shared<stop_patterns::BandStopPattern>();
  std::vector<std::shared_ptr<const stop_patterns::PatternTexture>> textures;
  std::vector<const stop_patterns::PatternTexture*> all;
  for (const double extent : {1.5, 1.7, 2.0}) {
    std::vector<float> samples;
    constexpr int kSide = 64;
    for (int row = 0; row < kSide; ++row)
      for (int column = 0; column < kSide; ++column) {
        const double x = (column + 0.5) / kSide - 0.4, y = (row + 0.5) / kSide - 0.55;
        samples.push_back(static_cast<float>(std::exp(-12.0 * (x * x + y * y)) * (1.2 + std::cos(20.0 * x * extent))));
      }
    textures.push_back(std::make_shared<const stop_patterns::PatternTexture>(kSide, extent, samples));
    all.push_back(textures.back().get());
    band->parts.push_back({std::make_shared<const StopPattern>(iris, stop_patterns::TexturePattern(textures.back())),
                           {static_cast<float>(extent - 1.0), 0.3F, static_cast<float>(1.9 - extent)}});
  }
  band->texture = std::make_shared<const stop_patterns::BandTexture>(all);
  return band;
}

// A single wavelength: all channels have the same pattern.
std::shared_ptr<stop_patterns::BandStopPattern> grey(std::shared_ptr<stop_patterns::BandStopPattern> band) {
  band->parts.resize(1);
  band->parts.front().channel = {1.0F, 1.0F, 1.0F};
  if (band->texture)
    band->texture =
        std::make_shared<const stop_patterns::BandTexture>(std::array{band->parts.front().pattern->texture()});
  return band;
}

double entry_of(const EdgeTable& table, std::size_t k, std::size_t channel) {
  return static_cast<double>(table.is_grey() ? table.steps()[k].factor
                                             : table.entries()[EdgeTable::kStride * k + channel]);
}

// From the entries of the table, edge by edge.
std::array<double, 3> by_table(const EdgeTable& table, Vec2 at) {
  std::array<double, 3> all{1.0, 1.0, 1.0};
  for (const IrisBound& bound : table.iris().bounds()) {
    const double place = std::clamp((table.dark_beyond() - bound.distance(at)) * table.per_step(), 0.0,
                                    static_cast<double>(table.count()) - 1.0);
    const auto k = std::min(static_cast<std::size_t>(place), table.count() - 2);
    for (std::size_t c = 0; c < 3; ++c)
      all[c] *= std::lerp(entry_of(table, k, c), entry_of(table, k + 1, c), place - static_cast<double>(k));
  }
  return all;
}

// The mean over the samples of a pixel.
std::array<double, 3> mean_of_looks(const PlainImage::Share& share, const Polygon& p, const Screened& behind,
                                    Vec2 pixel) {
  const int looks = behind.looks;
  std::array<double, 3> mean{};
  for (int k = 0; k < looks * looks; ++k) {
    const Vec2 off{(k % looks + 0.5) / looks - 0.5, (k / looks + 0.5) / looks - 0.5};
    const auto one = share(p, behind.map.place(pixel + off));
    for (std::size_t c = 0; c < 3; ++c) mean[c] += one[c] / (looks * looks);
  }
  return mean;
}

// Random polygons anywhere about a stop pattern's place; `screened` says how they evaluate it, `share` the value that
// each of a pixel's samples should have, of which there are one to three on each side.
template <class ScreenedOf>
double worst_difference(unsigned seed, const ScreenedOf& screened_of, const PlainImage::Share& share) {
  Fuzz fuzz(seed);
  double worst = 0.0;
  for (int k = 0; k < 60; ++k) {
    PolygonList list;
    const Vec2 middle{fuzz(-20.0, kScreenedWidth + 20.0), fuzz(-10.0, kScreenedHeight + 10.0)};
    const double size = std::pow(10.0, fuzz(0.0, 2.2));
    const auto corners = fuzz.ellipse(middle, size, k % 3 == 0 ? 0.05 : fuzz(0.3, 1.0), k % 4 == 1);
    auto [behind, active] = screened_of(list, middle, size);
    behind.looks = 1 + k % 3;
    list.add(corners, fuzz.shade(middle), behind, active);
    if (k % 2 == 0) list.add(fuzz.ellipse(middle, 20.0, 1.0, false), fuzz.shade(middle));  // by sums and by pixels
    PlainImage plain(kScreenedWidth, kScreenedHeight);
    plain.add(list, [&](const Polygon& p, Vec2 pixel) {
      return p.screened > 0 ? mean_of_looks(share, p, list.screened[p.screened - 1], pixel) : std::array{1.0, 1.0, 1.0};
    });
    worst = std::max(worst, plain.difference(test::drawn(list, kScreenedWidth, kScreenedHeight)));
  }
  return worst;
}

std::vector<std::uint16_t> bounds_of(const IrisShape& iris) {
  std::vector<std::uint16_t> all(iris.bounds().size());
  std::iota(all.begin(), all.end(), std::uint16_t{0});
  return all;
}

}  // namespace

TEST_CASE("edges' fringes: the table's, at every pixel") {
  const auto iris = blades();
  bool alone = false;
  SUBCASE("of several wavelengths") {}
  SUBCASE("of one") { alone = true; }
  const auto band = alone ? grey(edges(iris)) : edges(iris);
  CHECK(band->is_grey() == alone);
  const EdgeTable table(*band, 1.0 / kRadius_px);
  const std::vector<std::uint16_t> all = bounds_of(*iris);
  const auto share = [&](const Polygon&, Vec2 at) { return by_table(table, at); };
  const auto several = [&](PolygonList&, Vec2 middle, double size) {
    const StopMap map(pixels_about(middle, size), std::array{stop_about(size)}, 0.2);
    return std::pair(Screened{map, band.get(), &table}, all);
  };
  CHECK(worst_difference(5, several, share) < 2e-4);

  // A single edge, straight or curved, has a path of its own.
  for (std::size_t only = 0; only < 2; ++only) {
    Iris one;
    if (only == 1) one.blades = 6;
    const auto shape = std::make_shared<const IrisShape>(one);
    const auto fringes = alone ? grey(edges(shape)) : edges(shape);
    const EdgeTable of_one(*fringes, 1.0 / kRadius_px);
    const std::uint16_t bound = static_cast<std::uint16_t>(shape->bounds().size() - 1);
    const auto single = [&](PolygonList&, Vec2 middle, double size) {
      const StopMap map(pixels_about(middle, size), std::array{stop_about(size)}, 0.2);
      return std::pair(Screened{map, fringes.get(), &of_one}, std::vector{bound});
    };
    const auto of_bound = [&](const Polygon&, Vec2 at) {
      const double place = std::clamp((of_one.dark_beyond() - shape->bounds()[bound].distance(at)) * of_one.per_step(),
                                      0.0, static_cast<double>(of_one.count()) - 1.0);
      const auto k = std::min(static_cast<std::size_t>(place), of_one.count() - 2);
      std::array<double, 3> out{};
      for (std::size_t c = 0; c < 3; ++c)
        out[c] = std::lerp(entry_of(of_one, k, c), entry_of(of_one, k + 1, c), place - static_cast<double>(k));
      return out;
    };
    CHECK(worst_difference(6, single, of_bound) < 2e-4);
  }
}

TEST_CASE("light behind fringes: nothing of it stays beyond the frame, and parts of rows stay parts") {
  const auto iris = blades();
  bool alone = false;
  SUBCASE("of several wavelengths") {}
  SUBCASE("of one") { alone = true; }
  const auto band = alone ? grey(edges(iris)) : edges(iris);
  const EdgeTable table(*band, 1.0 / kRadius_px);
  const std::vector<std::uint16_t> all = bounds_of(*iris);
  const Shade shade{{0.0F, 0.0F}, {1.0F, 2.0F, 3.0F, 0.0F}, {}, {}};
  Fuzz fuzz(12);
  // A frame whose width is not a multiple of the blocks, with a stop so large that the pattern is level over long
  // stretches of rows.
  for (const int width : {61, 200, TileGrid::kWidth + 29}) {
    for (int k = 0; k < 20; ++k) {
      PolygonList list;
      const double size = 40.0 * kRadius_px;
      const Vec2 middle{fuzz(0.0, width), fuzz(0.0, kScreenedHeight)};
      const StopMap map(pixels_about(middle, size), std::array{stop_about(k % 2 == 0 ? size : 0.05 * size)}, 0.2);
      const auto x = [&] { return static_cast<float>(fuzz(-10.0, width + 30.0)); };
      const auto y = [&] { return static_cast<float>(fuzz(-5.0, kScreenedHeight + 5.0)); };
      for (int p = 0; p < 6; ++p) {
        const float x0 = x(), x1 = x(), y0 = y(), y1 = y(),
                    tilt = p % 2 == 0 ? 0.0F : static_cast<float>(fuzz(-9.0, 9.0));
        const std::array corners{Point{x0, y0}, Point{x1, y0}, Point{x1 + tilt, y1}, Point{x0 + tilt, y1}};
        list.add(corners, shade, Screened{map, band.get(), &table}, all);
      }
      // Beyond the right border, from the middle of a block on, up to the border and up to the last column; and what
      // the next row of tiles has in those columns.
      const float at = static_cast<float>(TileGrid::kWidth) + 5.5F, to = static_cast<float>(TileGrid::kHeight);
      const auto border = static_cast<float>(width);
      for (const auto& [x0, x1, y0, y1] : {std::array{at, at + 90.0F, 0.0F, to},
                                           {border - 9.3F, border, 0.0F, to},
                                           {border - 9.3F, border - 0.4F, 0.0F, to},
                                           {9.0F, 70.0F, to + 1.0F, to + 8.0F}})
        list.add(std::array{Point{x0, y0}, Point{x1, y0}, Point{x1, y1}, Point{x0, y1}}, shade,
                 Screened{map, band.get(), &table}, all);
      PlainImage plain(width, kScreenedHeight);
      plain.add(list, [&](const Polygon&, Vec2 pixel) { return by_table(table, map.place(pixel)); });
      const Image image = test::drawn(list, width, kScreenedHeight);
      CHECK(plain.difference(image) < 2e-4);

      // The result does not depend on what was drawn before in the same memory: each row of tiles is compared with
      // itself alone.
      const TileGrid grid(width, kScreenedHeight);
      const TiledPolygons tiled{list, tile_lists(list, grid)};
      Image by_row = image;
      for (int row = grid.rows - 1; row >= 0; --row)
        TileDrawer().draw_rows({&tiled, 1}, {row, row + 1}, TileMode::Write, by_row);
      CHECK(by_row.pixels == image.pixels);
    }
  }
}

TEST_CASE("patterns: each wavelength's own, in its part of the channels") {
  const auto iris = blades();
  bool alone = false;
  SUBCASE("several") {}
  SUBCASE("one") { alone = true; }
  const auto band = alone ? grey(patterns(iris)) : patterns(iris);
  CHECK(band->texture->of_one() == alone);
  const auto screened = [&](PolygonList&, Vec2 middle, double size) {
    return std::pair(Screened{StopMap(pixels_about(middle, size), std::array{stop_about(size)}, 0.2), band.get()},
                     std::vector<std::uint16_t>{});
  };
  const auto& samples = band->texture->level_for(0.0);
  const auto sample = [&](int column, int row, std::size_t part) {
    if (column < 0 || row < 0 || column >= samples.side || row >= samples.side) return 0.0;
    const auto at = static_cast<std::size_t>((row + 1) * samples.pitch() + column + 1);
    return static_cast<double>(alone ? samples.coding.light(samples.coded[at].here)
                                     : samples.samples[stop_patterns::BandTexture::kStride * at + part]);
  };
  const auto share = [&](const Polygon&, Vec2 at) {
    const double scale = 0.5 * samples.side / band->texture->extent();
    const double x = at.x * scale + 0.5 * samples.side - 0.5, y = -at.y * scale + 0.5 * samples.side - 0.5;
    const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
    std::array<double, 3> out{};
    for (std::size_t k = 0; k < band->parts.size(); ++k) {
      const double passed =
          std::lerp(std::lerp(sample(column, row, k), sample(column + 1, row, k), x - column),
                    std::lerp(sample(column, row + 1, k), sample(column + 1, row + 1, k), x - column), y - row);
      for (std::size_t c = 0; c < 3; ++c) out[c] += passed * static_cast<double>(band->parts[k].channel[c]);
    }
    return out;
  };
  CHECK(worst_difference(7, screened, share) < 2e-4);
}

TEST_CASE("several crossings: the pattern at the last one, the sharp iris at those before") {
  const auto iris = blades();
  const auto band = patterns(iris);
  const auto screened = [&](PolygonList&, Vec2 middle, double size) {
    const StopMap map(pixels_about(middle, size), std::array{stop_about(2.0 * size), stop_about(size)}, 0.2);
    return std::pair(Screened{map, band.get()}, std::vector<std::uint16_t>{});
  };
  Fuzz fuzz(8);
  for (int k = 0; k < 20; ++k) {
    PolygonList list;
    const Vec2 middle{fuzz(0.0, kScreenedWidth), fuzz(0.0, kScreenedHeight)};
    const double size = fuzz(2.0, 80.0);
    list.add(fuzz.ellipse(middle, size, 0.7, false), fuzz.shade(middle), screened(list, middle, size).first, {});
    PlainImage plain(kScreenedWidth, kScreenedHeight);
    plain.add(list, [&](const Polygon&, Vec2 pixel) {
      std::array<StopPoint, kMaxStopCrossings> room;
      return band->transmittance(list.screened[0].map.places(pixel, room));
    });
    CHECK(plain.difference(test::drawn(list, kScreenedWidth, kScreenedHeight)) <
          5e-6);  // floats; the sharp iris goes from 0 to 1 within a pixel
  }
}
