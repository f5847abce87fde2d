// SPDX-License-Identifier: Apache-2.0
// Polygons behind stop patterns, pixel by pixel: every way of evaluating the transmittance against the simplest one.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <type_traits>

#include <doctest/doctest.h>

#include "contrejour/expert/iris_field.h"
#include "render/adaptive/cells/stop_map.h"
#include "render/adaptive/emit/edge_table.h"
#include "render/adaptive/emit/pixel_pattern.h"
#include "render/adaptive/plain_image.h"
#include "render/adaptive/scene.h"
#include "render/polygons/packed_irradiance.h"
#include "render/stop_patterns/band_stop_pattern.h"
#include "support/sanitized.h"

using namespace contrejour;
using namespace contrejour::adaptive;
using test::Fuzz;
using test::PlainImage;

namespace {

constexpr int kPatternedWidth = TileGrid::kWidth + 30, kPatternedHeight = TileGrid::kHeight + 9;
constexpr double kRadius_px = 30.0;  // of the stop

// The stop about a point in the frame, slightly curved: a field of a cell that is this many pixels wide and high.
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
  band->fringe_unit = band->edges->fringe_unit();
  band->dark_beyond = 2.0 * band->fringe_unit;
  band->level_within = 4.0 * band->fringe_unit;
  return band;
}

// A smooth pattern, brightest off the middle, with a colour of its own.
std::shared_ptr<stop_patterns::BandStopPattern> patterns(const std::shared_ptr<const IrisShape>& iris,
                                                         PatternAtlas& atlas) {
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
  band->texture = std::make_shared<const stop_patterns::BandTexture>(stop_patterns::texture_table(all), atlas);
  return band;
}

// A single wavelength: all channels have the same pattern.
std::shared_ptr<stop_patterns::BandStopPattern> is_monochrome(std::shared_ptr<stop_patterns::BandStopPattern> band,
                                                              PatternAtlas& atlas) {
  band->parts.resize(1);
  band->parts.front().channel = {1.0F, 1.0F, 1.0F};
  if (band->texture) {
    const std::array one{band->parts.front().pattern->texture()};
    band->texture = std::make_shared<const stop_patterns::BandTexture>(stop_patterns::texture_table(one), atlas);
  }
  return band;
}

double entry_of(const PolygonList& list, const EdgeTable& table, std::size_t k, std::size_t channel) {
  return static_cast<double>(table.is_monochrome ? list.edge_steps[table.first + k].factor
                                                 : list.edge_factors[table.first + k][channel]);
}

// From the entries of the table, edge by edge.
std::array<double, 3> by_table(const PolygonList& list, const Pattern& pattern, Vec2 at) {
  const EdgeTable& table = list.edge_tables[pattern.table];
  std::array<double, 3> all{1.0, 1.0, 1.0};
  for (std::uint32_t a = pattern.first; a < pattern.first + pattern.count; ++a) {
    const double stop_point =
        std::clamp((table.dark_beyond - list.bounds[list.active[a]].distance(at)) * table.per_step, 0.0,
                   static_cast<double>(table.count) - 1.0);
    const auto k = std::min(static_cast<std::size_t>(stop_point), static_cast<std::size_t>(table.count) - 2);
    for (std::size_t c = 0; c < 3; ++c)
      all[c] *=
          std::lerp(entry_of(list, table, k, c), entry_of(list, table, k + 1, c), stop_point - static_cast<double>(k));
  }
  return all;
}

// The transmittance of a pattern at a stop point.
using At = std::function<std::array<double, 3>(const PolygonList& list, const Pattern& pattern, Vec2 stop)>;

// The mean over the samples of a pixel.
std::array<double, 3> mean_of_samples(const At& at, const PolygonList& list, const Pattern& pattern, Vec2 pixel) {
  const int samples = static_cast<int>(pattern.samples);
  std::array<double, 3> mean{};
  for (int k = 0; k < samples * samples; ++k) {
    const Vec2 off{(k % samples + 0.5) / samples - 0.5, (k / samples + 0.5) / samples - 0.5};
    const auto one = at(list, pattern, pattern.map.stop_point(pixel + off));
    for (std::size_t c = 0; c < 3; ++c) mean[c] += one[c] / (samples * samples);
  }
  return mean;
}

// Random polygons anywhere about a stop pattern's place; pattern_of() gives their pattern, `at` its transmittance, of
// which each pixel is the mean over one to three samples on each side.
template <class PatternOf>
double worst_difference(unsigned seed, const PatternOf& pattern_of, const At& at, const PatternAtlas* atlas = nullptr) {
  Fuzz fuzz(seed);
  double worst = 0.0;
  for (int k = 0; k < (test::kSanitized ? 12 : 60); ++k) {
    PolygonList list;
    const Vec2 middle{fuzz(-20.0, kPatternedWidth + 20.0), fuzz(-10.0, kPatternedHeight + 10.0)};
    const double size = std::pow(10.0, fuzz(0.0, 2.2));
    const auto corners = fuzz.ellipse(middle, size, k % 3 == 0 ? 0.05 : fuzz(0.3, 1.0), k % 4 == 1);
    Pattern pattern = pattern_of(list, middle, size);
    pattern.samples = 1 + static_cast<std::uint32_t>(k % 3);
    list.add(corners, fuzz.irradiance(middle), pattern);
    if (k % 2 == 0) list.add(fuzz.ellipse(middle, 20.0, 1.0, false), fuzz.irradiance(middle));  // by sums and by pixels
    PlainImage plain(kPatternedWidth, kPatternedHeight);
    plain.add(list, [&](const Polygon& p, Vec2 pixel) {
      return p.pattern > 0 ? mean_of_samples(at, list, list.patterns[p.pattern - 1], pixel) : std::array{1.0, 1.0, 1.0};
    });
    worst = std::max(worst, plain.difference(test::drawn(list, kPatternedWidth, kPatternedHeight, atlas)));
  }
  return worst;
}

PatternMap map_about(Vec2 middle, double size, double stop_size) {
  return StopMap(pixels_about(middle, size), std::array{stop_about(stop_size)}, 0.2).last(1);
}

// The fringes of some bounds.
Pattern fringes(const stop_patterns::BandStopPattern& band, PolygonList& list, std::span<const std::uint16_t> active,
                const PatternMap& map) {
  Pattern pattern{.kind = PatternKind::EdgeFringes, .map = map};
  pattern.table = add_edge_table(band, 1.0 / kRadius_px, list);
  pattern.first = static_cast<std::uint32_t>(list.active.size());
  pattern.count = static_cast<std::uint32_t>(active.size());
  list.active.insert(list.active.end(), active.begin(), active.end());
  return pattern;
}

std::vector<std::uint16_t> bounds_of(const IrisShape& iris) {
  std::vector<std::uint16_t> all(iris.bounds().size());
  std::iota(all.begin(), all.end(), std::uint16_t{0});
  return all;
}

}  // namespace

// What a list holds can be copied to a device as it is.
template <class... Element>
constexpr bool kArePlain = (std::is_trivially_copyable_v<Element> && ...);
static_assert(kArePlain<Point, Polygon, LinearIrradiance, Pattern, IrisBound, EdgeTable, EdgeStep, WavelengthWeights,
                        PixelSpan, TextureTable::Level, TextureTable::Pair>);

TEST_CASE("edges' fringes: the table's, at every pixel [slow]") {
  const auto iris = blades();
  PatternAtlas atlas;
  bool alone = false;
  SUBCASE("of several wavelengths") {}
  SUBCASE("of one") { alone = true; }
  const auto band = alone ? is_monochrome(edges(iris), atlas) : edges(iris);
  CHECK(band->is_monochrome() == alone);
  const std::vector<std::uint16_t> all = bounds_of(*iris);
  const auto several = [&](PolygonList& list, Vec2 middle, double size) {
    return fringes(*band, list, all, map_about(middle, size, size));
  };
  CHECK(worst_difference(5, several, by_table) < 2e-4);

  // A single edge, straight or curved, has a path of its own.
  for (std::size_t only = 0; only < 2; ++only) {
    Iris one;
    if (only == 1) one.blades = 6;
    const auto shape = std::make_shared<const IrisShape>(one);
    const auto of_one = alone ? is_monochrome(edges(shape), atlas) : edges(shape);
    const std::array bound{static_cast<std::uint16_t>(shape->bounds().size() - 1)};
    const auto single = [&](PolygonList& list, Vec2 middle, double size) {
      return fringes(*of_one, list, bound, map_about(middle, size, size));
    };
    CHECK(worst_difference(6, single, by_table) < 2e-4);
  }
}

TEST_CASE("fringes along the outline of a picture as the iris: those of its distance") {
  const int side = 64;
  std::vector<float> level;
  for (int k = 0; k < side * side; ++k)
    level.push_back(std::hypot(k % side - 30.0, k / side - 36.0) < 22.0 ? 1.0F : 0.0F);
  Iris iris;
  iris.field = IrisField::from_levels(level, side, side).value();
  iris.rotation_rad = 0.4;
  const auto shape = std::make_shared<const IrisShape>(iris);
  const PatternAtlas atlas(iris);
  Fuzz fuzz(3);
  for (int k = 0; k < 400; ++k) {
    const Vec2 p{fuzz(-1.5, 1.5), fuzz(-1.5, 1.5)};
    CHECK(atlas.outline().distance(p) == shape->picture_distance(p));
  }
  PatternAtlas none;
  const auto band = is_monochrome(edges(shape), none);
  const auto pattern_of = [&](PolygonList& list, Vec2 middle, double size) {
    return fringes(*band, list, {}, map_about(middle, size, size));
  };
  const auto at = [&](const PolygonList& list, const Pattern& pattern, Vec2 stop) {
    const EdgeTable& table = list.edge_tables[pattern.table];
    const double stop_point = std::clamp((table.dark_beyond - shape->picture_distance(stop)) * table.per_step, 0.0,
                                         static_cast<double>(table.count) - 1.0);
    const auto k = std::min(static_cast<std::size_t>(stop_point), static_cast<std::size_t>(table.count) - 2);
    const double factor =
        std::lerp(entry_of(list, table, k, 0), entry_of(list, table, k + 1, 0), stop_point - static_cast<double>(k));
    return std::array{factor, factor, factor};
  };
  CHECK(worst_difference(9, pattern_of, at, &atlas) < 2e-4);
}

TEST_CASE("light behind fringes: nothing of it stays beyond the frame, and parts of rows stay parts") {
  const auto iris = blades();
  PatternAtlas atlas;
  bool alone = false;
  SUBCASE("of several wavelengths") {}
  SUBCASE("of one") { alone = true; }
  const auto band = alone ? is_monochrome(edges(iris), atlas) : edges(iris);
  const std::vector<std::uint16_t> all = bounds_of(*iris);
  const LinearIrradiance irradiance{{0.0F, 0.0F}, {1.0F, 2.0F, 3.0F, 0.0F}, {}, {}};
  Fuzz fuzz(12);
  TileRasteriser used;
  // A frame whose width is not a multiple of the blocks, with a stop so large that the pattern is uniform over long
  // stretches of rows.
  for (const int width : {61, 200, TileGrid::kWidth + 29}) {
    for (int k = 0; k < (test::kSanitized ? 4 : 20); ++k) {
      PolygonList list;
      const double size = 40.0 * kRadius_px;
      const Vec2 middle{fuzz(0.0, width), fuzz(0.0, kPatternedHeight)};
      const Pattern pattern = fringes(*band, list, all, map_about(middle, size, k % 2 == 0 ? size : 0.05 * size));
      const auto x = [&] { return static_cast<float>(fuzz(-10.0, width + 30.0)); };
      const auto y = [&] { return static_cast<float>(fuzz(-5.0, kPatternedHeight + 5.0)); };
      for (int p = 0; p < 6; ++p) {
        const float x0 = x(), x1 = x(), y0 = y(), y1 = y(),
                    tilt = p % 2 == 0 ? 0.0F : static_cast<float>(fuzz(-9.0, 9.0));
        const std::array corners{Point{x0, y0}, Point{x1, y0}, Point{x1 + tilt, y1}, Point{x0 + tilt, y1}};
        list.add(corners, irradiance, pattern);
      }
      // Beyond the right border, from the middle of a block on, up to the border and up to the last column; and what
      // the next row of tiles has in those columns.
      const float at = static_cast<float>(TileGrid::kWidth) + 5.5F, to = static_cast<float>(TileGrid::kHeight);
      const auto border = static_cast<float>(width);
      for (const auto& [x0, x1, y0, y1] : {std::array{at, at + 90.0F, 0.0F, to},
                                           {border - 9.3F, border, 0.0F, to},
                                           {border - 9.3F, border - 0.4F, 0.0F, to},
                                           {9.0F, 70.0F, to + 1.0F, to + 8.0F}})
        list.add(std::array{Point{x0, y0}, Point{x1, y0}, Point{x1, y1}, Point{x0, y1}}, irradiance, pattern);
      PlainImage plain(width, kPatternedHeight);
      plain.add(list,
                [&](const Polygon&, Vec2 pixel) { return by_table(list, pattern, pattern.map.stop_point(pixel)); });
      const Image image = test::drawn(list, width, kPatternedHeight);
      CHECK(plain.difference(image) < 2e-4);

      // The result does not depend on what was drawn before in the same memory.
      const auto batch = used.new_batch(width, kPatternedHeight, nullptr);
      batch->extend(1);
      batch->set(0, list);
      Image again = Image::unwritten(width, kPatternedHeight);
      batch->draw(RasterMode::Write, {.threads = 1}, {again});
      CHECK(again.pixels == image.pixels);
    }
  }
}

TEST_CASE("textures: each wavelength's own, in its part of the channels") {
  const auto iris = blades();
  PatternAtlas atlas;
  bool alone = false;
  SUBCASE("several") {}
  SUBCASE("one") { alone = true; }
  const auto band = alone ? is_monochrome(patterns(iris, atlas), atlas) : patterns(iris, atlas);
  CHECK(band->texture->of_one() == alone);
  const auto pattern_of = [&](PolygonList& list, Vec2 middle, double size) {
    WavelengthWeights& weights = list.weights.emplace_back();
    for (std::size_t k = 0; k < band->parts.size(); ++k) std::ranges::copy(band->parts[k].channel, weights[k].begin());
    return Pattern{.kind = PatternKind::Texture, .table = band->texture->index(), .map = map_about(middle, size, size)};
  };
  const TextureTable& table = atlas.texture(band->texture->index());
  const TextureTable::Level& level = table.levels.front();
  const auto packing = PackedIrradiance::of_lowest(level.lowest);
  const auto sample = [&](int column, int row, std::size_t part) {
    if (column < 0 || row < 0 || column >= level.side || row >= level.side) return 0.0;
    const auto at = static_cast<std::size_t>((row + 1) * level.pitch() + column + 1);
    return static_cast<double>(alone ? packing.light(table.pairs[at].here)
                                     : table.samples[TextureTable::kStride * at + part]);
  };
  const auto at = [&](const PolygonList&, const Pattern&, Vec2 stop) {
    const double scale = 0.5 * level.side / table.extent;
    const double x = stop.x * scale + 0.5 * level.side - 0.5, y = -stop.y * scale + 0.5 * level.side - 0.5;
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
  CHECK(worst_difference(7, pattern_of, at, &atlas) < 2e-4);
}

TEST_CASE("several crossings: the pattern at the last one, the sharp iris at those before, as a table of pixels") {
  const auto iris = blades();
  PatternAtlas atlas;
  const auto band = patterns(iris, atlas);
  Fuzz fuzz(8);
  for (int k = 0; k < 20; ++k) {
    PolygonList list;
    const Vec2 middle{fuzz(0.0, kPatternedWidth), fuzz(0.0, kPatternedHeight)};
    const double size = fuzz(2.0, 80.0);
    const auto corners = fuzz.ellipse(middle, size, 0.7, k % 4 == 1);
    const StopMap map(pixels_about(middle, size), std::array{stop_about(2.0 * size), stop_about(size)}, 0.2);
    const auto at = [&](Vec2 pixel) {
      std::array<StopPoint, kMaxStopCrossings> room;
      return band->transmittance(map.stop_points(pixel, room));
    };
    const int samples = 1 + k % 3;
    list.add(corners, fuzz.irradiance(middle),
             pixel_pattern(corners, kPatternedWidth, kPatternedHeight, samples, at, list));
    PlainImage plain(kPatternedWidth, kPatternedHeight);
    plain.add(list, [&](const Polygon&, Vec2 pixel) {
      std::array<double, 3> mean{};
      for (int j = 0; j < samples * samples; ++j) {
        const auto one = at(pixel + Vec2{(j % samples + 0.5) / samples - 0.5, (j / samples + 0.5) / samples - 0.5});
        for (std::size_t c = 0; c < 3; ++c) mean[c] += one[c] / (samples * samples);
      }
      return mean;
    });
    // Floats; the sharp iris goes from 0 to 1 within a pixel.
    CHECK(plain.difference(test::drawn(list, kPatternedWidth, kPatternedHeight)) < 5e-6);
  }
}
