// SPDX-License-Identifier: Apache-2.0
// Distances against dense sampling, derivatives against central differences, means over pixels against quadrature.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/expert/ghost_outline.h"
#include "measure/model/outline_cubic.h"
#include "measure/random_ghosts.h"
#include "support/approx.h"

using namespace contrejour;
using contrejour::test::random_cut_outline;
using contrejour::test::random_outline;
using contrejour::test::random_shade;

namespace {

// The distance to the nearest of many points of the whole outline.
double sampled_distance(const GhostOutline& outline, Vec2 point) {
  constexpr int kPoints = 20000;
  double smallest = 1e30;
  for (const OutlineCubic& cubic : {left_cubic(outline), right_cubic(outline)}) {
    for (int k = 0; k <= kPoints; ++k) {
      const Vec2 at = cubic.at(static_cast<double>(k) / kPoints);
      smallest = std::min({smallest, length(at - point), length(Vec2{at.x, -at.y} - point)});
    }
  }
  return smallest;
}

// Whether a point is inside, by the winding of the outline's points about it.
bool is_inside(const GhostOutline& outline, Vec2 point) {
  constexpr int kPoints = 4000;
  std::vector<Vec2> all;
  for (const OutlineCubic& cubic : {left_cubic(outline), right_cubic(outline)}) {
    for (int k = 0; k < kPoints; ++k) all.push_back(cubic.at(static_cast<double>(k) / kPoints));
  }
  for (std::size_t k = all.size(); k > 0; --k) all.push_back({all[k - 1].x, -all[k - 1].y});
  double turns = 0.0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Vec2 a = all[k] - point, b = all[(k + 1) % all.size()] - point;
    turns += std::atan2(cross(a, b), dot(a, b));
  }
  return std::abs(turns) > 1.0;
}

Vec2 random_point(std::mt19937& random, const GhostOutline& outline) {
  std::uniform_real_distribution<double> unit(-1.6, 1.6);
  return {outline.centre + outline.right * unit(random), outline.half_height * unit(random)};
}

GhostOutline with(GhostOutline outline, std::size_t parameter, double by) {
  double* members[] = {&outline.centre,     &outline.left,        &outline.right,       &outline.half_height,
                       &outline.round_left, &outline.round_right, &outline.clip_centre, &outline.clip_radius};
  *members[parameter] += by;
  return outline;
}

GhostShade with(GhostShade shade, std::size_t parameter, double by) {
  double* members[] = {&shade.fade_in, &shade.fade_out, &shade.slope_in, &shade.slope_out};
  *members[parameter] += by;
  return shade;
}

// walch2018 figure 6, at a point.
ShadeWeights plain_weights(const GhostShade& shade, double distance) {
  if (distance >= 0.0) {
    return {distance < shade.fade_out ? std::pow(1.0 - distance / shade.fade_out, shade.slope_out) : 0.0, 0.0};
  }
  const double border = -distance < shade.fade_in ? std::pow(1.0 + distance / shade.fade_in, shade.slope_in) : 0.0;
  return {border, 1.0 - border};
}

}  // namespace

TEST_CASE("ghost outline: a circle's distances are those from a circle") {
  const GhostOutline circle{0.2, 0.1, 0.1, 0.1};
  for (int k = 0; k < 64; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / 64.0;
    for (const double radius : {0.02, 0.08, 0.1, 0.13, 0.4}) {
      const Vec2 point{0.2 + radius * std::cos(angle), radius * std::sin(angle)};
      CHECK(nearest_point(circle, point).distance == test::approx(radius - 0.1).epsilon(3e-4).scale(0.1));
    }
  }
}

TEST_CASE("ghost outline: distances agree with dense sampling, signs with winding numbers") {
  std::mt19937 random(3);
  for (int k = 0; k < 150; ++k) {
    const GhostOutline outline = random_outline(random);
    const Vec2 point = random_point(random, outline);
    const double distance = nearest_point(outline, point).distance;
    CHECK(std::abs(distance) == test::approx(sampled_distance(outline, point)).epsilon(1e-5).scale(0.1));
    if (std::abs(distance) > 1e-4) CHECK((distance < 0.0) == is_inside(outline, point));
  }
}

TEST_CASE("ghost outline: a circle that cuts leaves what lies within both, at the distance of the nearer border") {
  std::mt19937 random(8);
  int cut = 0, inside = 0;
  for (int k = 0; k < 300; ++k) {
    const GhostOutline outline = random_cut_outline(random);
    GhostOutline whole = outline;
    whole.clip_radius = 0.0;
    const Vec2 point = random_point(random, outline);
    const double of_circle = length(point - Vec2{outline.clip_centre, 0.0}) - outline.clip_radius;
    const double of_outline = nearest_point(whole, point).distance;
    const OutlinePoint nearest = nearest_point(outline, point);
    CHECK(nearest.distance == std::max(of_circle, of_outline));
    CHECK(nearest.is_on_clip == (of_circle > of_outline));
    CHECK(length(nearest.normal) == test::approx(1.0));
    cut += of_circle > of_outline ? 1 : 0;
    inside += nearest.distance < 0.0 ? 1 : 0;
  }
  CHECK(cut > 50);
  CHECK(inside > 20);
}

TEST_CASE("ghost outline: the distance's gradient agrees with central differences to 1e-5") {
  constexpr double kStep = 1e-6;
  std::mt19937 random(5);
  int compared = 0;
  for (int k = 0; k < 400; ++k) {
    const GhostOutline outline = k % 2 == 0 ? random_outline(random) : random_cut_outline(random);
    const Vec2 point = random_point(random, outline);
    const OutlinePoint nearest = nearest_point(outline, point);
    const auto gradient = distance_gradient(outline, nearest);
    for (std::size_t p = 0; p < kOutlineParameters; ++p) {
      const OutlinePoint more = nearest_point(with(outline, p, kStep), point);
      const OutlinePoint less = nearest_point(with(outline, p, -kStep), point);
      if (p >= kCubicParameters && outline.clip_radius == 0.0) continue;
      // Where the nearest point jumps, as it does on the medial axis, there is no derivative.
      if (more.is_on_clip != less.is_on_clip) continue;
      if (more.is_right != less.is_right || std::abs(more.t - less.t) > 1e-3) continue;
      const double difference = (more.distance - less.distance) / (2.0 * kStep);
      CHECK(gradient[p] == test::approx(difference).epsilon(1e-5).scale(1.0));
      ++compared;
    }
  }
  CHECK(compared > 2000);
}

TEST_CASE("ghost shade: a pixel's weights are means over its width") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.5, 1.5);
  for (int k = 0; k < 200; ++k) {
    const GhostShade shade = random_shade(random);
    const double distance = (unit(random) > 0.0 ? shade.fade_out : shade.fade_in) * unit(random);
    const double width = 0.003;
    constexpr int kPoints = 20000;
    double border = 0.0, inside = 0.0;
    for (int i = 0; i < kPoints; ++i) {
      const ShadeWeights at = plain_weights(shade, distance + width * ((i + 0.5) / kPoints - 0.5));
      border += at.border / kPoints;
      inside += at.inside / kPoints;
    }
    const ShadeWeights mean = shade_weights(shade, distance, width);
    CHECK(mean.border == test::approx(border).epsilon(2e-3).scale(0.1));
    CHECK(mean.inside == test::approx(inside).epsilon(2e-3).scale(0.1));
  }
}

TEST_CASE("ghost shade: derivatives agree with central differences to 1e-5") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1.4, 1.4);
  for (int k = 0; k < 300; ++k) {
    const GhostShade shade = random_shade(random);
    const double distance = (unit(random) > 0.0 ? shade.fade_out : shade.fade_in) * unit(random);
    const double width = 0.004, step = 1e-7;
    const ShadeDerivatives d = shade_derivatives(shade, distance, width);
    const auto compare = [&](const ShadeWeights& more, const ShadeWeights& less, const ShadeWeights& derivative) {
      const double scale = 1.0 / width;
      CHECK(derivative.border == test::approx((more.border - less.border) / (2.0 * step)).epsilon(1e-5).scale(scale));
      CHECK(derivative.inside == test::approx((more.inside - less.inside) / (2.0 * step)).epsilon(1e-5).scale(scale));
    };
    compare(shade_weights(shade, distance + step, width), shade_weights(shade, distance - step, width), d.by_distance);
    for (std::size_t p = 0; p < 4; ++p) {
      compare(shade_weights(with(shade, p, step), distance, width),
              shade_weights(with(shade, p, -step), distance, width), d.by_shade[p]);
    }
  }
}

TEST_CASE("ghost shade: a sharp border covers pixels by half where it crosses their middle") {
  const GhostShade sharp{0.0, 0.0, 1.0, 1.0};
  const ShadeWeights middle = shade_weights(sharp, 0.0, 0.01);
  CHECK(middle.inside == test::approx(0.5));
  CHECK(middle.border == test::approx(0.0));
  CHECK(shade_weights(sharp, -0.01, 0.01).inside == test::approx(1.0));
  CHECK(shade_weights(sharp, 0.01, 0.01).inside == test::approx(0.0));
}
