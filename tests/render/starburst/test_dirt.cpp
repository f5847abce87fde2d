// SPDX-License-Identifier: Apache-2.0
// Dirt through a lens: the exit pupil against rays traced through it, its flux, frames of an animation, pictures.
#include <algorithm>
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/expert/ghost.h"
#include "contrejour/expert/lens_starburst.h"
#include "support/approx.h"
#include "support/flares.h"
#include "support/scenes.h"

using namespace contrejour;

namespace {

constexpr double kDegree_rad = 0.017453292519943295;

LensSettings with_dirt(DirtPlane plane) {
  LensSettings settings{.f_number = 8.0, .iris = {7, 0.1}};
  settings.dirt.dust_per_cm2 = 150.0;
  settings.dirt.dust_mm = 0.15;
  settings.dirt.scratches_per_cm2 = 20.0;
  settings.dirt.scratch_width_mm = 0.05;
  settings.dirt.plane = plane;
  settings.dirt.seed = 3;
  return settings;
}

// The transmittance of dirt for a ray at the point where it crosses the plane, from all strokes.
double asked(const std::vector<DirtStroke>& strokes, Vec2 point_mm) {
  double transmittance = 1.0;
  for (const DirtStroke& s : strokes)
    if (s.distance_mm(point_mm) < 0.0) transmittance *= 1.0 - s.opacity;
  return transmittance;
}

double nearest_edge(const std::vector<DirtStroke>& strokes, Vec2 point_mm) {
  double nearest = 1e9;
  for (const DirtStroke& s : strokes) nearest = std::min(nearest, std::abs(s.distance_mm(point_mm)));
  return nearest;
}

Image starburst(const LensState& lens, const Vec3 direction, int side, const Context& context = {}) {
  test::Settings settings;
  settings.wavelengths = 3;
  settings.frame = frame_on_sensor(lens, side, side);
  settings.selection = SelectList{};
  settings.starburst.on = true;
  Light light;
  light.direction = direction;
  return test::flare_of("adaptive", lens, std::span(&light, 1), settings, context).image;
}

double largest_difference(const Image& a, const Image& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.pixels.size(); ++k)
    largest = std::max(largest, std::abs(static_cast<double>(a.pixels[k]) - b.pixels[k]) /
                                    std::max<double>(std::max(a.pixels[k], b.pixels[k]), 1e-30));
  return largest;
}

}  // namespace

TEST_CASE("the exit pupil is dark where traced rays meet dirt, on the stop and on the front") {
  for (const DirtPlane plane : {DirtPlane::Stop, DirtPlane::Front}) {
    for (const double azimuth_deg : {0.0, 14.0}) {
      CAPTURE(azimuth_deg);
      const LensState lens = test::bundled("planar-50", with_dirt(plane));
      const Vec3 direction = direction_from_angles(azimuth_deg * kDegree_rad, 6.0 * kDegree_rad);
      const auto pupil = exit_pupil(lens, direction, lens.design_wavelength_nm);
      REQUIRE(pupil.has_value());
      REQUIRE(pupil->radius > 0.0);

      const auto strokes = dirt_within(lens.dirt, {-6.0, -12.0}, {14.0, 12.0});
      const OpticalPath path = direct_path(lens, lens.design_wavelength_nm);
      const EntranceWindow window = entrance_window(lens, direction);
      double all = 0.0, passed = 0.0;
      int wrong = 0, dark = 0;
      constexpr int kRays = 240;
      for (int y = 0; y < kRays; ++y) {
        for (int x = 0; x < kRays; ++x) {
          const Vec2 at{window.min_mm.x + (x + 0.5) / kRays * (window.max_mm.x - window.min_mm.x),
                        window.min_mm.y + (y + 0.5) / kRays * (window.max_mm.y - window.min_mm.y)};
          const TracedRay ray = trace(path, {{at.x, at.y, window.z_mm}, direction});
          if (ray.status != RayStatus::Ok || blocked_by(ray, path, lens.iris) > -0.02) continue;
          const Vec2 front = at + Vec2{direction.x, direction.y} * (-window.z_mm / direction.z);
          const Vec2 point = plane == DirtPlane::Front ? front : ray.stop[0] * lens.stop_radius_mm;
          const double transmittance = asked(strokes, point);
          all += ray.transmission;
          passed += ray.transmission * transmittance;
          if (nearest_edge(strokes, point) < 0.02) continue;  // a sample's diagonal
          const MaskGrid& grid = pupil->mask.grid;
          const Vec2 p = (Vec2{ray.direction.x, ray.direction.y} - pupil->middle) * (1.0 / grid.pitch_mm);
          const auto column = static_cast<std::size_t>(p.x + 0.5 * grid.side);
          const auto row = static_cast<std::size_t>(0.5 * grid.side - p.y);
          const bool lit = pupil->mask.amplitude[row * static_cast<std::size_t>(grid.side) + column] > 0.5F;
          wrong += lit != (transmittance > 0.5);
          dark += transmittance < 0.5;
        }
      }
      CHECK(dark > 20);
      CHECK(wrong == 0);
      CHECK(passed / all < 0.97);
      CHECK(pupil->open_fraction == test::approx(passed / all).epsilon(0.01));
      LensSettings clean_settings = with_dirt(plane);
      clean_settings.dirt = {};
      const LensState clean = test::bundled("planar-50", clean_settings);
      CHECK(pupil->flux_mm2 / pupil->open_fraction ==
            test::approx(exit_pupil(clean, direction, lens.design_wavelength_nm)->flux_mm2).epsilon(1e-9));
    }
  }
}

TEST_CASE("a dirty lens's starburst sums to what dirt lets through") {
  for (const DirtPlane plane : {DirtPlane::Stop, DirtPlane::Front}) {
    const LensState lens = test::bundled("planar-50", with_dirt(plane));
    const auto bands = spectral_bands(120, IlluminantD65{}, ColourSpace::Rec709);
    const auto pupil = exit_pupil(lens, Vec3{0.0, 0.0, 1.0}, lens.design_wavelength_nm);
    Image image(300, 300);  // of 1 mm pixels: the whole plane
    add_starburst(image, lens_starburst(lens, Vec3{0.0, 0.0, 1.0}, bands, {1.0, 210.0}).value(), {150.0, 150.0},
                  {1.0, 1.0, 1.0});
    CHECK(test::sum(image) / 3.0 == test::approx(pupil->open_fraction).epsilon(2e-3));
  }
}

TEST_CASE("frames follow one another smoothly, and a turn's end is its beginning [slow]") {
  LensSettings settings = with_dirt(DirtPlane::Front);
  const Vec3 direction = direction_from_angles(0.1, 0.05);
  const auto at = [&](double phase) {
    settings.dirt.phase = phase;
    return starburst(test::bundled("planar-50", settings), direction, 64);
  };
  const Image still = at(0.0);
  CHECK(at(1.0).pixels == still.pixels);
  // At any frame, half the step causes about half the change: nothing jumps.
  for (const double phase : {0.0, 0.37, 0.999}) {
    CAPTURE(phase);
    const Image here = at(phase);
    const double coarse = largest_difference(here, at(phase + 2e-4)), fine = largest_difference(here, at(phase + 1e-4));
    CHECK(coarse > 0.0);
    CHECK(fine < 0.05);
    CHECK(fine < 0.75 * coarse);
  }
  CHECK(largest_difference(still, at(0.3)) > 0.1);
}

TEST_CASE("a picture as dirt: black lets nothing through, white all, grey its transmittance; upright on the front") {
  const auto picture = [](std::vector<float> levels, int width, int height) {
    LensSettings settings{.f_number = 8.0};
    settings.dirt.picture = DirtPicture::from_levels(levels, width, height).value();
    settings.dirt.plane = DirtPlane::Front;
    return test::bundled("planar-50", settings);
  };
  const auto pupil_of = [](const LensState& lens) {
    return exit_pupil(lens, Vec3{0.0, 0.0, 1.0}, lens.design_wavelength_nm).value();
  };
  CHECK(pupil_of(picture({1.0F}, 1, 1)).open_fraction == test::approx(1.0));
  CHECK(pupil_of(picture(std::vector<float>(4, 0.25F), 2, 2)).open_fraction == test::approx(0.25));
  const LensState black = picture(std::vector<float>(4, 0.0F), 2, 2);
  CHECK(pupil_of(black).open_fraction == 0.0);
  CHECK(test::sum(starburst(black, {0.0, 0.0, 1.0}, 32)) == 0.0);
  // The upper half is dark: the remaining light passes the front's lower half.
  std::vector<float> half(64 * 64, 1.0F);
  std::fill(half.begin(), half.begin() + 32 * 64, 0.0F);
  const ExitPupil below = pupil_of(picture(half, 64, 64));
  CHECK(below.open_fraction == test::approx(0.5).epsilon(0.03));
  double top = 0.0, bottom = 0.0;
  const auto side = static_cast<std::size_t>(below.mask.grid.side);
  for (std::size_t k = 0; k < side * side; ++k) (k / side < side / 2 ? top : bottom) += below.mask.amplitude[k];
  // Cosines point to the image: the front's lower half sends its rays upwards.
  CHECK(std::min(top, bottom) < 0.1 * std::max(top, bottom));
  CHECK(top > bottom);
}

TEST_CASE("no dirt is no dirt, bit for bit; threads do not matter; too much of it leaves nothing but no error") {
  LensSettings settings{.f_number = 5.6, .iris = {6}};
  const Vec3 direction = direction_from_angles(0.2, 0.1);
  const Image clean = starburst(test::bundled("heliar", settings), direction, 48);
  settings.dirt.seed = 9;
  settings.dirt.phase = 0.3;
  settings.dirt.scratch_width_mm = 3.0;
  CHECK(starburst(test::bundled("heliar", settings), direction, 48).pixels == clean.pixels);
  settings.dirt.dust_per_cm2 = 40.0;
  const LensState dirty = test::bundled("heliar", settings);
  const Image one = starburst(dirty, direction, 48, {.threads = 1});
  CHECK(one.pixels == starburst(dirty, direction, 48, {.threads = 3}).pixels);
  CHECK(one.pixels != clean.pixels);
  settings.dirt.dust_per_cm2 = Dirt::kMaxDustPerCm2;
  settings.dirt.dust_mm = 10.0;
  const Image dark = starburst(test::bundled("heliar", settings), direction, 48);
  CHECK(std::all_of(dark.pixels.begin(), dark.pixels.end(), [](float v) { return std::isfinite(v); }));
  CHECK(test::sum(dark) < 1e-3);
}
