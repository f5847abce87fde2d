// SPDX-License-Identifier: Apache-2.0
// Starbursts and glare as `render` draws them: flux, scale, directions, and a vignetted pupil against plain sums over
// densely traced rays.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <complex>
#include <vector>

#include <doctest/doctest.h>

#include "base/scalar.h"
#include "contrejour/expert/first_order.h"
#include "contrejour/expert/lens_starburst.h"
#include "support/approx.h"
#include "support/flares.h"
#include "support/pictures.h"
#include "support/scenes.h"

using namespace contrejour;

namespace {

// No ghosts, so that the picture is the starburst alone.
test::Settings starburst_alone(const Frame& frame) {
  test::Settings settings;
  settings.wavelengths = 3;
  settings.frame = frame;
  settings.selection = SelectList{};
  settings.starburst.on = true;
  return settings;
}

Image drawn(const LensState& lens, std::span<const Light> lights, const test::Settings& settings,
            const Context& context = {}) {
  return test::flare_of("bundle", lens, lights, settings, context).image;
}

Image drawn(const LensState& lens, const Light& light, const test::Settings& settings) {
  return drawn(lens, std::span(&light, 1), settings);
}

double flux_of(const Image& image, std::size_t channel) {
  double sum = 0.0;
  for (std::size_t k = channel; k < image.pixels.size(); k += 3) sum += image.pixels[k];
  return sum;
}

// A square frame about a point of the sensor.
Frame window_about(Vec2 sensor_mm, int side, double pitch_mm) {
  Frame frame;
  frame.width = frame.height = side;
  frame.full_width = frame.full_height = 1000000;
  frame.pixel_pitch_mm = pitch_mm;
  const Vec2 centre = frame.pixel_from_sensor(sensor_mm);
  frame.origin_x = static_cast<int>(std::floor(centre.x)) - side / 2;
  frame.origin_y = static_cast<int>(std::floor(centre.y)) - side / 2;
  return frame;
}

// The green channel by distance from the middle of a frame of even side, in bins a pixel wide.
std::vector<double> radial_profile(const Image& image) {
  std::vector<double> sum(static_cast<std::size_t>(image.width)), count(sum.size());
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto bin = static_cast<std::size_t>(std::hypot(x + 0.5 - 0.5 * image.width, y + 0.5 - 0.5 * image.height));
      sum[bin] += image.at(x, y, 1);
      count[bin] += 1.0;
    }
  }
  for (std::size_t k = 0; k < sum.size(); ++k) sum[k] = count[k] > 0.0 ? sum[k] / count[k] : 0.0;
  return sum;
}

// Radius of the first dark ring, pixels, by a parabola through the darkest bin and its neighbours.
double first_zero(const Image& image) {
  const std::vector<double> profile = radial_profile(image);
  std::size_t k = 1;
  while (!(profile[k] <= profile[k - 1] && profile[k] < profile[k + 1])) ++k;
  const double a = profile[k - 1], b = profile[k], c = profile[k + 1];
  return static_cast<double>(k) + 0.5 + 0.5 * (a - c) / (a - 2.0 * b + c);
}

}  // namespace

TEST_CASE("a light's starburst sums to its value, less what falls outside the frame") {
  for (const double f_number : {8.0, 16.0}) {
    const LensState lens = test::bundled("heliar", {.f_number = f_number, .iris = {6, 0.1}});
    const test::Settings settings = starburst_alone(frame_on_sensor(lens, 500, 500));
    Light light;
    light.value = {300.0, 20.0, 1.0};
    const Image image = drawn(lens, light, settings);
    const IrisOpening opening(lens.iris);
    const double rho = 250.0 * settings.frame.pixel_pitch_mm / (550e-6 * f_number) * kPi / std::sqrt(8.0);
    const double outside = opening.perimeter() / opening.area() / (kPi * kPi * rho);
    for (std::size_t c = 0; c < 3; ++c)
      CHECK(flux_of(image, c) / light.value[c] + outside == test::approx(1.0).epsilon(1e-3));
  }
}

TEST_CASE("through a real lens the first dark ring lies 1.22 lambda N out, and half as far at half the f-number") {
  const double pitch_mm = 4e-4;
  std::vector<double> zero;
  for (const double f_number : {16.0, 8.0}) {
    const LensState lens = test::bundled("heliar", {.f_number = f_number});
    test::Settings settings = starburst_alone(window_about({}, 128, pitch_mm));
    settings.lambda_nm = {550.0};
    const FirstOrder first = first_order(lens, 550.0);
    zero.push_back(first_zero(drawn(lens, Light{}, settings)));
    CHECK(zero.back() * pitch_mm / (1.2197 * 550e-6 * first.f_number) == test::approx(1.0).epsilon(0.02));
  }
  CHECK(zero[0] / zero[1] == test::approx(2.0).epsilon(0.02));
}

// An opening of outer radius 1 and inner radius e is dark where J1(x) = e J1(e x) (Born and Wolf, Principles of Optics,
// 8.6.2).
TEST_CASE("a stop with a dark middle has narrower rings, and the flux that is left") {
  constexpr double kObscured = 0.5, kPitch_mm = 4e-4;
  double low = 2.5, high = 3.8317;
  for (int k = 0; k < 60; ++k) {
    const double x = 0.5 * (low + high);
    (std::cyl_bessel_j(1.0, x) > kObscured * std::cyl_bessel_j(1.0, kObscured * x) ? low : high) = x;
  }
  LensState lens = test::bundled("heliar", {.f_number = 16.0});
  lens.surfaces[static_cast<std::size_t>(lens.stop_index)].obscuration = {
      {kObscured * lens.stop_radius_mm, kObscured * lens.stop_radius_mm}, {}, 0.0};
  test::Settings settings = starburst_alone(window_about({}, 128, kPitch_mm));
  settings.lambda_nm = {550.0};
  const Image image = drawn(lens, Light{}, settings);
  const double expected_mm = low / kPi * 550e-6 * first_order(lens, 550.0).f_number;
  CHECK(first_zero(image) * kPitch_mm / expected_mm == test::approx(1.0).epsilon(0.02));

  test::Settings whole = starburst_alone(frame_on_sensor(lens, 500, 500));
  whole.lambda_nm = {550.0};
  const double rho = 250.0 * whole.frame.pixel_pitch_mm / (550e-6 * 16.0) * kPi / std::sqrt(8.0);
  const double outside = 2.0 / (1.0 - kObscured) / (kPi * kPi * rho);  // perimeter over area
  const Image far = drawn(lens, Light{}, whole);
  CHECK(flux_of(far, 1) + outside == test::approx(1.0).epsilon(2e-3));
  // Far out (2 J1(x) / x)^2 is 4 / (pi x^3) in the mean; those of both edges are added, as their fringes are too fine
  // to be resolved.
  const double lambda_n = 550e-6 * first_order(lens, 550.0).f_number, open = 1.0 - kObscured * kObscured;
  const std::vector<double> far_profile = radial_profile(far);
  for (const std::size_t bin : {60, 120, 200}) {
    const double r_mm = (static_cast<double>(bin) + 0.5) * whole.frame.pixel_pitch_mm, x = kPi * r_mm / lambda_n;
    const double level =
        0.25 * kPi * open / (lambda_n * lambda_n) * 4.0 / (kPi * x * x * x) * (1.0 + kObscured) / (open * open);
    CHECK(far_profile[bin] / (level * whole.frame.pixel_pitch_mm * whole.frame.pixel_pitch_mm) ==
          test::approx(1.0).epsilon(0.03));
  }

  const std::vector<double> profile = radial_profile(image);
  const auto at = [&](double x) { return profile[static_cast<std::size_t>(x / low * first_zero(image))]; };
  const auto closed = [&](double x) {
    const double a = (2.0 * std::cyl_bessel_j(1.0, x) / x -
                      kObscured * kObscured * 2.0 * std::cyl_bessel_j(1.0, kObscured * x) / (kObscured * x)) /
                     (1.0 - kObscured * kObscured);
    return a * a;
  };
  const double ring = 4.9;
  CHECK(at(ring) / profile[0] == test::approx(closed(ring)).epsilon(0.08));
}

// Two slits whose wave amplitudes are 1 and a beat with the contrast 2 a / (1 + a^2) (Young; Born & Wolf 7.3.1).
TEST_CASE("half-tones of an iris's picture dim the wave: fringes of a bright and a grey slit") {
  const auto is_slit = [](Vec2 p, double x) { return std::abs(p.x - x) < 0.06 && std::abs(p.y) < 0.5; };
  for (const double grey : {1.0, 0.36, 0.16}) {
    CAPTURE(grey);
    LensSettings chosen{.f_number = 16.0};
    chosen.iris.field = test::drawn_field(256, [&](Vec2 p) {
      return is_slit(p, 0.5) ? 1.0 : is_slit(p, -0.5) ? grey : 0.0;
    });
    REQUIRE(chosen.iris.field->has_half_tones() == (grey < 1.0));
    const LensState lens = test::bundled("heliar", chosen);
    // They are a stop radius apart: fringes 2 lambda N wide, of 20 pixels.
    const double period_mm = 2.0 * 550e-6 * 16.0;
    test::Settings settings = starburst_alone({201, 1, 0, 0, 201, 1, period_mm / 20.0});
    settings.lambda_nm = {550.0};
    const Image image = drawn(lens, Light{}, settings);
    const double bright = image.at(100, 0, 1), dark = 0.5 * (image.at(90, 0, 1) + image.at(110, 0, 1));
    const double amplitude = std::sqrt(grey);
    CHECK((bright - dark) / (bright + dark) == test::approx(2.0 * amplitude / (1.0 + grey)).epsilon(0.02));
  }
}

TEST_CASE("curved blades' fans follow one another without dark lines, the middle and the flux stay an exact iris's") {
  test::Settings settings;
  const auto image_of = [&](double slope_spread) {
    Iris iris{9, 0.0, 0.5};
    iris.slope_spread = slope_spread;
    const LensState lens = test::bundled("heliar", {.f_number = 8.0, .iris = iris});
    settings = starburst_alone(frame_on_sensor(lens, 600, 600));
    return drawn(lens, Light{}, settings);
  };
  const Image usual = image_of(Iris{}.slope_spread), exact = image_of(0.0);
  // The darkest direction over the mean of all, summed over rings of some pixels.
  const auto darkest = [](const Image& image) {
    constexpr int kDirections = 720;
    std::vector<double> sum(kDirections, 0.0);
    double mean = 0.0;
    for (int k = 0; k < kDirections; ++k) {
      const double angle = 2.0 * kPi * k / kDirections;
      for (double r = 200.0; r < 280.0; r += 2.0)
        sum[static_cast<std::size_t>(k)] +=
            r * r * r *
            image.at(static_cast<int>(300.0 + r * std::cos(angle)), static_cast<int>(300.0 - r * std::sin(angle)), 1);
      mean += sum[static_cast<std::size_t>(k)] / kDirections;
    }
    return *std::min_element(sum.begin(), sum.end()) / mean;
  };
  CHECK(darkest(exact) < 0.6);
  CHECK(darkest(usual) > 0.75);
  for (std::size_t c = 0; c < 3; ++c) CHECK(flux_of(usual, c) / flux_of(exact, c) == test::approx(1.0).epsilon(1e-3));
  for (int y = 296; y < 304; ++y)
    for (int x = 296; x < 304; ++x) CHECK(usual.at(x, y, 1) == test::approx(exact.at(x, y, 1)).epsilon(0.02));
}

TEST_CASE("upright: spikes stand across the blades' edges as the photographer sees the iris") {
  for (const int blades : {5, 6}) {
    const double rotation = 0.23;
    const LensState lens = test::bundled("heliar", {.f_number = 16.0, .iris = {blades, rotation}});
    const Image image = drawn(lens, Light{}, starburst_alone(frame_on_sensor(lens, 600, 600)));
    const int expected = blades % 2 == 0 ? blades : 2 * blades;
    const auto at = [&](double angle) {
      double sum = 0.0;
      for (double r = 120.0; r < 140.0; r += 0.5)
        sum +=
            image.at(static_cast<int>(300.0 + r * std::cos(angle)), static_cast<int>(300.0 - r * std::sin(angle)), 1);
      return sum;
    };
    for (int k = 0; k < expected; ++k) {
      const double spike = rotation + kPi / blades + 2.0 * kPi * k / expected;
      CHECK(at(spike) > 10.0 * at(spike + kPi / expected));
      CHECK(at(spike) > 3.0 * at(spike + 0.05));
      CHECK(at(spike) > 3.0 * at(spike - 0.05));
    }
  }
}

TEST_CASE("a quarter-size render is the full one filtered") {
  const LensState lens =
      test::bundled("canon-70-200", {.focal_length_mm = 135.0, .f_number = 11.0, .iris = {8, 0.1, 0.2}});
  const Frame full = frame_on_sensor(lens, 960, 640), quarter = frame_on_sensor(lens, 240, 160);
  const Light light = test::light_at(lens, full, {0.71, 0.33});
  const Image fine = drawn(lens, light, starburst_alone(full)), coarse = drawn(lens, light, starburst_alone(quarter));
  double error = 0.0, total = 0.0;
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 240; ++x) {
      double sum = 0.0;
      for (int i = 0; i < 16; ++i) sum += fine.at(4 * x + i % 4, 4 * y + i / 4, 1);
      error += std::abs(coarse.at(x, y, 1) - sum);
      total += sum;
    }
  }
  CHECK(error / total < 0.02);
}

TEST_CASE(
    "off the axis the pupil is vignetted and askew, and so is the pattern: sums over densely traced rays [slow]") {
  struct Case {
    const char* name;
    LensSettings settings;
    double azimuth_rad, elevation_rad;
  };
  for (const Case& c : {Case{"canon-70-200", {.focal_length_mm = 135.0, .f_number = 2.8, .iris = {5, 0.3}}, 0.1, 0.04},
                        Case{"heliar", {.f_number = 4.5}, 0.3, -0.1}}) {
    CAPTURE(c.name);
    const LensState lens = test::bundled(c.name, c.settings);
    Light light;
    light.direction = direction_from_angles(c.azimuth_rad, c.elevation_rad);
    const double lambda_mm = 587.6e-6, pitch_mm = 3e-4;
    const Vec2 image_point = chief_ray_image_point(lens, light.direction, lens.design_wavelength_nm);
    test::Settings settings = starburst_alone(window_about(image_point, 48, pitch_mm));
    settings.lambda_nm = {587.6};
    const Image image = drawn(lens, light, settings);
    const Vec2 centre = settings.frame.pixel_from_sensor(image_point);

    std::vector<Vec2> cosines;
    std::vector<double> amplitude;
    const OpticalPath path = direct_path(lens, 587.6);
    const EntranceWindow window = entrance_window(lens, light.direction);
    const Vec2 size = window.max_mm - window.min_mm;
    for (int k = 0; k < 400 * 400; ++k) {
      const Vec2 at{window.min_mm.x + (k % 400 + 0.5) / 400 * size.x, window.min_mm.y + (k / 400 + 0.5) / 400 * size.y};
      const TracedRay ray = trace(path, {{at.x, at.y, window.z_mm}, light.direction});
      if (ray.status != RayStatus::Ok || blocked_by(ray, path, lens.iris) > 0.0) continue;
      cosines.push_back({ray.direction.x, ray.direction.y});
      amplitude.push_back(std::sqrt(ray.transmission));  // by the sine condition cosines are as uniform as the entrance
    }
    REQUIRE(cosines.size() > 1000);
    const auto power_at = [&](Vec2 sensor_mm) {
      std::complex<double> wave;
      for (std::size_t k = 0; k < cosines.size(); ++k)
        wave += std::polar(amplitude[k], 2.0 * kPi * dot(cosines[k], sensor_mm) / lambda_mm);
      return std::norm(wave);
    };
    const double peak = power_at({});
    double drawn_peak = 0.0;
    for (const float v : image.pixels) drawn_peak = std::max(drawn_peak, static_cast<double>(v));
    double worst = 0.0, xx = 0.0, yy = 0.0, all = 0.0;
    for (int y = 0; y < 48; y += 3) {
      for (int x = 0; x < 48; x += 3) {
        // Image right is the sensor's -x, image down its +y.
        const Vec2 offset{-(x + 0.5 - centre.x) * pitch_mm, (y + 0.5 - centre.y) * pitch_mm};
        const double truth = power_at(offset) / peak;
        worst = std::max(worst, std::abs(image.at(x, y, 1) / drawn_peak - truth));
        xx += truth * offset.x * offset.x;
        yy += truth * offset.y * offset.y;
        all += truth;
      }
    }
    CHECK(worst < 0.05);
    CHECK(std::abs(xx / yy - 1.0) > 0.1);  // else nothing would be tested
  }
}

TEST_CASE("off: not one bit changes, whatever else is set; on: the sum of both, with every method [slow]") {
  const LensState lens = test::bundled("heliar", {.f_number = 11.0, .iris = {7, 0.1}});
  test::Settings off;
  off.frame = frame_on_sensor(lens, 48, 32);
  off.set_grid(48);
  off.wavelengths = 1;
  off.reference.density = 0.2;
  const Light light = test::light_at(lens, off.frame, {0.7, 0.33});
  test::Settings unused = off;
  unused.starburst.gain = 5.0;
  unused.glare.width_rad = 0.3;
  test::Settings on = off;
  on.starburst.on = true;
  const Image alone = drawn(lens, light, starburst_alone(off.frame));
  for (const std::string_view method : render_methods()) {
    const Image ghosts = test::flare_of(method, lens, {&light, 1}, off).image;
    CHECK(ghosts.pixels == test::flare_of(method, lens, {&light, 1}, unused).image.pixels);
    const Flare both = test::flare_of(method, lens, {&light, 1}, on);
    for (std::size_t k = 0; k < ghosts.pixels.size(); ++k)
      CHECK(std::abs(both.image.pixels[k] - ghosts.pixels[k] - alone.pixels[k]) <=
            2e-7F * both.image.pixels[k] + 1e-12F);
    const auto& times = both.statistics.time_ms;
    CHECK(std::any_of(times.begin(), times.end(), [](const auto& phase) { return phase.first == "starburst"; }));
    CHECK(times.back().first == "total");
  }
}

TEST_CASE("the same bits for any number of threads; many lights share starbursts and keep their flux") {
  const LensState lens = test::bundled("heliar", {.f_number = 11.0, .iris = {7, 0.1}});
  const test::Settings settings = starburst_alone(frame_on_sensor(lens, 120, 80));
  std::vector<Light> lights;
  for (int k = 0; k < 35; ++k) {  // in a few of the cells that many lights share
    lights.push_back(test::light_at(lens, settings.frame, {0.4 + 0.03 * (k % 7), 0.5 + 0.05 * (k / 7)}));
    lights.back().value = {1.0 + k, 1.0, 2.0};
  }
  const Image one = drawn(lens, lights, settings, {.threads = 1});
  CHECK(one.pixels == drawn(lens, lights, settings, {.threads = 7}).pixels);
  Image apart(120, 80);
  for (const Light& light : lights) {
    const Image own = drawn(lens, light, settings);
    for (std::size_t k = 0; k < own.pixels.size(); ++k) apart.pixels[k] += own.pixels[k];
  }
  for (std::size_t c = 0; c < 3; ++c) CHECK(flux_of(one, c) / flux_of(apart, c) == test::approx(1.0).epsilon(2e-3));
  double error = 0.0;
  for (std::size_t k = 0; k < one.pixels.size(); ++k) error += std::abs(one.pixels[k] - apart.pixels[k]);
  CHECK(error / test::sum(apart) < 0.02);

  std::atomic<bool> stop = false;
  Context context{.threads = 2, .cancel = &stop};
  context.progress = [&](double done) { stop = done > 0.95; };
  const auto stopped = render("bundle", lens, lights, settings, context);
  REQUIRE_FALSE(stopped.has_value());
  CHECK(stopped.error().code == ErrorCode::Cancelled);
}

TEST_CASE("a light that leaves the frame, and then the lens, takes its starburst along without a jump") {
  const LensState lens = test::bundled("heliar", {.f_number = 8.0});
  const test::Settings settings = starburst_alone(frame_on_sensor(lens, 90, 60));
  const auto beside_centre = [&](double u) {
    return drawn(lens, test::light_at(lens, settings.frame, {u, 0.5}), settings).at(80, 33, 1);
  };
  CHECK(beside_centre(1.0001) / beside_centre(0.9999) == test::approx(1.0).epsilon(0.01));
  Light beside;
  beside.direction = direction_from_angles(1.5, 0.2);
  CHECK(test::sum(drawn(lens, beside, settings)) == 0.0);
}

TEST_CASE("frames of one pixel, pixels of a nanometre and of a metre: finite, and refused settings are named") {
  const LensState lens = test::bundled("heliar", {.f_number = 8.0, .iris = {6}});
  for (const double pitch_mm : {1e-6, 1e-2, 1e3}) {
    for (const int side : {1, 7}) {
      test::Settings settings = starburst_alone({side, side, 0, 0, side, side, pitch_mm});
      settings.glare.fraction = 0.1;
      const Image image = drawn(lens, Light{}, settings);
      if (pitch_mm > 1.0) CHECK(flux_of(image, 1) == test::approx(1.0).epsilon(2e-3));
    }
  }
  const auto refused = [&](auto spoil) {
    test::Settings settings = starburst_alone(frame_on_sensor(lens, 8, 8));
    spoil(settings);
    const Light light;
    const auto flare = render("bundle", lens, {&light, 1}, settings);
    return !flare && flare.error().code == ErrorCode::InvalidArgument;
  };
  CHECK_FALSE(refused([](auto&) {}));
  CHECK(refused([](auto& s) { s.starburst.gain = -1.0; }));
  CHECK(refused([](auto& s) { s.starburst.gain = std::nan(""); }));
  CHECK(refused([](auto& s) { s.glare.fraction = 1.5; }));
  CHECK(refused([](auto& s) { s.glare.fraction = std::nan(""); }));
  CHECK(refused([](auto& s) { s.glare.width_rad = 0.0; }));
  CHECK(refused([](auto& s) { s.lambda_nm = {0.0}; }));
  CHECK(refused([](auto& s) { s.starburst.left_out = std::make_shared<const Image>(4, 8, 1); }));
}

TEST_CASE("what is left out is left out, and no more") {
  const LensState lens = test::bundled("heliar", {.f_number = 11.0, .iris = {6}});
  test::Settings settings = starburst_alone(frame_on_sensor(lens, 60, 40));
  const Light light = test::light_at(lens, settings.frame, {0.5, 0.5});
  const Image whole = drawn(lens, light, settings);
  auto left_out = std::make_shared<Image>(60, 40, 1);
  left_out->at(30, 20) = 1.0F;
  left_out->at(12, 9) = 0.25F;
  settings.starburst.left_out = left_out;
  const Image part = drawn(lens, light, settings);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 60; ++x)
      CHECK(part.at(x, y, 1) == test::approx((1.0F - left_out->at(x, y)) * whole.at(x, y, 1)).epsilon(1e-6));
  CHECK(part.at(30, 20, 1) == 0.0F);
}

TEST_CASE(
    "what glare scatters is missing from the starburst: together they sum to the light's value, less what dirt "
    "blocks") {
  LensSettings chosen{.f_number = 11.0, .iris = {6, 0.1}};
  for (const bool dirty : {false, true}) {
    if (dirty) {
      chosen.dirt.dust_per_cm2 = 400.0;
      chosen.dirt.dust_mm = 0.2;
    }
    const LensState lens = test::bundled("planar-50", chosen);
    // Pixels of a metre: the whole plane is in one of them.
    test::Settings settings = starburst_alone({3, 3, 0, 0, 3, 3, 1e3});
    Light light;
    light.value = {300.0, 20.0, 1.0};
    const double open = exit_pupil(lens, light.source(), lens.design_wavelength_nm)->open_fraction;
    CHECK((open < 0.95) == dirty);
    for (const double radius_rad : {0.0, 0.01}) {
      light.radius_rad = radius_rad;
      for (const double fraction : {0.0, 0.1, 0.6, 1.0}) {
        settings.glare.fraction = fraction;
        const Image image = drawn(lens, light, settings);
        for (std::size_t c = 0; c < 3; ++c)
          CHECK(flux_of(image, c) == test::approx(light.value[c] * open).epsilon(2e-3));
      }
    }
    settings.starburst.on = false;
    settings.glare.fraction = 0.1;
    light.radius_rad = 0.0;
    CHECK(flux_of(drawn(lens, light, settings), 0) == test::approx(30.0 * open).epsilon(2e-3));
  }
}

TEST_CASE("glare has the fraction and the width that it says") {
  const LensState lens = test::bundled("heliar", {.f_number = 11.0});
  for (const double width_rad : {0.0002, 0.02}) {
    test::Settings settings = starburst_alone(frame_on_sensor(lens, 401, 401));
    settings.starburst.on = false;
    settings.glare = {0.2, width_rad};
    const Image image = drawn(lens, Light{}, settings);
    // Within a radius R: the fraction times 1 - (1 + (R / r0)^2)^-1/2, in pixels.
    const double r0 = lens.focal_length_mm * std::tan(width_rad) / settings.frame.pixel_pitch_mm;
    for (const double radius : {30.0, 150.0}) {
      double within = 0.0;
      for (int y = 0; y < 401; ++y)
        for (int x = 0; x < 401; ++x)
          if (std::hypot(x - 200, y - 200) < radius) within += image.at(x, y, 1);
      const double expected = 0.2 * (1.0 - 1.0 / std::sqrt(1.0 + radius * radius / (r0 * r0)));
      CHECK(within / expected == test::approx(1.0).epsilon(0.01));
    }
  }
}
