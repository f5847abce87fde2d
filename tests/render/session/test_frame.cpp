// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <doctest/doctest.h>

#include "support/approx.h"
#include "support/scenes.h"

using namespace contrejour;

TEST_CASE("the picture is upright: a light up and to the right lands up and to the right") {
  const LensState lens = test::bundled("heliar");
  const Frame frame = frame_on_sensor(lens, 300, 200);
  const Vec3 up_right = direction_from_angles(0.2, 0.1);
  CHECK(up_right.x < 0.0);  // it travels to the left, downwards and into the camera
  CHECK(up_right.y < 0.0);
  CHECK(up_right.z > 0.0);
  const Vec2 pixel = frame.pixel_from_sensor(chief_ray_image_point(lens, up_right, kLineD_nm));
  CHECK(pixel.x > 150.0);
  CHECK(pixel.y < 100.0);
  const LightAngles back = angles_from_direction(up_right);
  CHECK(back.azimuth_rad == test::approx(0.2));
  CHECK(back.elevation_rad == test::approx(0.1));
}

TEST_CASE("pixel and sensor coordinates are each other's inverse, in windows of the frame too") {
  const Frame whole{300, 200, 0, 0, 300, 200, 0.12};
  const Frame window{40, 30, 100, 50, 300, 200, 0.12};
  for (const Vec2 p : {Vec2{0, 0}, Vec2{17.25, 3.5}, Vec2{300, 200}}) {
    const Vec2 back = whole.pixel_from_sensor(whole.sensor_from_pixel(p));
    CHECK(back.x == test::approx(p.x));
    CHECK(back.y == test::approx(p.y));
    const Vec2 in_window = window.pixel_from_sensor(whole.sensor_from_pixel(p));
    CHECK(in_window.x == test::approx(p.x - 100));
    CHECK(in_window.y == test::approx(p.y - 50));
  }
  CHECK(whole.sensor_from_uv({0.5, 0.5}) == Vec2{0, 0});
  CHECK(whole.sensor_from_uv({0, 0}).x > 0.0);  // top left of the picture: right and up on the inverted sensor
  CHECK(whole.sensor_from_uv({0, 0}).y < 0.0);
}

TEST_CASE("a light requested at a point of the frame has its direct image on that very pixel") {
  for (const char* name : {"heliar", "canon-70-200", "angenieux-double-gauss"}) {
    CAPTURE(name);
    const LensState lens = test::bundled(name, {.f_number = 16.0});
    const Frame frame = frame_on_sensor(lens, 1920, 1080);
    for (const Vec2 uv : {Vec2{0.7, 0.33}, Vec2{0.25, 0.75}, Vec2{0.5, 0.5}}) {
      const Light light = test::light_at(lens, frame, uv);
      // The flux-weighted middle of the light's image at a small stop, by rays over the whole entrance.
      const OpticalPath path = direct_path(lens, lens.design_wavelength_nm);
      const EntranceWindow window = entrance_window(lens, light.direction);
      Vec2 total{};
      double weight = 0.0;
      for (int k = 0; k < 400 * 400; ++k) {
        const Vec2 p{std::lerp(window.min_mm.x, window.max_mm.x, (k % 400 + 0.5) / 400),
                     std::lerp(window.min_mm.y, window.max_mm.y, (k / 400 + 0.5) / 400)};
        const TracedRay ray = trace(path, {{p.x, p.y, window.z_mm}, light.direction});
        if (ray.status != RayStatus::Ok || blocked_by(ray, path, lens.iris) > 0.0) continue;
        total = total + frame.pixel_from_sensor(ray.sensor_mm) * ray.transmission;
        weight += ray.transmission;
      }
      REQUIRE(weight > 0.0);
      CHECK(std::abs(total.x / weight - uv.x * 1920) < 1.0);
      CHECK(std::abs(total.y / weight - uv.y * 1080) < 1.0);
    }
  }
}

TEST_CASE("a frame of other proportions than the sensor is cut from it") {
  LensState lens = test::plate();
  lens.sensor_width_mm = 36.0;
  lens.sensor_height_mm = 24.0;
  CHECK(frame_on_sensor(lens, 1920, 1080).pixel_pitch_mm == test::approx(36.0 / 1920));
  CHECK(frame_on_sensor(lens, 1080, 1920).pixel_pitch_mm == test::approx(24.0 / 1920));
}
