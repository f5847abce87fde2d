// SPDX-License-Identifier: Apache-2.0
// Starbursts: flux, spikes, scale, and the rings against exact patterns of one wavelength.
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "base/scalar.h"
#include "contrejour/expert/fraunhofer.h"
#include "contrejour/expert/starburst.h"
#include "support/approx.h"
#include "support/sum_of_channel.h"

using namespace contrejour;

namespace {

std::vector<SpectralBand> sunlight() { return spectral_bands(120, IlluminantD65{}, ColourSpace::Rec709); }

StarburstSettings settings_of(double f_number, double pitch_mm, double radius_px) {
  return {100.0, 50.0 / f_number, pitch_mm, radius_px};
}

Image drawn(const Iris& iris, const StarburstSettings& settings, int side, Vec2 centre,
            std::span<const SpectralBand> bands) {
  Image image(side, side);
  add_starburst(image, make_starburst(IrisOpening(iris), bands, settings).value(), centre, {1.0, 1.0, 1.0});
  return image;
}

Image drawn(const Iris& iris, const StarburstSettings& settings, int side) {
  return drawn(iris, settings, side, {0.5 * side, 0.5 * side}, sunlight());
}

// The green channel around the middle: for each direction the mean over a few radii.
std::vector<double> round_profile(const Image& image, double from, double to) {
  constexpr int kDirections = 720;
  std::vector<double> profile(kDirections);
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2.0 * kPi * i / kDirections;
    for (double r = from; r < to; r += 1.0)
      profile[static_cast<std::size_t>(i)] += image.at(static_cast<int>(0.5 * image.width + r * std::cos(angle)),
                                                       static_cast<int>(0.5 * image.height - r * std::sin(angle)), 1);
  }
  return profile;
}

// The directions (in turns of the profile) of the most prominent peaks.
std::vector<double> spikes(const std::vector<double>& profile) {
  const double threshold = 0.2 * *std::max_element(profile.begin(), profile.end());
  const auto count = static_cast<int>(profile.size());
  const auto at = [&](int i) { return profile[static_cast<std::size_t>((i + count) % count)]; };
  std::vector<double> found;
  int start = 0;
  while (at(start) > threshold) ++start;
  for (int i = start; i < start + count; ++i) {
    if (at(i) <= threshold) continue;
    double moment = 0.0, sum = 0.0;
    for (; at(i) > threshold; ++i) moment += i * at(i), sum += at(i);
    found.push_back(std::fmod(moment / sum, count) * 2.0 * kPi / count);
  }
  return found;
}

}  // namespace

TEST_CASE("the plane gets the light's flux in every channel, wherever in a pixel the centre is") {
  struct Case {
    Iris iris;
    double f_number, pitch_mm;
  };
  for (const Case& c : {Case{{}, 16.0, 0.01}, Case{{6, 0.1}, 2.0, 0.02}, Case{{8, 0.0, 0.3, 1.02}, 11.0, 0.006}}) {
    for (const Vec2 centre : {Vec2{300.0, 300.0}, Vec2{300.31, 299.62}}) {
      const Image image = drawn(c.iris, settings_of(c.f_number, c.pitch_mm, 430.0), 600, centre, sunlight());
      // Beyond the frame: the fraction of flux beyond rho is perimeter / area / (pi^2 rho) stop radii, over a square's
      // border as over a circle of pi / sqrt(8) times its half side.
      const IrisOpening opening(c.iris);
      const double rho = 300.0 * c.pitch_mm / (550e-6 * c.f_number) * kPi / std::sqrt(8.0);
      const double outside = opening.perimeter() / opening.area() / (kPi * kPi * rho);
      for (int channel = 0; channel < 3; ++channel)
        CHECK(test::sum_of_channel(image, channel) + outside == test::approx(1.0).epsilon(5e-4));
    }
  }
}

TEST_CASE("an even number of blades gives as many spikes, an odd one twice as many, across the edges") {
  for (const int blades : {5, 6, 7, 8, 9}) {
    const double rotation = 0.23;
    const Image image = drawn({blades, rotation}, settings_of(16.0, 0.01, 430.0), 600);
    const std::vector<double> found = spikes(round_profile(image, 120.0, 140.0));
    const int expected = blades % 2 == 0 ? blades : 2 * blades;
    REQUIRE(static_cast<int>(found.size()) == expected);
    for (const double angle : found) {  // along an edge's normal
      const double step = 2.0 * kPi / expected;
      const double normal = rotation + kPi / blades;
      const double off = std::remainder(angle - normal, step);
      CHECK(std::abs(off) < 0.01);
    }
  }
}

TEST_CASE("half the f-number draws the same at half the pitch, four times as dense") {
  const Image wide = drawn({7, 0.2, 0.2}, settings_of(16.0, 0.004, 300.0), 400);
  const Image narrow = drawn({7, 0.2, 0.2}, settings_of(8.0, 0.002, 300.0), 400);
  for (std::size_t k = 0; k < wide.pixels.size(); k += 997)
    CHECK(narrow.pixels[k] / wide.pixels[k] == test::approx(1.0).epsilon(1e-3));
}

TEST_CASE("a quarter-size picture is the full one filtered") {
  const Image full = drawn({6, 0.3, 0.1}, settings_of(11.0, 0.005, 600.0), 800);
  const Image quarter = drawn({6, 0.3, 0.1}, settings_of(11.0, 0.02, 150.0), 200);
  double error = 0.0, total = 0.0, worst = 0.0;
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) {
      double sum = 0.0;
      for (int i = 0; i < 16; ++i) sum += full.at(4 * x + i % 4, 4 * y + i / 4, 1);
      error += std::abs(quarter.at(x, y, 1) - sum);
      worst = std::max(worst, std::abs(quarter.at(x, y, 1) - sum));
      total += sum;
    }
  }
  CHECK(error / total < 0.02);
  CHECK(worst < 5e-3);
}

TEST_CASE("at one wavelength the rings are the exact pattern, core and tail") {
  const std::vector<SpectralBand> green{{550.0, {1.0, 1.0, 1.0}}};
  const double f_number = 16.0, pitch_mm = 1e-3;
  const Iris iris{6, 0.2, 0.2};
  const Image image = drawn(iris, settings_of(f_number, pitch_mm, 300.0), 401, {200.5, 200.5}, green);
  const double radius_mm = 50.0 / f_number;
  const PupilMask mask = make_mask(grid_over(radius_mm, 900), IrisOpening(iris), radius_mm);
  const FraunhoferPattern exact = fraunhofer_pattern(mask, {100.0, 550.0, 1.0, {401, pitch_mm}}).value();
  const double peak = exact.irradiance_per_mm2[200 * 401 + 200] * pitch_mm * pitch_mm;
  double worst = 0.0;
  for (std::size_t k = 0; k < exact.irradiance_per_mm2.size(); ++k)
    worst = std::max(worst, std::abs(image.pixels[3 * k] - exact.irradiance_per_mm2[k] * pitch_mm * pitch_mm));
  CHECK(worst < 0.015 * peak);  // cubics between samples a quarter of a fringe apart
}

TEST_CASE("eight decades without a step: far out a spike falls as r^-2 and what is between spikes as r^-4") {
  const Image image = drawn({8, 0.1}, settings_of(16.0, 0.01, 1500.0), 2000, {0.0, 0.0}, sunlight());
  constexpr double kRatio = 1.15;  // rings so wide that the assignment of single pixels does not matter
  double darkest = 1.0;
  // Rows go down, so this is the quadrant below the axis: the first along a spike, the others between them.
  for (const double angle : {kPi / 8 - 0.1, 0.6, 0.8, 1.4}) {
    const Vec2 along{std::cos(angle), std::sin(angle)};
    std::vector<double> sum(100), count(100);
    for (int y = 0; y < 2000; ++y) {
      for (int x = 0; x < 2000; ++x) {
        const Vec2 p{x + 0.5, y + 0.5};
        const double r = dot(p, along);
        if (std::abs(cross(p, along)) > 8.0 || r < 100.0 || length(p) > 1450.0) continue;
        const auto bin = static_cast<std::size_t>(std::log(r / 100.0) / std::log(kRatio));
        sum[bin] += image.at(x, y, 1);
        count[bin] += 1.0;
      }
    }
    for (std::size_t i = 1; i < 19; ++i) {
      const double here = sum[i] / count[i], before = sum[i - 1] / count[i - 1];
      INFO("angle ", angle, " radius ", 100.0 * std::pow(kRatio, i));
      CHECK(here / before == test::approx(std::pow(kRatio, -3)).epsilon(0.17));
      darkest = std::min(darkest, here);
    }
  }
  CHECK(image.at(0, 0, 1) / darkest > 1e8);
  CHECK(std::all_of(image.pixels.begin(), image.pixels.end(), [](float v) { return std::isfinite(v); }));
}

TEST_CASE("no radial ringing: from the sixth ring on daylight's are weaker than 1 per cent") {
  const Image image = drawn({}, settings_of(16.0, 5e-4, 300.0), 600);  // 17.6 pixels a ring
  double last = 1.0;
  for (int r = 6 * 18; r < 290; ++r) {  // monotonically decreasing
    const double value = image.at(300 + r, 300, 1);
    CHECK(value < last * 1.01);
    last = value;
  }
}

TEST_CASE("a picture's aperture: a double slit's fringes, and a tail that goes on smoothly") {
  Image slits(64, 64, 1);
  for (int y = 16; y < 48; ++y)
    for (const int x : {20, 21, 22, 41, 42, 43}) slits.at(x, y) = 1.0F;
  const double radius_mm = 2.0;
  const PupilMask mask = mask_of_image(slits, 0, 2.0 * radius_mm).value();
  const std::vector<SpectralBand> green{{550.0, {1.0, 1.0, 1.0}}};
  StarburstSettings settings{100.0, radius_mm, 1e-3, 400.0};
  Image image(401, 401);
  add_starburst(image, make_starburst(mask, nullptr, green, settings).value(), {200.5, 200.5}, {1.0, 1.0, 1.0});
  // Fringes lambda d / (21 samples of 1/16 mm) = 41.9 pixels apart.
  CHECK(image.at(200 + 21, 200, 1) < 0.05 * image.at(200, 200, 1));
  CHECK(image.at(200 + 42, 200, 1) > 0.6 * image.at(200, 200, 1));
  CHECK(std::all_of(image.pixels.begin(), image.pixels.end(), [](float v) { return v >= 0.0F; }));
}

TEST_CASE("a scratch adds a streak across itself, and no light is lost") {
  Image dirt(510, 510, 1);
  for (float& v : dirt.pixels) v = 1.0F;
  for (int k = 0; k < 300; ++k)
    for (int width = 0; width < 3; ++width) dirt.at(100 + k, 180 + width) = 0.0F;  // along x
  const StarburstSettings settings = settings_of(16.0, 0.006, 800.0);
  const IrisOpening opening(Iris{5, 0.3});
  const PupilOutline outline{opening, {settings.pupil_radius_mm, 0.0}, {0.0, settings.pupil_radius_mm}};
  const PupilMask clean = make_mask(grid_over(settings.pupil_radius_mm, 510), opening, settings.pupil_radius_mm);
  const PupilMask scratched = with_dirt(clean, dirt, 0).value();
  Image with(1100, 1100), without(1100, 1100);
  add_starburst(with, make_starburst(scratched, &outline, sunlight(), settings).value(), {550, 550}, {1, 1, 1});
  add_starburst(without, make_starburst(clean, &outline, sunlight(), settings).value(), {550, 550}, {1, 1, 1});
  for (int c = 0; c < 3; ++c) CHECK(test::sum_of_channel(with, c) == test::approx(1.0).epsilon(2e-3));
  for (const int r : {60, 150, 400}) {  // the spectrum, where it fades, and the tail
    const float across = with.at(550, 550 + r, 1) / without.at(550, 550 + r, 1);
    const float along = with.at(550 + r, 550, 1) / without.at(550 + r, 550, 1);
    CHECK(across > 3.0F);
    CHECK(across > 3.0F * along);  // its short ends send a little light along it
  }
}

TEST_CASE("the same bits for any number of threads, nothing when cancelled or closed") {
  const auto bands = sunlight();
  const StarburstSettings settings = settings_of(8.0, 0.01, 100.0);
  Image one(128, 128), seven(128, 128), none(128, 128);
  const IrisOpening opening(Iris{7, 0.1, 0.3});
  add_starburst(one, make_starburst(opening, bands, settings, {.threads = 1}).value(), {60, 61}, {1, 2, 3},
                {.threads = 1});
  add_starburst(seven, make_starburst(opening, bands, settings, {.threads = 7}).value(), {60, 61}, {1, 2, 3},
                {.threads = 7});
  CHECK(one.pixels == seven.pixels);
  const std::atomic<bool> stop = true;
  CHECK(make_starburst(opening, bands, settings, {.cancel = &stop}).error().code == ErrorCode::Cancelled);
  add_starburst(none, Starburst(), {60, 61}, {1, 2, 3});
  CHECK(none.pixels == Image(128, 128).pixels);
}

TEST_CASE("what no starburst comes of is refused and named") {
  const auto bands = sunlight();
  const IrisOpening opening(Iris{7, 0.1});
  const StarburstSettings good = settings_of(8.0, 0.01, 100.0);
  const auto message = [&](auto spoil) {
    StarburstSettings settings = good;
    spoil(settings);
    const auto made = make_starburst(opening, bands, settings);
    return made ? std::string() : made.error().message;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  CHECK(message([](auto&) {}).empty());
  for (const double bad : {0.0, -1.0, nan, infinity}) {
    CAPTURE(bad);
    CHECK(message([=](auto& s) { s.distance_mm = bad; }).find("distance") != std::string::npos);
    CHECK(message([=](auto& s) { s.pupil_radius_mm = bad; }).find("exit pupil") != std::string::npos);
    CHECK(message([=](auto& s) { s.pixel_pitch_mm = bad; }).find("pitch") != std::string::npos);
    CHECK(message([=](auto& s) { s.radius_px = bad; }).find("pixels") != std::string::npos);
    CHECK_FALSE(make_starburst(opening, std::vector<SpectralBand>{{bad, {1, 1, 1}}}, good).has_value());
    CHECK_FALSE(fraunhofer_pattern(make_mask(grid_over(1.0, 64), opening, 1.0), {bad, 550.0, 1.0, {}}).has_value());
  }
  CHECK(message([](auto& s) { s.samples_across = 3; }).find("samples") != std::string::npos);
  CHECK_FALSE(make_starburst(opening, {}, good).has_value());
  CHECK_FALSE(make_starburst(opening, std::vector<SpectralBand>{{550.0, {nan, 1, 1}}}, good).has_value());
  PupilMask broken = make_mask(grid_over(1.0, 64), opening, 1.0);
  broken.amplitude.pop_back();
  CHECK_FALSE(make_starburst(broken, nullptr, bands, good).has_value());
  broken.amplitude.push_back(static_cast<float>(nan));
  CHECK_FALSE(make_starburst(broken, nullptr, bands, good).has_value());
  PupilMask dark{grid_over(1.0, 64), std::vector<float>(66 * 66), {}};
  CHECK(make_starburst(dark, nullptr, bands, good).value().rings() == nullptr);
  CHECK_FALSE(fraunhofer_pattern(dark, {}).has_value());
}

TEST_CASE("a pupil seen askew: its outline's tail goes on from its samples' spectrum, along every direction") {
  const IrisOpening opening(Iris{6, 0.2, 0.3});
  const Vec2 x_mm{0.8, 0.1}, y_mm{-0.05, 0.55};
  const double det = cross(x_mm, y_mm);
  const auto distance_mm = [&](Vec2 p) {  // exact at edges, where it serves as a distance
    const auto bound = [&](Vec2 q) { return opening.bound_distance({cross(q, y_mm) / det, cross(x_mm, q) / det}); };
    constexpr double h = 1e-6;
    const double here = bound(p);
    return here / length(Vec2{bound(p + Vec2{h, 0}) - here, bound(p + Vec2{0, h}) - here} * (1.0 / h));
  };
  const PupilMask fine = make_mask(grid_over(0.85, 1600), distance_mm),
                  coarse = make_mask(grid_over(0.85, 400), distance_mm);
  const PupilOutline outline{opening, x_mm, y_mm};
  CHECK(fine.open_area_mm2() == test::approx(outline.area_mm2()).epsilon(1e-3));
  // The coarse mask's spectrum ends at rho = 80, the fine one's at 320: 150 to 600 pixels here.
  const StarburstSettings settings{50.0, 0.85, 0.0087, 500.0};
  Image exact(800, 800), tail(800, 800);
  add_starburst(exact, make_starburst(fine, &outline, sunlight(), settings).value(), {400, 400}, {1, 1, 1});
  add_starburst(tail, make_starburst(coarse, &outline, sunlight(), settings).value(), {400, 400}, {1, 1, 1});
  const auto truth = round_profile(exact, 200.0, 260.0), found = round_profile(tail, 200.0, 260.0);
  const double peak = *std::max_element(truth.begin(), truth.end());
  double sum_truth = 0.0, sum_found = 0.0;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    CHECK(std::abs(found[k] - truth[k]) < 0.1 * peak);
    sum_truth += truth[k];
    sum_found += found[k];
  }
  CHECK(sum_found / sum_truth == test::approx(1.0).epsilon(0.02));
}

// The pattern of a polygon's opening by its Fourier integral over the plane (Lee & Mittra 1983), over all wavelengths.
class ExactStarburst {
 public:
  ExactStarburst(const Iris& iris, const StarburstSettings& settings) : settings_(settings), bands_(sunlight()) {
    const IrisOpening opening(iris);
    for (const IrisEdge& edge : opening.edges()) corners_.push_back(edge.start);
    area_ = opening.area();
  }

  // The green flux in a square of pixels, offsets from the centre, y down: stratified samples, each at the next
  // wavelength.
  double flux(Vec2 corner, double side, int samples_per_px) const {
    const int count = static_cast<int>(side * samples_per_px);
    const double step = side / count;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> within(0.0, 1.0);
    double sum = 0.0, band = 0.11;
    for (int k = 0; k < count * count; ++k) {
      band += 0.6180339887498949;
      band -= std::floor(band);
      const double x = within(random), y = within(random);
      const Vec2 p{corner.x + (k % count + x) * step, corner.y + (k / count + y) * step};
      sum += density(p, bands_[static_cast<std::size_t>(band * static_cast<double>(bands_.size()))]);
    }
    return sum * step * step * static_cast<double>(bands_.size());
  }

 private:
  double density(Vec2 px, const SpectralBand& band) const {
    const double lambda_d = band.lambda_nm * 1e-6 * settings_.distance_mm, a = settings_.pupil_radius_mm;
    const Vec2 k = Vec2{px.x, -px.y} * (2.0 * kPi * a * settings_.pixel_pitch_mm / lambda_d);
    std::complex<double> sum;
    for (std::size_t j = 0; j < corners_.size(); ++j) {
      const Vec2 from = corners_[j], step = corners_[(j + 1) % corners_.size()] - from;
      const double half = 0.5 * dot(k, step);
      const double sinc = std::abs(half) < 1e-9 ? 1.0 : std::sin(half) / half;
      sum += std::polar(cross(k, step) * sinc, -dot(k, from + step * 0.5));
    }
    const double k2 = dot(k, k), scale = a * settings_.pixel_pitch_mm / lambda_d;
    return band.weight[1] * std::norm(sum) / (k2 * k2) * scale * scale / area_;
  }

  StarburstSettings settings_;
  std::vector<SpectralBand> bands_;
  std::vector<Vec2> corners_;
  double area_ = 0.0;
};

TEST_CASE(
    "windows of pixels hold the exact pattern's flux at any pitch, on spikes, opposite ones, and between them [slow]") {
  struct Case {
    Iris iris;
    double f_number, pitch_mm;
  };
  for (const Case& c : {Case{{7, 0.1}, 8.0, 0.056}, Case{{6, 0.0}, 11.0, 0.012}, Case{{5, 0.3}, 16.0, 0.004}}) {
    CAPTURE(c.pitch_mm);
    const StarburstSettings settings = settings_of(c.f_number, c.pitch_mm, 400.0);
    const ExactStarburst exact(c.iris, settings);
    const Vec2 centre{150.31, 149.87};
    const Image image = drawn(c.iris, settings, 300, centre, sunlight());
    const double step = 2.0 * kPi / c.iris.blades;
    for (const double radius : {9.0, 31.0, 130.0}) {
      for (const double turn : {0.5 * step, 0.5 * step + kPi, 0.68 * step}) {
        for (const int side : {1, 5}) {
          CAPTURE(radius);
          CAPTURE(turn);
          CAPTURE(side);
          const double angle = c.iris.rotation_rad + turn;
          const int x0 = static_cast<int>(centre.x + radius * std::cos(angle)) - side / 2;
          const int y0 = static_cast<int>(centre.y - radius * std::sin(angle)) - side / 2;
          double sum = 0.0;
          for (int k = 0; k < side * side; ++k) sum += image.at(x0 + k % side, y0 + k / side, 1);
          const Vec2 corner{x0 - centre.x, y0 - centre.y};
          const double truth = exact.flux(corner, side, side == 1 ? 200 : 64);
          CHECK(sum / truth == test::approx(1.0).epsilon(0.022));
        }
      }
    }
  }
}

// The sums of some rows and columns of pixels, far from the centre.
std::vector<double> held_by_lines(const Starburst& starburst, int side, Vec2 moved) {
  Image image(side, side);
  add_starburst(image, starburst, Vec2{0.5 * side, 0.5 * side} + moved, {1.0, 1.0, 1.0});
  std::vector<double> held;
  for (int at = 10; at < side / 3; at += 10) {
    double row = 0.0, column = 0.0;
    for (int i = 0; i < side; ++i) row += image.at(i, at, 1), column += image.at(at, i, 1);
    held.push_back(row);
    held.push_back(column);
  }
  return held;
}

TEST_CASE("as a light moves by tenths of a pixel no spike flickers, of blades or of a picture") {
  const StarburstSettings settings = settings_of(8.0, 0.056, 300.0);  // 13 fringes to a pixel
  std::vector<Starburst> starbursts;
  for (const Iris& iris : {Iris{7, 0.1}, Iris{6, 0.0}, Iris{8, 0.3}})
    starbursts.push_back(make_starburst(IrisOpening(iris), sunlight(), settings).value());
  const double radius_mm = settings.pupil_radius_mm;
  const PupilMask picture = make_mask(grid_over(radius_mm, 400), IrisOpening(Iris{6, 0.1}), radius_mm);
  starbursts.push_back(make_starburst(picture, nullptr, sunlight(), settings_of(8.0, 0.03, 300.0)).value());
  for (const Starburst& starburst : starbursts) {
    std::vector<double> before;
    for (int k = 0; k <= 10; ++k) {
      const std::vector<double> held = held_by_lines(starburst, 200, {0.1 * k, 0.03 * k});
      for (std::size_t i = 0; i < before.size(); ++i) CHECK(held[i] / before[i] == test::approx(1.0).epsilon(0.01));
      before = held;
    }
  }
}

TEST_CASE("laid out, a starburst is drawn as without, and moves smoothly") {
  for (const Iris& iris : {Iris{}, Iris{6, 0.2, 0.3}, Iris{8, 0.1}}) {
    const Starburst starburst = make_starburst(IrisOpening(iris), sunlight(), settings_of(16.0, 0.01, 700.0)).value();
    const StarburstImage starburst_image = lay_out(starburst, 400, 300).value();
    for (const Vec2 centre : {Vec2{200.0, 150.0}, Vec2{31.4, 288.3}, Vec2{399.7, 0.2}, Vec2{420.0, 100.0}}) {
      CAPTURE(centre.x);
      Image direct(400, 300), laid(400, 300);
      add_starburst(direct, starburst, centre, {1.0, 2.0, 3.0});
      add_starburst(laid, starburst_image, centre, {1.0, 2.0, 3.0});
      const bool cut = centre.x > 390.0 && centre.x < 410.0;  // the frame's edge goes through the core
      for (int c = 0; c < 3; ++c)
        CHECK(test::sum_of_channel(laid, c) / test::sum_of_channel(direct, c) ==
              test::approx(1.0).epsilon(cut ? 0.02 : 1e-4));
      double worst_near = 0.0, worst_far = 0.0, core_error = 0.0;
      for (int y = 0; y < 300; ++y) {
        for (int x = 0; x < 400; ++x) {
          const double r = std::hypot(x + 0.5 - centre.x, y + 0.5 - centre.y);
          const double a = direct.at(x, y, 1), b = laid.at(x, y, 1);
          CHECK(b >= 0.0);
          if (r < 10.0) core_error += std::abs(b - a);
          // The centre is placed to an eighth of a pixel; in between, the pattern is interpolated linearly, which
          // widens a thin spike's edge.
          const bool on_eighth = centre.x == 200.0 || centre.x == 420.0;
          if (r > 10.0 && r < 14.0) CHECK(b / a == test::approx(1.0).epsilon(on_eighth ? 3e-3 : 0.06));
          if (iris.blades > 0 || r < 18.0) continue;
          (r < 80.0 ? worst_near : worst_far) = std::max(r < 80.0 ? worst_near : worst_far, std::abs(b / a - 1.0));
        }
      }
      CHECK(core_error < 0.02 * 2.0);  // of green's flux
      CHECK(worst_near < 0.06);
      CHECK(worst_far < 0.01);
    }
  }
  CHECK_FALSE(lay_out(Starburst(), 0, 10).has_value());
  CHECK_FALSE(lay_out(Starburst(), 1 << 14, 1 << 14).has_value());
  Image none(8, 8);
  add_starburst(none, lay_out(Starburst(), 8, 8).value(), {4, 4}, {1, 1, 1});
  add_starburst(none, StarburstImage(), {std::nan(""), 4}, {1, 1, 1});
  CHECK(none.pixels == Image(8, 8).pixels);
}
