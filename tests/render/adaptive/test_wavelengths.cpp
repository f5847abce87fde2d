// SPDX-License-Identifier: Apache-2.0
// Many wavelengths interpolated from few: the order in which they are chosen, the interpolated values, and pictures.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>
#include <string>

#include "contrejour/expert/metrics.h"
#include "render/adaptive/budget/band_error.h"
#include "render/adaptive/budget/fit_budget.h"
#include "render/adaptive/budget/wavelength_bands.h"
#include "render/adaptive/scene.h"
#include "render/ray_maps/band_set.h"
#include "render/ray_maps/first_rays.h"
#include "support/approx.h"
#include "support/flares.h"
#include "support/kept_picture.h"

using namespace contrejour;
using namespace contrejour::adaptive;

namespace {

std::vector<double> evenly(double from_nm, double to_nm, std::size_t count) {
  std::vector<double> lambda_nm;
  for (std::size_t k = 0; k < count; ++k)
    lambda_nm.push_back(from_nm + (to_nm - from_nm) * static_cast<double>(k) / static_cast<double>(count - 1));
  return lambda_nm;
}

// A ghost of a light at sixteen wavelengths.
constexpr ErrorBudget kSome{1e150 * 1e-12, 1e-6};

struct Rainbow {
  test::GhostScene scene;
  std::vector<PlannedPass> passes;
  WavelengthSamples samples;
  StepsByWavelength steps;
  GhostTracers tracers;

  Rainbow(const char* lens, double f_number, Ghost ghost, Vec3 towards)
      : scene(test::lens_at_f(lens, f_number), ghost, towards), passes(passes_of()),
        samples(evenly(400.0, 700.0, 16), 9), steps(scene.lens, scene.tables),
        tracers(steps, ghost, scene.light, entrance_window(scene.lens, scene.light.source).z_mm, passes, 1.0) {}
  static std::vector<PlannedPass> passes_of() {
    std::vector<PlannedPass> passes;
    for (const double lambda_nm : evenly(400.0, 700.0, 16)) passes.push_back({lambda_nm, {1.0, 0.5, 0.25}});
    return passes;
  }
};

FirstRays first_rays_of(Rainbow& rainbow, const Rectangle& box, const Frame& frame, const ErrorBudget& budget) {
  return first_rays_within(budget, rainbow.tracers, rainbow.samples, box, frame);
}

const Vec3 kOffset{std::sin(0.2), 0.0, std::cos(0.2)};

}  // namespace

TEST_CASE("Leja's order begins with the ends and leaves out what is there already") {
  const std::vector<double> lambda_nm = evenly(400.0, 700.0, 16);
  const WavelengthSamples samples(lambda_nm, 9);
  REQUIRE(samples.size() == 9);
  CHECK(samples[0] == 0);
  CHECK(samples[1] == 15);
  // The middle in 1 / lambda^2: 493 nm.
  CHECK(samples[2] == 5);
  std::set<std::size_t> taken;
  for (std::size_t k = 0; k < samples.size(); ++k) taken.insert(samples[k]);
  CHECK(taken.size() == 9);
  const WavelengthSamples shuffled(std::vector<double>{500.0, 700.0, 450.0, 400.0, 600.0}, 2);
  CHECK(shuffled[0] == 3);
  CHECK(shuffled[1] == 1);
  CHECK(WavelengthSamples(std::vector<double>{550.0, 550.0, 600.0, 600.0}, 9).size() == 2);
  CHECK(WavelengthSamples(std::vector<double>{550.0}, 9).size() == 1);
  CHECK(WavelengthSamples(std::vector<double>{}, 9).size() == 0);
}

TEST_CASE("polynomials in 1 / lambda^2 are predicted exactly, others are not") {
  const std::vector<double> lambda_nm = evenly(380.0, 780.0, 31);
  const WavelengthSamples samples(lambda_nm, 5);
  const auto predicted = [&](auto of, std::size_t at) {
    const std::vector<double> factors = samples.factors(5, at);
    double sum = 0.0;
    for (std::size_t k = 0; k < factors.size(); ++k) sum += factors[k] * of(lambda_nm[samples[k]]);
    return sum;
  };
  const auto quartic = [](double lambda) {
    const double s = 550.0 * 550.0 / (lambda * lambda);
    return 3.0 - s + 2.0 * s * s - 0.5 * s * s * s + 0.1 * s * s * s * s;
  };
  for (std::size_t k = 0; k < lambda_nm.size(); ++k)
    CHECK(predicted(quartic, k) == test::approx(quartic(lambda_nm[k])).epsilon(1e-12));
  const auto narrow = [](double lambda) { return std::exp(-0.5 * std::pow((lambda - 550.0) / 20.0, 2.0)); };
  double worst = 0.0;
  for (std::size_t k = 0; k < lambda_nm.size(); ++k)
    worst = std::max(worst, std::abs(predicted(narrow, k) - narrow(lambda_nm[k])));
  CHECK(worst > 0.1);
}

TEST_CASE("where coatings are uneven over the wavelengths, straight lines interpolate and nothing becomes negative") {
  const std::vector<double> lambda_nm = evenly(400.0, 700.0, 32);
  const WavelengthSamples samples(lambda_nm, 4);
  double least = 0.0;
  for (std::size_t pass = 0; pass < lambda_nm.size(); ++pass) {
    const std::vector<double> weights = light_factors(samples, 4, pass, true);
    CHECK(std::accumulate(weights.begin(), weights.end(), 0.0) == test::approx(1.0));
    CHECK(std::ranges::count_if(weights, [](double weight) { return weight != 0.0; }) <= 2);
    for (const double weight : weights) CHECK(weight >= 0.0);
    least = std::min(least, std::ranges::min(light_factors(samples, 4, pass, false)));
  }
  CHECK(least < -0.1);  // those of polynomials are not
}

TEST_CASE("few wavelengths tell the transmissions of sixteen") {
  const std::array kLobatto{-1.0, -std::sqrt(0.5), 0.0, std::sqrt(0.5), 1.0};
  for (const Ghost ghost : {Ghost{3, 4}, Ghost{1, 2}, Ghost{7, 9}}) {
    CAPTURE(ghost.i);
    Rainbow rainbow("heliar", 16.0, ghost, kOffset);
    REQUIRE_FALSE(rainbow.scene.boxes.empty());
    const Rectangle& box = rainbow.scene.boxes.front();
    const Frame frame = frame_on_sensor(rainbow.scene.lens, 1920, 1080);
    // Without a limit, with one that requires more of them, and with one that requires all.
    std::size_t before = 0;
    for (const double allowed : {1e150, 0.1, 1e-3}) {
      CAPTURE(allowed);
      const double peak = 1e-6;
      const FirstRays rays = first_rays_of(rainbow, box, frame, {allowed * allowed * peak * peak, peak});
      const std::size_t traced = rays.samples == 0 ? 16 : rays.samples;
      CHECK(traced >= std::max<std::size_t>(before, 4));
      if (allowed == 1e150) CHECK(traced <= 9);
      before = traced;
      for (std::size_t k = 0; k < 16; ++k) {
        const LobattoRays ray_set = rainbow.tracers.at(k).trace(box, 5, PacketPrecision::Double);
        const float largest = *std::max_element(ray_set.transmission.begin(), ray_set.transmission.end());
        double predicted = 0.0, traced_light = 0.0;
        for (std::size_t node = 0; node < ray_set.count(); ++node) {
          // No light passes the corners of the box, for which the flux of a wavelength does not stand.
          if (std::hypot(kLobatto[node % 5], kLobatto[node / 5]) > 1.01) continue;
          CHECK(std::abs(rays.transmission[k][node] - ray_set.transmission[node]) <=
                (allowed > 1.0 ? 0.12 : 0.03) * largest);
          predicted += rays.transmission[k][node];
          traced_light += ray_set.transmission[node];
        }
        CHECK(predicted == test::approx(traced_light).epsilon(0.015));
      }
    }
  }
}

TEST_CASE("bands predicted from samples have the patches of rays traced at their wavelengths") {
  Rainbow rainbow("heliar", 16.0, {3, 4}, kOffset);
  const Rectangle& box = rainbow.scene.boxes.front();
  const Frame frame = frame_on_sensor(rainbow.scene.lens, 1920, 1080);
  std::vector<Band> bands;
  for (std::size_t k = 0; k < 16; ++k) bands.push_back({k, k + 1});
  const FirstRays rays = first_rays_of(rainbow, box, frame, kSome);
  REQUIRE(rays.samples > 0);
  BandSet predicted(rainbow.tracers, rainbow.samples, rays, bands);
  std::vector<LobattoRays> ray_sets = predicted.trace(box, 9, PacketPrecision::Double);
  predicted.add_weights(ray_sets, PacketPrecision::Double);
  const std::vector<Patch> patches = predicted.make_patches(ray_sets, frame);
  REQUIRE(patches.size() == rays.samples);
  for (std::size_t k = 0; k < 16; ++k) {
    CAPTURE(k);
    Patch patch;
    predicted.band_patch(patches, k, patch);
    BandSet alone = predicted.alone(k);
    std::vector<LobattoRays> one = alone.trace(box, 9, PacketPrecision::Double);
    alone.add_weights(one, PacketPrecision::Double);
    const Patch traced = alone.make_patches(one, frame).front();
    CHECK(patch.layout.weights == 1);
    CHECK(traced.layout.weights == 1);
    CHECK(patch.gain == traced.gain);
    for (std::size_t node = 0; node < patch.size(); ++node) {
      const Vec2 off = patch.origin_px - traced.origin_px;
      CHECK(std::abs(patch.field(PatchLayout::kX)[node] + off.x - traced.field(PatchLayout::kX)[node]) < 5e-3);
      CHECK(std::abs(patch.field(PatchLayout::kY)[node] + off.y - traced.field(PatchLayout::kY)[node]) < 5e-3);
      CHECK(patch.field(PatchLayout::kStop)[node] ==
            test::approx(traced.field(PatchLayout::kStop)[node]).epsilon(1e-5).scale(1.0));
      CHECK(patch.field(patch.layout.weight(0))[node] ==
            test::approx(traced.field(traced.layout.weight(0))[node]).epsilon(0.03));  // the largest tint
    }
  }
}

TEST_CASE("a band of several wavelengths carries the light of all, in each channel") {
  Rainbow rainbow("heliar", 16.0, {3, 4}, kOffset);
  const Rectangle& box = rainbow.scene.boxes.front();
  const Frame frame = frame_on_sensor(rainbow.scene.lens, 1920, 1080);
  const std::vector<Band> bands{{0, 5}, {5, 16}};
  const FirstRays rays = first_rays_of(rainbow, box, frame, kSome);
  REQUIRE(rays.samples > 0);
  BandSet predicted(rainbow.tracers, rainbow.samples, rays, bands);
  std::vector<LobattoRays> ray_sets = predicted.trace(box, 9, PacketPrecision::Double);
  predicted.add_weights(ray_sets, PacketPrecision::Double);
  Patch patch;
  predicted.band_patch(predicted.make_patches(ray_sets, frame), 1, patch);
  REQUIRE(patch.layout.weights == 3);
  std::vector<std::array<double, 3>> sum(patch.size());
  for (std::size_t pass = 5; pass < 16; ++pass) {
    const std::vector<float> light = rainbow.tracers.at(pass).transmissions(box, 9, PacketPrecision::Double);
    for (std::size_t node = 0; node < patch.size(); ++node)
      for (std::size_t c = 0; c < 3; ++c) sum[node][c] += rainbow.tracers.passes()[pass].gain[c] * light[node];
  }
  for (std::size_t node = 0; node < patch.size(); ++node)
    for (int c = 0; c < 3; ++c)
      CHECK(patch.gain[static_cast<std::size_t>(c)] * patch.field(patch.layout.weight_of(c))[node] ==
            test::approx(sum[node][static_cast<std::size_t>(c)]).epsilon(8e-3).scale(0.01 * sum[node][1]));
}

TEST_CASE("a band drawn by itself carries the light of all its wavelengths, of which few are traced") {
  Rainbow rainbow("heliar", 16.0, {3, 4}, kOffset);
  const Rectangle& box = rainbow.scene.boxes.front();
  FirstRays rays = first_rays_of(rainbow, box, frame_on_sensor(rainbow.scene.lens, 640, 360), kSome);
  const Band band{2, 11, {}};
  constexpr std::size_t kBands = 2;
  for (const auto& [weight, most] : {std::pair{0.3, 5UL}, std::pair{0.002, 8UL}, std::pair{0.0, 9UL}}) {
    CAPTURE(weight);
    rays.tolerance.weight = weight;
    const BandLight light = light_of_band(rays, band, rainbow.passes, kBands);
    CHECK(light.passes.size() <= most);
    BandSet alone(rainbow.tracers, band, light);
    std::vector<LobattoRays> ray_sets = alone.trace(box, 9, PacketPrecision::Double);
    alone.add_weights(ray_sets, PacketPrecision::Double);
    REQUIRE(ray_sets.size() == 1);
    const LobattoRays& found = ray_sets.front();
    const double allowed = std::min(0.5 * weight, 0.004) / kBands + 1e-5;
    for (std::size_t c = 0; c < 3; ++c) {
      std::vector<double> sum(found.count());
      for (std::size_t pass = band.first; pass < band.last; ++pass) {
        const std::vector<float> of_pass = rainbow.tracers.at(pass).transmissions(box, 9, PacketPrecision::Double);
        for (std::size_t node = 0; node < sum.size(); ++node) sum[node] += rainbow.passes[pass].gain[c] * of_pass[node];
      }
      double largest = 0.0;
      for (std::size_t node = 0; node < sum.size(); ++node) {
        const std::vector<float>& of_channel = found.weight[std::min(c, found.weight.size() - 1)];
        largest = std::max(largest, std::abs(found.gain[c] * of_channel[node] - sum[node]));
      }
      CHECK(largest <= 1.5 * allowed * rays.largest_weight);  // between the nodes of the first rays
    }
  }
}

TEST_CASE("a band alone is the same whether it was one of several or not") {
  Rainbow rainbow("heliar", 16.0, {3, 4}, kOffset);
  const Rectangle& box = rainbow.scene.boxes.front();
  const FirstRays rays = first_rays_of(rainbow, box, frame_on_sensor(rainbow.scene.lens, 640, 360), kSome);
  const std::vector<Band> bands{{0, 5}, {5, 16}};
  BandSet all(rainbow.tracers, rainbow.samples, rays, bands);
  BandSet one(rainbow.tracers, bands[1], light_of_band(rays, bands[1], rainbow.passes, bands.size()));
  BandSet second = all.alone(1);
  CHECK(second.size() == 1);
  CHECK(second.band(0).first == 5);
  std::vector<LobattoRays> expected = one.trace(box, 5, PacketPrecision::Double);
  std::vector<LobattoRays> found = second.trace(box, 5, PacketPrecision::Double);
  one.add_weights(expected, PacketPrecision::Double);
  second.add_weights(found, PacketPrecision::Double);
  CHECK(found.front().weight == expected.front().weight);
}

namespace {

// The error that band_error() predicts, summed over pixels: edges are steps, each pixel is the mean of its points.
double counted_error(std::span<const SpectralEdge> edges, double drawn_px, std::size_t channel) {
  constexpr int kOffsets = 200, kReach_px = 12;
  double sum = 0.0;
  for (int offset = 0; offset < kOffsets; ++offset) {
    for (int pixel = -kReach_px; pixel <= kReach_px; ++pixel) {
      const double left = pixel + (offset + 0.5) / kOffsets;
      const auto right_of = [&](double edge_px) { return std::clamp(left + 1.0 - edge_px, 0.0, 1.0); };
      double off = 0.0;
      for (const SpectralEdge& edge : edges)
        off += edge.light[channel] * (right_of(edge.position_px) - right_of(drawn_px));
      sum += off * off / kOffsets;
    }
  }
  return sum;
}

double counted_error(std::span<const SpectralEdge> edges, double drawn_px) {
  double sum = 0.0;
  for (std::size_t channel = 0; channel < 3; ++channel) sum += counted_error(edges, drawn_px, channel);
  return sum / 3.0;
}

SpectralEdge white_edge(double position_px, double light) { return {position_px, {light, light, light}}; }

}  // namespace

TEST_CASE("edges drawn at one position are as wrong as counted pixel by pixel") {
  const std::vector<SpectralEdge> far{white_edge(-4.3, 0.2), white_edge(-1.1, 0.1), white_edge(0.4, 0.3),
                                      white_edge(2.0, 0.15), white_edge(5.5, 0.25)};
  const std::vector<SpectralEdge> near{white_edge(-0.21, 0.2), white_edge(-0.05, 0.5), white_edge(0.3, 0.3)};
  const std::vector<SpectralEdge> coloured{{-0.9, {0.0, 0.1, 0.8}}, {0.1, {0.1, 0.9, 0.2}}, {1.4, {0.7, 0.2, 0.0}}};
  for (const auto& edges : {far, near, coloured}) {
    for (const double drawn_px : {0.0, 0.4, middle_of_light(edges)})
      CHECK(band_error(edges, drawn_px) == test::approx(counted_error(edges, drawn_px)).epsilon(2e-3));
  }
  // Displacements of less than a pixel cancel about the middle of the light.
  CHECK(band_error(near, middle_of_light(near)) < 0.1 * band_error(near, near.front().position_px));
  const std::vector<SpectralEdge> one{white_edge(3.0, 1.0)};
  CHECK(band_error(one, 3.0) == 0.0);
}

TEST_CASE("predicted bands are drawn at the middle of their light, traced ones at one of their wavelengths") {
  Rainbow rainbow("heliar", 16.0, {3, 4}, kOffset);
  const Frame frame = frame_on_sensor(rainbow.scene.lens, 1920, 1080);
  FirstRays rays = first_rays_of(rainbow, rainbow.scene.boxes.front(), frame, {1e300, 1.0});
  rays.tolerance.position_px = 1.0;
  REQUIRE(rays.samples > 0);
  bool several = false;
  for (const Band& band : bands_for(rays, rainbow.passes, rainbow.samples, frame.pixel_pitch_mm)) {
    REQUIRE(band.mix.size() == band.last - band.first);
    CHECK(std::accumulate(band.mix.begin(), band.mix.end(), 0.0) == test::approx(1.0));
    several = several || band.mix.size() > 1;
  }
  CHECK(several);
  rays.samples = 0;
  for (const Band& band : bands_for(rays, rainbow.passes, rainbow.samples, frame.pixel_pitch_mm))
    CHECK(band.mix.empty());
}

TEST_CASE("bands hold every wavelength once, more of them the less may be wrong") {
  Rainbow rainbow("heliar", 16.0, {3, 4}, kOffset);
  const Frame frame = frame_on_sensor(rainbow.scene.lens, 1920, 1080);
  FirstRays rays = first_rays_of(rainbow, rainbow.scene.boxes.front(), frame, {1e300, 1.0});
  const auto bands_within = [&](double tolerance_px) {
    rays.tolerance.position_px = tolerance_px;
    return bands_for(rays, rainbow.passes, rainbow.samples, frame.pixel_pitch_mm);
  };
  std::size_t before = 1;
  for (const double tolerance_px : {1e6, 3.0, 1.0, 0.3, 0.1, 1e-6}) {
    CAPTURE(tolerance_px);
    const std::vector<Band> bands = bands_within(tolerance_px);
    CHECK(bands.size() >= before);
    before = bands.size();
    CHECK(bands.front().first == 0);
    CHECK(bands.back().last == 16);
    for (std::size_t k = 0; k + 1 < bands.size(); ++k) CHECK(bands[k].last == bands[k + 1].first);
  }
  CHECK(bands_within(1e6).size() == 1);
  CHECK(bands_within(1e-6).size() == 16);
  CHECK(bands_within(0.3).size() > 1);
}

TEST_CASE("many pieces of a light have finer bands, as they are all displaced alike") {
  Rainbow rainbow("heliar", 16.0, {3, 4}, kOffset);
  const Frame frame = frame_on_sensor(rainbow.scene.lens, 1920, 1080);
  FirstRays rays = first_rays_of(rainbow, rainbow.scene.boxes.front(), frame, {1e300, 1.0});
  rays.tolerance.position_px = 1.0;
  const auto bands_of = [&](std::size_t pieces) {
    return bands_for(rays, rainbow.passes, rainbow.samples, frame.pixel_pitch_mm, pieces).size();
  };
  CHECK(bands_of(2) >= bands_of(1));
  CHECK(bands_of(100) > bands_of(2));
  CHECK(bands_of(100) < 16);
}

TEST_CASE("a ghost of coloured wavelengths has finer bands than a white one, as its channels show") {
  Rainbow rainbow("heliar", 16.0, {3, 4}, kOffset);
  const Frame frame = frame_on_sensor(rainbow.scene.lens, 1920, 1080);
  FirstRays rays = first_rays_of(rainbow, rainbow.scene.boxes.front(), frame, {1e300, 1.0});
  rays.tolerance.position_px = 1.0;
  std::vector<PlannedPass> coloured = rainbow.passes;
  for (std::size_t k = 0; k < coloured.size(); ++k) {
    coloured[k].gain = {0.0, 0.0, 0.0};
    coloured[k].gain[2 - k * 3 / coloured.size()] = 1.75;  // the light of a white one's three channels
  }
  const auto bands_of = [&](const std::vector<PlannedPass>& passes) {
    return bands_for(rays, passes, rainbow.samples, frame.pixel_pitch_mm).size();
  };
  CHECK(bands_of(coloured) > bands_of(rainbow.passes));
}

TEST_CASE("however much may be wrong, wavelengths of a band are no farther apart than colours allow") {
  Rainbow rainbow("heliar", 16.0, {3, 4}, kOffset);
  const Frame frame = frame_on_sensor(rainbow.scene.lens, 1920, 1080);
  FirstRays rays = first_rays_of(rainbow, rainbow.scene.boxes.front(), frame, {1e300, 1.0});
  rays.tolerance.position_px = 1e6;
  const auto bands_within = [&](double colour_px) {
    rays.tolerance.colour_px = colour_px;
    return bands_for(rays, rainbow.passes, rainbow.samples, frame.pixel_pitch_mm).size();
  };
  const LobattoRays first = rainbow.tracers.at(0).trace(rainbow.scene.boxes.front(), 5, PacketPrecision::Double);
  const LobattoRays last = rainbow.tracers.at(15).trace(rainbow.scene.boxes.front(), 5, PacketPrecision::Double);
  double spread_px = 0.0;
  for (std::size_t k = 0; k < first.count(); ++k)
    if (std::max(first.relative_height[k], last.relative_height[k]) < 1.2F)
      spread_px = std::max(spread_px, std::hypot(first.sensor_x_mm[k] - last.sensor_x_mm[k],
                                                 first.sensor_y_mm[k] - last.sensor_y_mm[k]) /
                                          frame.pixel_pitch_mm);
  REQUIRE(spread_px > 1.0);
  CHECK(bands_within(4.0 * spread_px) == 1);  // a rim cuts the ghost; its edge moves four times as far as rays do
  CHECK(bands_within(0.3 * spread_px) >= 2);
  CHECK(bands_within(0.1 * spread_px) >= 4);
  CHECK(bands_within(1e-9) == 16);
}

TEST_CASE("by default a fisheye's ghosts are continuous spectra, not bars") {
  const LensState lens = test::lens_at_f("muller-fisheye-10", 11.0);
  test::Settings settings;
  settings.frame = frame_on_sensor(lens, 384, 216);
  const Light light = test::light_at(lens, settings.frame, {0.70, 0.33});
  const Image ours = test::flare_of("adaptive", lens, {&light, 1}, settings).image;
  settings.wavelengths = 96;
  const auto difference = compare(test::flare_of("adaptive", lens, {&light, 1}, settings).image, ours);
  REQUIRE(difference.has_value());
  CHECK(difference->psnr_db.value_or(1000.0) >= 48.0);  // with three wavelengths 34
}

TEST_CASE("a ghost whose transmittance differs over its pupil has the light of each channel") {
  // Their green is a difference of large numbers: films reflect least there, and others' gains are negative.
  const LensState lens = test::lens_at_f("heliar", 16.0);
  test::Settings settings;
  settings.frame = frame_on_sensor(lens, 320, 180);
  const Light light = test::light_at(lens, settings.frame, {0.7499, 0.3574});
  for (const Ghost ghost : {Ghost{1, 4}, Ghost{7, 9}, Ghost{4, 5}}) {
    CAPTURE(ghost.i);
    settings.selection = SelectList{{ghost}};
    const auto sums_at = [&](double error) {
      test::Settings at = settings;
      at.set_error(error);
      const Image image = test::flare_of("adaptive", lens, {&light, 1}, at).image;
      std::array<double, 3> sums{};
      for (std::size_t k = 0; k < image.pixels.size(); ++k) sums[k % 3] += image.pixels[k];
      return sums;
    };
    const std::array<double, 3> ours = sums_at(3e-3), truth = sums_at(1e-4);
    for (std::size_t c = 0; c < 3; ++c) CHECK(ours[c] == test::approx(truth[c]).epsilon(0.02));
  }
}

TEST_CASE("a ghost that is about to vanish has the outline of each wavelength") {
  // Near its end a ghost is bounded where rays turn back before they leave the iris: a small change of the wavelength
  // moves its outline by many pixels, and a small error of a ray, too.
  const LensState lens = test::lens_at_f("nikon-80-200", 16.0, 140.0);
  test::Settings settings;
  settings.frame = frame_on_sensor(lens, 320, 180);
  settings.wavelengths = 3;
  settings.selection = SelectList{{{1, 10}}};
  settings.set_grid(384);
  const Light light = test::light_at(lens, settings.frame, {0.71, 0.34});
  const Image truth = test::flare_of("bundle", lens, {&light, 1}, settings).image;
  const auto difference = compare(truth, test::flare_of("adaptive", lens, {&light, 1}, settings).image);
  REQUIRE(difference.has_value());
  CHECK(difference->psnr_db.value_or(1000.0) >= 48.0);  // with one outline for two wavelengths 34, with few cells 41
}

TEST_CASE("a ghost without green light stays without it") {
  const LensState lens = test::lens_at_f("itoh-zoom", 32.0, 123.0);
  test::Settings settings;
  settings.frame = frame_on_sensor(lens, 320, 180);
  settings.scope = GhostScope::All;
  settings.selection = SelectList{{{12, 19}}};
  const Light light = test::light_at(lens, settings.frame, {0.7098521, 0.3354178});
  const auto sums_of = [&](const test::Settings& of) {
    const Image image = test::flare_of("adaptive", lens, {&light, 1}, of).image;
    std::array<double, 3> sums{};
    for (std::size_t k = 0; k < image.pixels.size(); ++k) sums[k % 3] += image.pixels[k];
    return sums;
  };
  const std::array<double, 3> ours = sums_of(settings);
  settings.wavelengths = 96;
  const std::array<double, 3> truth = sums_of(settings);
  for (std::size_t c = 0; c < 3; ++c) CHECK(std::abs(ours[c] - truth[c]) <= 0.01 * (truth[0] + truth[1] + truth[2]));
}

TEST_CASE("sixteen wavelengths as in the reference [slow]") {
  for (const auto& [name, f_number] : {std::pair{"heliar", 16.0}, std::pair{"tessar", 8.0}}) {
    CAPTURE(name);
    const LensState lens = test::lens_at_f(name, f_number);
    test::Settings settings;
    settings.scope = GhostScope::OneSideOfStop;  // half as many ghosts in half the time
    settings.frame = frame_on_sensor(lens, 112, 63);
    settings.wavelengths = 16;
    const Light light = test::light_at(lens, settings.frame, {0.70, 0.33});
    const Image truth = test::kept_picture(std::string(name) + "-16-wavelengths", [&] {
      return test::flare_of("reference", lens, {&light, 1}, settings).image;
    });
    const auto difference = compare(truth, test::flare_of("adaptive", lens, {&light, 1}, settings).image);
    REQUIRE(difference.has_value());
    CHECK(difference->psnr_db.value_or(1000.0) >= 50.0);
  }
}
