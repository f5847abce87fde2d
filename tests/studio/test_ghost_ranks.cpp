// SPDX-License-Identifier: Apache-2.0
// Which ghosts drafts draw while a light is dragged away from where its ghosts were measured.
#include <array>
#include <chrono>
#include <map>
#include <thread>

#include <doctest/doctest.h>

#include "contrejour/expert/requests.h"
#include "studio/core/ghost_ranks.h"
#include "studio/core/lights.h"
#include "studio/core/studio.h"
#include "studio/studio_scene.h"
#include "support/approx.h"

namespace contrejour::studio {
namespace {

void run_until_ranked(Studio& studio) {
  using namespace std::chrono_literals;
  const auto start = std::chrono::steady_clock::now();
  while (!studio.has_ranks() && std::chrono::steady_clock::now() - start < 60s) {
    studio.update();
    std::this_thread::sleep_for(2ms);
  }
}

// By ghost, of the document's light, its light within the frame.
std::map<Ghost, double> light_of_ghosts(const Studio& studio) {
  const auto request = figures_request(studio.document().values(), studio.lens());
  REQUIRE(request);
  const auto figures = ghost_figures(studio.lens(), *request, {});
  REQUIRE(figures);
  std::map<Ghost, double> light;
  for (const GhostFigures& f : *figures) light[f.ghost] = light_in_frame(f, studio.frame_px());
  return light;
}

double light_of_first(const std::vector<Ghost>& ghosts, std::size_t count, const std::map<Ghost, double>& light) {
  double sum = 0;
  for (std::size_t k = 0; k < std::min(count, ghosts.size()); ++k) sum += light.at(ghosts[k]);
  return sum;
}

}  // namespace

TEST_CASE("the brightest ghosts are those between the two radii next to a light's") {
  const Ghost a{1, 2}, b{1, 3}, c{2, 3};
  const GhostRanks ranks = {{0.2, 0.6, 1.0}, {a, b, c}, {{9, 4, 1}, {5, 6, 1}, {0, 1, 8}}};
  const auto at = [&](double radius) { return brightest_at(ranks, std::array{radius}); };
  CHECK(at(0.0) == std::vector<Ghost>{a, b, c});
  CHECK(at(0.4) == std::vector<Ghost>{a, b, c});  // 7, 5, 1
  CHECK(at(0.6) == std::vector<Ghost>{b, a, c});
  CHECK(at(0.8) == std::vector<Ghost>{c, b, a});  // 2.5, 3.5, 4.5
  CHECK(at(7.0) == std::vector<Ghost>{c, b, a});
  CHECK(brightest_at(ranks, std::array{0.2, 1.0}) == std::vector<Ghost>{a, c, b});  // 9, 5, 9
  CHECK(brightest_at({}, std::array{0.5}).empty());
  CHECK(radius_of({0.5, 0.5}, {160, 90}) == 0);
  CHECK(radius_of({0, 1}, {160, 90}) == test::approx(1.0));
  CHECK(radius_of({1, 0.5}, {160, 90}) == test::approx(160 / std::hypot(160.0, 90.0)));
}

TEST_CASE("a late draft of a light that is dragged far away has the ghosts that are bright there [slow]") {
  Document d = *with_light_at(*with_value(small_scene(), "wavelengths", "3"), 0, {0.5, 0.45});
  d = *document_with_lens(d, "nikon-80-200");
  Studio studio("first", *with_value(d, "fnumber", "8"), {});
  run_until_ranked(studio);
  REQUIRE(studio.has_ranks());
  for (const Vec2 to : {Vec2{0.9, 0.8}, Vec2{0.25, 0.2}, Vec2{-0.1, 0.5}}) {
    studio.edit("move", "drag", [&](const Document& before) { return with_light_at(before, 0, to); });
    const auto light = light_of_ghosts(studio);
    std::vector<Ghost> best;
    for (const auto& [ghost, flux] : light) best.push_back(ghost);
    std::ranges::stable_sort(best, [&](const Ghost& a, const Ghost& b) { return light.at(a) > light.at(b); });
    const auto drawn = studio.brightest_ghosts();
    CHECK(drawn.size() == best.size());
    INFO("to ", to.x, ", ", to.y);
    CHECK(light_of_first(drawn, 8, light) > 0.8 * light_of_first(best, 8, light));
    CHECK(std::find(drawn.begin(), drawn.begin() + 8, best[0]) != drawn.begin() + 8);
  }
}

}  // namespace contrejour::studio
