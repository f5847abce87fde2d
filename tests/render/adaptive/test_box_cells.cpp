// SPDX-License-Identifier: Apache-2.0
// What neighbouring cells share: corners, within a mesh and beyond, and planes of irradiance.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <doctest/doctest.h>

#include "render/adaptive/affine_ghost.h"
#include "render/adaptive/emit/shared_edges.h"
#include "render/adaptive/plain_image.h"
#include "render/adaptive/scene.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::adaptive;
using test::Affine, test::AffineGhost, test::frame_px, test::kHeight, test::kWidth, test::tessellated;

namespace {

Mesh mesh_of(const Patch& patch, const IrisShape& iris) {
  Mesh mesh;
  make_mesh(patch, iris, mesh);
  return mesh;
}

// The largest deviation from 1 of a picture of the ghost, within the ghost, when all its polygons have this irradiance.
double farthest_from_level(PolygonList list, double sag_px) {
  for (LinearIrradiance& irradiance : list.irradiances) irradiance = {irradiance.at, {1.0F, 1.0F, 1.0F}, {}, {}};
  const Image image = test::drawn(list, kWidth, kHeight);
  const int beside = static_cast<int>(std::abs(sag_px));
  double farthest = 0.0;
  for (int y = 100 - 40 + beside; y < 100 + 40 - beside; ++y)
    for (int x = 101; x < 220; ++x) farthest = std::max(farthest, std::abs(image.at(x, y, 1) - 1.0));
  return farthest;
}

AffineGhost curved_ghost(double sag_px) {
  AffineGhost ghost;
  ghost.nodes = 9;
  ghost.pixels = {{60.2, 0.0}, {0.0, 45.3}, {160.0, 100.0}};
  ghost.sag_px = sag_px;
  return ghost;
}

}  // namespace

TEST_CASE("cells of different sizes leave nothing between them, and overlap nowhere") {
  for (const double sag_px : {-6.0, 6.0, 6.5, 20.0}) {
    for (const double error : {0.03, 0.003, 3e-4}) {  // a single mesh, or several of different depth
      CAPTURE(sag_px);
      CAPTURE(error);
      const PolygonList list = tessellated(curved_ghost(sag_px), {}, error);
      const auto [min_count, largest] = std::ranges::minmax(list.polygons, {}, &Polygon::count);
      CHECK(largest.count > min_count.count);
      CHECK(farthest_from_level(list, sag_px) < 1e-5);
    }
  }
}

TEST_CASE("patches of one box leave nothing between them, whatever they count positions from") {
  constexpr double kSag_px = 20.0;
  const Patch whole = curved_ghost(kSag_px).patch();
  PolygonList list;
  const IrisShape iris{Iris{}};
  BoxCells room;
  Tessellator tessellator(iris, frame_px(), {3e-4, 1e-3}, 64.0, room, list);
  const MeshPosition position{0, 0};
  for (std::size_t q = 0; q < 4; ++q) {
    Patch part = quarter(whole, static_cast<int>(q % 2), static_cast<int>(q / 2));
    const Vec2 moved{90.0 * static_cast<double>(q), -105.0};
    part.origin_px = part.origin_px + moved;
    for (std::size_t k = 0; k < part.size(); ++k) {
      part.field(PatchLayout::kX)[k] -= static_cast<float>(moved.x);
      part.field(PatchLayout::kY)[k] -= static_cast<float>(moved.y);
    }
    if (q != 3) {
      tessellator.choose(part, position.quarter(q));
      continue;
    }
    for (std::size_t r = 0; r < 4; ++r)  // deeper than its neighbours
      tessellator.choose(quarter(part, static_cast<int>(r % 2), static_cast<int>(r / 2)),
                         position.quarter(q).quarter(r));
  }
  tessellator.emit();
  REQUIRE(list.polygons.size() > 20);
  CHECK(farthest_from_level(list, kSag_px) < 1e-5);
  // Every edge is also that of another polygon, in reverse, except those around the box.
  using Edge = std::array<float, 4>;
  std::set<Edge> edges;
  const auto for_each_edge = [&](const auto& visit) {
    for (const Polygon& p : list.polygons) {
      const auto corners = list.corners_of(p);
      for (std::size_t k = 0; k < corners.size(); ++k) visit(corners[k], corners[(k + 1) % corners.size()]);
    }
  };
  for_each_edge([&](Point a, Point b) { edges.insert(Edge{a.x, a.y, b.x, b.y}); });
  const Affine pixels = curved_ghost(kSag_px).pixels;
  for_each_edge([&](Point a, Point b) {
    if (edges.contains(Edge{b.x, b.y, a.x, a.y})) return;
    const double u = (0.5 * (a.x + b.x) - pixels.offset.x) / pixels.along_u.x;
    const double sag = kSag_px * std::pow(0.5 * (u + 1.0), 4);
    const double v = (0.5 * (a.y + b.y) - sag - pixels.offset.y) / pixels.along_v.y;
    CHECK(std::max(std::abs(u), std::abs(v)) > 0.97);
  });
}

TEST_CASE("even light is one plane, whatever cuts it: nothing is drawn between its cells") {
  AffineGhost ghost;
  ghost.nodes = 9;
  ghost.pixels = {{70.0, 11.0}, {-8.0, 55.0}, {160.0, 100.0}};
  ghost.stops = {{{1.3, 0.2}, {-0.1, 1.25}, {0.05, -0.03}}};
  PolygonList list = tessellated(ghost, {}, 1e-4);
  REQUIRE(list.polygons.size() >= 4);
  for (const Polygon& p : list.polygons) CHECK(list.irradiance_of(p) == list.irradiances.front());
  const Image before = test::drawn(list, kWidth, kHeight);
  share_edges(list, kWidth, kHeight);
  CHECK(std::ranges::count(list.neighbour, PolygonList::kSkipped) >= 8);
  for (const std::uint32_t neighbour : list.neighbour)
    CHECK((neighbour == PolygonList::kUnshared || neighbour == PolygonList::kSkipped));
  const Image after = test::drawn(list, kWidth, kHeight);
  double worst = 0.0;
  for (std::size_t k = 0; k < before.pixels.size(); ++k)
    worst = std::max(worst, std::abs(static_cast<double>(before.pixels[k]) - after.pixels[k]));
  CHECK(worst < 1e-5 * *std::ranges::max_element(before.pixels));
}

TEST_CASE("a plane has the light of what it is drawn for, and tells how far it is off") {
  const IrisShape iris(Iris{});
  AffineGhost ghost;
  ghost.nodes = 9;
  ghost.pixels = {{60.2, 7.0}, {-9.0, 45.3}, {160.0, 100.0}};
  for (const double sag_px : {0.0, 5.0}) {
    ghost.sag_px = sag_px;
    const Mesh mesh = mesh_of(ghost.patch(), iris);
    for (const int size : {8, 4, 2}) {
      for (int at = 0; at < Mesh::kCells; at += size) {
        const MeshSquare square{at, 0, size};
        const auto plane = LightSums(mesh, square, ~0U).plane(mesh, square);
        REQUIRE(plane.has_value());
        const double fraction = size * size / 64.0;
        CHECK(plane->irradiance.value[1] * plane->area_px == test::approx(ghost.flux * fraction).epsilon(1e-4));
        CHECK(plane->irradiance.value[0] == test::approx(2.0 * plane->irradiance.value[1]));
        // Compares with the irradiance at each vertex, at pixels.
        double worst = 0.0;
        for (int y = 0; y <= size; ++y) {
          for (int x = at; x <= at + size; ++x) {
            const std::size_t v = Mesh::at(x, y);
            const Vec2 p = mesh.position(v) + mesh.origin_px;
            const double there = plane->irradiance.value[1] +
                                 plane->irradiance.along_x[1] * (p.x - plane->irradiance.at.x) +
                                 plane->irradiance.along_y[1] * (p.y - plane->irradiance.at.y);
            worst = std::max(worst, std::abs(there / mesh.irradiance(0, v) - 1.0));
          }
        }
        const double predicted = std::sqrt(plane->squared_error / plane->area_px) / plane->mean;
        CHECK(worst < 6.0 * predicted + 1e-4);
        CHECK(worst >= predicted - 1e-4);
      }
    }
  }
  ghost.sag_px = 60.0;  // folds
  const Mesh folded = mesh_of(ghost.patch(), iris);
  const MeshSquare whole{0, 0, Mesh::kCells};
  CHECK_FALSE(LightSums(folded, whole, ~0U).plane(folded, whole).has_value());
}
