// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "render/adaptive/emit/shared_edges.h"
#include "render/adaptive/plain_image.h"
#include "render/adaptive/scene.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::adaptive;
using test::Fuzz;
using test::PlainImage;

namespace {

std::vector<Point> rectangle(float x0, float y0, float x1, float y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

LinearIrradiance level(float value) {
  LinearIrradiance irradiance;
  irradiance.value = {value, value, value};
  return irradiance;
}

double plain_difference(const PolygonList& list, int width, int height) {
  PlainImage plain(width, height);
  plain.add(list);
  return plain.difference(test::drawn(list, width, height));
}

}  // namespace

TEST_CASE("any convex polygon: its area in each pixel times the irradiance at the pixel's centre") {
  struct Size {
    int width, height, trials;
  };
  for (const Size& size : {Size{40, 24, 400}, Size{300, 40, 100}, Size{1, 1, 200}, Size{3, 50, 150}, Size{520, 2, 60},
                           Size{1300, 3, 60}}) {
    CAPTURE(size.width);
    Fuzz fuzz(static_cast<unsigned>(size.width));
    for (int k = 0; k < size.trials; ++k) {
      CAPTURE(k);
      // Inside, across the frame's edges and outside; from tiny ones to those larger than the frame.
      const Vec2 middle{fuzz(-0.3, 1.3) * size.width, fuzz(-0.3, 1.3) * size.height};
      const double radius = std::pow(10.0, fuzz(-2.0, std::log10(1.5 * size.width + 2.0)));
      const double flat = k % 3 == 0 ? std::pow(10.0, fuzz(-5.0, -1.0)) : fuzz(0.2, 1.0);
      PolygonList list;
      list.add(fuzz.ellipse(middle, radius, flat, k % 4 == 1), fuzz.irradiance(middle));
      CHECK(plain_difference(list, size.width, size.height) < 2e-6);
    }
  }
}

TEST_CASE("polygons along the borders of pixels, tiles and the frame") {
  constexpr auto kTile = static_cast<float>(TileGrid::kWidth);
  constexpr auto kRow = static_cast<float>(TileGrid::kHeight);
  const int width = TileGrid::kWidth + 20;
  const int height = 2 * TileGrid::kHeight + 5;
  const auto w = static_cast<float>(width);
  const auto h = static_cast<float>(height);
  for (const auto& corners :
       {rectangle(0, 0, w, h), rectangle(kTile, kRow, w, h), rectangle(0, 0, kTile, kRow),
        rectangle(kTile - 1, kRow - 1, kTile + 1, kRow + 1), rectangle(-5, -5, 0, h), rectangle(w, 0, w + 9, h),
        rectangle(-1e6F, -1e6F, 1e6F, 1e6F), rectangle(3, h, 8, h + 3),
        std::vector<Point>{{kTile, 3}, {kTile, 30}, {kTile - 7, 16}},
        std::vector<Point>{{kTile, 3}, {kTile, 30}, {kTile + 7, 16}},
        std::vector<Point>{{5, kRow}, {90, kRow}, {40, kRow + 2}}, std::vector<Point>{{0, 3}, {0, 30}, {-7, 16}}}) {
    PolygonList list;
    LinearIrradiance irradiance = level(1.0F);
    irradiance.along_x = {0.01F, 0.0F, -0.02F};
    irradiance.along_y = {0.0F, 0.03F, 0.01F};
    list.add(corners, irradiance);
    CHECK(plain_difference(list, width, height) < 2e-6);
  }
}

TEST_CASE("a point's light is in the pixel that holds it, or nowhere") {
  const int width = TileGrid::kWidth + 4;
  const int height = TileGrid::kHeight + 4;
  const auto w = static_cast<float>(width);
  const auto h = static_cast<float>(height);
  PolygonList list;
  for (const Point p :
       {Point{0, 0}, Point{255.99F, 3}, Point{256, 3}, Point{256.5F, 15.99F}, Point{7.5F, 16}, Point{w, 3}, Point{3, h},
        Point{-0.001F, 5}, Point{5, -0.001F}, Point{1e9F, 2}, Point{w - 0.01F, h - 0.01F}}) {
    LinearIrradiance irradiance = level(2.0F);
    irradiance.at = p;
    list.add({&p, 1}, irradiance);
  }
  CHECK(plain_difference(list, width, height) == 0.0);
  CHECK(test::sum_of_channel(test::drawn(list, width, height), 0) == 6 * 2.0);
}

TEST_CASE("many polygons: the sum of each, whatever lists they come in") {
  constexpr int kWidth = 280;
  constexpr int kHeight = 36;
  Fuzz fuzz(17);
  PolygonList all;
  std::vector<PolygonList> parts(4);
  for (int k = 0; k < 200; ++k) {
    const Vec2 middle{fuzz(-20, kWidth + 20), fuzz(-9, kHeight + 9)};
    auto corners = fuzz.ellipse(middle, std::pow(10.0, fuzz(-1.0, 1.7)), fuzz(0.01, 1.0), false);
    LinearIrradiance irradiance = fuzz.irradiance(middle);
    if (k % 10 == 0) {  // a point has no slope
      corners.resize(1);
      irradiance = level(irradiance.value[0]);
    }
    all.add(corners, irradiance);
    parts[static_cast<std::size_t>(k / 60)].add(corners, irradiance);
  }
  parts.insert(parts.begin() + 2, PolygonList{});
  PlainImage plain(kWidth, kHeight);
  plain.add(all);
  const Image once = test::drawn(all, kWidth, kHeight);
  CHECK(plain.difference(once) < 5e-6);
  CHECK(test::drawn(parts, kWidth, kHeight).pixels == once.pixels);
  // Draws into an image that is not empty.
  TileRasteriser rasteriser;
  const auto batch = rasteriser.new_batch(kWidth, kHeight, nullptr);
  batch->extend(1);
  batch->set(0, all);
  Image added = once;
  batch->draw(RasterMode::Add, {}, {added});
  for (std::size_t k = 0; k < once.pixels.size(); ++k) CHECK(added.pixels[k] == 2.0F * once.pixels[k]);
}

TEST_CASE(
    "the tiles that polygons touch, drawn by themselves and a margin beside them, are those of the whole picture") {
  const int width = 4 * TileGrid::kWidth + 70, height = 5 * TileGrid::kHeight + 10;
  PolygonList list;
  const auto top = static_cast<float>(2 * TileGrid::kHeight + 5), left = static_cast<float>(TileGrid::kWidth + 90);
  list.add(std::array{Point{left, top}, Point{left + 580, top + 9}, Point{left + 300, top + 80}},
           LinearIrradiance{{10, top}, {1.0F, 2.0F, 3.0F}, {}, {}});
  TileRasteriser rasteriser;
  const auto batch = rasteriser.new_batch(width, height, nullptr);
  batch->extend(1);
  const PixelArea none = batch->touched();
  CHECK((none.x1 <= none.x0 && none.y1 <= none.y0));
  batch->extend(1);
  batch->set(1, list);
  const PixelArea lit = batch->touched();
  CHECK((lit.x0 == TileGrid::kWidth && lit.x1 == 3 * TileGrid::kWidth));
  CHECK((lit.y0 == 2 * TileGrid::kHeight && lit.y1 == 4 * TileGrid::kHeight));
  const Image whole = test::drawn(list, width, height);
  for (const int margin : {0, 1, 50, 700}) {
    CAPTURE(margin);
    const int x0 = std::max(TileGrid::kWidth - margin, 0), y0 = std::max(2 * TileGrid::kHeight - margin, 0);
    Image part = Image::unwritten(std::min(3 * TileGrid::kWidth + margin, width) - x0,
                                  std::min(4 * TileGrid::kHeight + margin, height) - y0);
    std::ranges::fill(part.pixels, std::numeric_limits<float>::quiet_NaN());
    batch->draw(RasterMode::Write, {.threads = 2}, {part, x0, y0});
    Image all(width, height);
    for (int y = 0; y < part.height; ++y) std::ranges::copy(part.row(y), &all.at(x0, y0 + y));
    CHECK(all.pixels == whole.pixels);
  }
}

TEST_CASE("tiles right of a caustic of ten million times the level around it do not see it") {
  const int width = 4 * TileGrid::kWidth, height = 3;
  PolygonList list;
  list.add(rectangle(-1, -1, static_cast<float>(width), 4), level(1.0F));
  LinearIrradiance bright = level(1e7F);
  bright.at = {300.0F, 1.0F};
  bright.along_x = {1e6F, -1e6F, 3e5F};
  list.add({{Point{297.3F, 0.1F}, Point{304.1F, 0.4F}, Point{301.7F, 2.9F}}}, bright);
  const Image image = test::drawn(list, width, height);
  for (int x = 310; x < width - 1; ++x)
    for (int c = 0; c < 3; ++c) CHECK(image.at(x, 1, c) == test::approx(1.0).epsilon(1e-6));
}

TEST_CASE("neighbours that share edges leave neither gaps nor doubled pixels, and no light is lost") {
  constexpr int kCells = 30;
  Fuzz fuzz(7);
  std::vector<Point> net;
  for (int y = 0; y <= kCells; ++y) {
    for (int x = 0; x <= kCells; ++x) {
      net.push_back(
          {static_cast<float>(10.37 * x - 4 + fuzz(-3, 3)), static_cast<float>(1.41 * y - 0.9 + fuzz(-0.3, 0.3))});
    }
  }
  PolygonList list;
  double area = 0.0;
  for (std::size_t y = 0; y < kCells; ++y) {
    for (std::size_t x = 0; x < kCells; ++x) {
      const std::size_t at = y * (kCells + 1) + x;
      for (const auto& t : {std::array{net[at], net[at + 1], net[at + kCells + 2]},
                            std::array{net[at], net[at + kCells + 2], net[at + kCells + 1]}}) {
        list.add(t, level(1.0F));
        area += std::abs(test::signed_area(t));
      }
    }
  }
  const Image inside = test::drawn(list, 290, 38);
  for (int y = 1; y < 38; ++y) {
    for (int x = 1; x < 290; ++x) CHECK(inside.at(x, y) == test::approx(1.0).epsilon(2e-6));
  }
  // Moved so that all of it lies on the frame.
  for (Point& p : list.corners) p = {p.x + 10.0F, p.y + 4.0F};
  CHECK(test::sum_of_channel(test::drawn(list, 330, 60), 2) == test::approx(area).epsilon(1e-5));
}

TEST_CASE("edges that neighbours share are drawn once, and nothing else changes") {
  const int width = 2 * TileGrid::kWidth + 30, height = 2 * TileGrid::kHeight + 7;
  constexpr int kCells = 12;
  Fuzz fuzz(11);
  // A mesh of quadrilaterals across tiles and the frame's borders, some of them folded, some of reverse orientation.
  std::vector<Point> net;
  for (int y = 0; y <= kCells; ++y) {
    for (int x = 0; x <= kCells; ++x)
      net.push_back({static_cast<float>(-20.0 + 1.1 * x * width / kCells + fuzz(-60, 60)),
                     static_cast<float>(-5.0 + 1.1 * y * height / kCells + fuzz(-4, 4))});
  }
  PolygonList list;
  for (std::size_t y = 0; y < kCells; ++y) {
    for (std::size_t x = 0; x < kCells; ++x) {
      const std::size_t at = y * (kCells + 1) + x;
      std::vector<Point> cell{net[at], net[at + 1], net[at + kCells + 2], net[at + kCells + 1]};
      if ((x + y) % 3 == 0) std::reverse(cell.begin(), cell.end());
      list.add(cell, fuzz.irradiance({cell[0].x, cell[0].y}));
    }
  }
  const Image apart = test::drawn(list, width, height);
  share_edges(list, width, height);
  const auto shared = std::count(list.neighbour.begin(), list.neighbour.end(), PolygonList::kSkipped);
  CHECK(shared > kCells * kCells / 3);
  CHECK(std::count(list.neighbour.begin(), list.neighbour.end(), PolygonList::kUnshared) > 4 * kCells);
  const Image together = test::drawn(list, width, height);
  double largest = 0.0, worst = 0.0;
  for (std::size_t k = 0; k < apart.pixels.size(); ++k) {
    largest = std::max(largest, std::abs(static_cast<double>(apart.pixels[k])));
    worst = std::max(worst, std::abs(static_cast<double>(apart.pixels[k]) - together.pixels[k]));
  }
  CHECK(worst < 1e-6 * largest);
}

TEST_CASE("a tile lists the polygons that touch it, in their order, and none that do not") {
  const TileGrid grid(3 * TileGrid::kWidth, 4 * TileGrid::kHeight);
  PolygonList list;
  list.add(rectangle(10, 10, 20, 12), level(1));      // tile (0, 0)
  list.add(rectangle(-9, -9, 3000, 3000), level(1));  // all
  list.add(rectangle(TileGrid::kWidth + 1, TileGrid::kHeight + 1, TileGrid::kWidth + 9, TileGrid::kHeight + 9),
           level(1));  // (1, 1)
  list.add(rectangle(3000, 10, 3100, 12), level(1));  // none
  const TileLists lists = tile_lists(list, grid);
  REQUIRE(lists.start.size() == grid.count() + 1);
  for (std::size_t t = 0; t < grid.count(); ++t) {
    const std::vector<std::uint32_t> found(lists.index.begin() + lists.start[t],
                                           lists.index.begin() + lists.start[t + 1]);
    const std::vector<std::uint32_t> expected = t == 0 ? std::vector<std::uint32_t>{0, 1}
                                                : t == static_cast<std::size_t>(grid.columns) + 1
                                                    ? std::vector<std::uint32_t>{1, 2}
                                                    : std::vector<std::uint32_t>{1};
    CHECK(found == expected);
  }
}
