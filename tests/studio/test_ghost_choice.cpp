// SPDX-License-Identifier: Apache-2.0
// Which ghost a click selects, against pictures of each ghost alone; the order of the list.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/expert/requests.h"
#include "contrejour/expert/settings.h"
#include "contrejour/render.h"
#include "studio/core/document.h"
#include "studio/core/figures_job.h"
#include "studio/core/ghost_order.h"
#include "studio/core/ghosts_under.h"

namespace contrejour::studio {
namespace {

// Wide open, where most ghosts have caustics.
params::Values planar_values() {
  params::Values values;
  REQUIRE(values.set("size", "480x320"));
  REQUIRE(values.set("light-at", "0.3,0.28:1000"));
  REQUIRE(values.set("wavelengths", "1"));
  return values;
}

Image picture_of_ghost(const LensState& lens, params::Values values, const Ghost& ghost) {
  REQUIRE(values.set("select", "list:" + ghost_name(ghost)));
  const auto request = picture_request(values, lens);
  REQUIRE(request);
  auto flare = render("adaptive", lens, request->lights, request->settings);
  REQUIRE(flare);
  return std::move(flare->image);
}

float level_at(const Image& image, Vec2 p) {
  float sum = 0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x)
      sum += image.at(std::clamp(static_cast<int>(p.x) + x, 0, image.width - 1),
                      std::clamp(static_cast<int>(p.y) + y, 0, image.height - 1), 1);
  return sum / 9;
}

GhostFigures ghost_of(double flux, Vec2 centroid_px, Vec2 size_px, double peak) {
  GhostFigures figures;
  figures.relative_flux = flux;
  figures.centroid_px = centroid_px;
  figures.size_px = size_px;
  figures.peak_irradiance = peak;
  return figures;
}

}  // namespace

TEST_CASE("a click selects the ghost that is brightest there, by its picture alone") {
  const params::Values values = planar_values();
  const auto lens = std::make_shared<const LensState>(*params::lens_of(*find_lens("planar-50"), values));
  const auto light = light_of(values, *lens, 0);
  REQUIRE(light);
  const auto request = figures_request(values, *lens, &*light);
  REQUIRE(request);
  const auto figures = ghost_figures(*lens, *request, {});
  REQUIRE(figures);
  const auto footprints = footprints_of(*lens, *figures, *light, request->frame, {});
  std::map<std::size_t, Image> alone;
  int right = 0;
  const auto level = [&](std::size_t k, Vec2 p) {
    auto found = alone.find(k);
    if (found == alone.end()) found = alone.emplace(k, picture_of_ghost(*lens, values, (*figures)[k].ghost)).first;
    return level_at(found->second, p);
  };
  for (const Vec2 p : {Vec2{145, 90}, Vec2{240, 160}, Vec2{325, 225}, Vec2{100, 250}, Vec2{375, 75}, Vec2{175, 125}}) {
    const auto under = ghosts_under(*figures, p, footprints);
    REQUIRE_FALSE(under.empty());
    float brightest = 0;
    std::string which;
    for (std::size_t k = 0; k < std::min<std::size_t>(figures->size(), 40); ++k) {
      if (level(k, p) <= brightest) continue;
      brightest = level(k, p);
      which = ghost_name((*figures)[k].ghost);
    }
    INFO("at ", p.x, ", ", p.y, " ghost ", ghost_name((*figures)[under[0]].ghost), " has ", level(under[0], p), " of ",
         brightest, ", that of ", which);
    const bool is_right = level(under[0], p) > 0.5F * brightest;
    right += is_right ? 1 : 0;
  }
  CHECK(right >= 5);  // of six: the borders of footprints are known to a part of a cell
}

TEST_CASE("the outline of a ghost is closed, also where the rays beside it fail") {
  const Document document = first_document();
  const params::Values values = document.values();
  const LensState lens = *params::lens_of(*document.lens, values);
  const auto light = light_of(values, lens, 0);
  REQUIRE(light);
  const Frame frame = figures_request(values, lens, &*light)->frame;
  for (const Ghost ghost : {Ghost{12, 15}, Ghost{13, 15}, Ghost{14, 16}}) {
    const GhostFootprint footprint = footprint_of(lens, ghost, *light, frame);
    INFO(ghost_name(ghost));
    REQUIRE(footprint.border_px.size() > 20);
    std::vector<Vec2> ends;
    for (const auto& side : footprint.border_px) ends.insert(ends.end(), side.begin(), side.end());
    const auto meets = [&](Vec2 a) {
      return std::ranges::count_if(ends, [&](Vec2 b) { return std::hypot(a.x - b.x, a.y - b.y) < 0.01; }) >= 2;
    };
    CHECK(std::ranges::count_if(ends, [&](Vec2 end) { return !meets(end); }) == 0);
  }
}

TEST_CASE("a veil over the frame and a spot come after a disc that one sees first") {
  const std::vector<GhostFigures> figures = {
      ghost_of(0.0025, {300, 200}, {3000, 3000}, 1e-6), ghost_of(0.0004, {320, 180}, {200, 200}, 1e-5),
      ghost_of(0.00001, {100, 100}, {6, 6}, 0.8), ghost_of(0.0009, {-900, 180}, {200, 200}, 1e-5)};
  const Vec2 frame_px{640, 360};
  const auto order = [&](GhostOrder by) { return ghosts_in_order(figures, by, frame_px); };
  CHECK(order(GhostOrder::Visibility).front() == 1);
  CHECK(order(GhostOrder::Visibility).back() == 3);  // outside
  CHECK(order(GhostOrder::Flux) == std::vector<std::size_t>{0, 3, 1, 2});
  CHECK(order(GhostOrder::Peak).front() == 2);
}

}  // namespace contrejour::studio
