// SPDX-License-Identifier: Apache-2.0
// Kernels, convolution, and sums of pictures of several resolutions: against direct sums and polynomials.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include <doctest/doctest.h>

#include "render/area_lights/convolve.h"
#include "render/area_lights/image_pyramid.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::area;

namespace {

Image random_picture(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> level(0.0F, 1.0F);
  Image image(width, height);
  for (float& v : image.pixels) v = level(random) < 0.7F ? 0.0F : level(random);
  return image;
}

Kernel random_kernel(KernelExtent extent, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> level(0.0, 1.0);
  Kernel kernel;
  kernel.extent = extent;
  for (int k = 0; k < kernel.width() * kernel.height(); ++k)
    kernel.weight.push_back(k % 5 == 0 ? Rgb{} : Rgb{level(random), level(random), level(random)});
  return kernel;
}

struct Window {
  int left = 0, top = 0, width = 0, height = 0;
  [[nodiscard]] bool holds(int x, int y) const { return x >= left && y >= top && x < left + width && y < top + height; }
};

// Sets everything outside a window to 0.
void darken_around(Image& picture, const Window& lit) {
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      for (int c = 0; c < 3; ++c)
        if (!lit.holds(x, y)) picture.at(x, y, c) = 0.0F;
}

Image cut_out(const Image& picture, const Window& window) {
  Image cut(window.width, window.height);
  for (int y = 0; y < cut.height; ++y)
    for (int x = 0; x < cut.width; ++x)
      for (int c = 0; c < 3; ++c) cut.at(x, y, c) = picture.at(window.left + x, window.top + y, c);
  return cut;
}

double largest_difference(const Image& a, const Image& b) {
  double worst = 0.0;
  for (std::size_t k = 0; k < a.pixels.size(); ++k)
    worst = std::max(worst, static_cast<double>(std::abs(a.pixels[k] - b.pixels[k])));
  return worst;
}

// The light's flux and first and second moments about a point.
struct Moments {
  double flux = 0.0;
  Vec2 mean;
  LinearMap covariance = kZeroMap;
};

Moments moments_of(const Image& image, int channel) {
  Moments m;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double v = image.at(x, y, channel);
      m.flux += v;
      m.mean = m.mean + Vec2{x + 0.5, y + 0.5} * v;
    }
  }
  m.mean = m.mean * (1.0 / m.flux);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const Vec2 d = Vec2{x + 0.5, y + 0.5} - m.mean;
      const double w = image.at(x, y, channel) / m.flux;
      m.covariance = m.covariance + LinearMap{d * (w * d.x), d * (w * d.y)};
    }
  }
  return m;
}

}  // namespace

TEST_CASE("a convolution is the plain sum, at any width and number of threads") {
  for (const int width : {1, 7, 16, 33, 50}) {
    const Kernel kernel = random_kernel({3, 1, 2, 4}, 7);
    const Image picture = random_picture(width + kernel.width() - 1, 21 + kernel.height() - 1, 3);
    Image sum(width, 21), again(width, 21);
    convolve(sum, ConvolveMode::Add, {picture}, kernel, 0.0, {.threads = 1});
    convolve(again, ConvolveMode::Add, {picture}, kernel, 0.0, {.threads = 3});
    CHECK(sum.pixels == again.pixels);
    double worst = 0.0;
    for (int y = 0; y < sum.height; ++y) {
      for (int x = 0; x < width; ++x) {
        for (int c = 0; c < 3; ++c) {
          double expected = 0.0;
          for (int dy = -2; dy <= 4; ++dy)
            for (int dx = -3; dx <= 1; ++dx)
              expected += kernel.weight[static_cast<std::size_t>((dy + 2) * kernel.width() + dx + 3)]
                                       [static_cast<std::size_t>(c)] *
                          picture.at(x + 1 - dx, y + 4 - dy, c);
          worst = std::max(worst, std::abs(expected - sum.at(x, y, c)));
        }
      }
    }
    CHECK(worst < 1e-4);
  }
}

TEST_CASE("a part of a picture with all of its light is as good, wherever it lies, of smooth pictures, too") {
  Kernel disc;
  disc.extent = {2, 2, 2, 2};
  for (int k = 0; k < 25; ++k) disc.weight.push_back({0.04, 0.04, 0.04});
  for (const Kernel& kernel : {random_kernel({3, 1, 2, 4}, 7), disc}) {
    const int beside_x = kernel.width() - 1, beside_y = kernel.height() - 1;
    for (const Window& lit : {Window{20, 11, 33, 9}, Window{0, 0, 30, 5}, Window{40, 20, 30 + beside_x, 10 + beside_y},
                              Window{17, 9, 1, 1}}) {
      CAPTURE(lit.left);
      Image whole(70 + beside_x, 30 + beside_y);
      for (std::size_t k = 0; k < whole.pixels.size(); ++k) whole.pixels[k] = 1e-3F * static_cast<float>(k % 217);
      darken_around(whole, lit);
      Window part{std::max(lit.left - beside_x, 0), std::max(lit.top - beside_y, 0), 0, 0};
      part.width = std::min(lit.left + lit.width + beside_x, whole.width) - part.left;
      part.height = std::min(lit.top + lit.height + beside_y, whole.height) - part.top;
      const Image cut = cut_out(whole, part);
      Image by_whole = random_picture(70, 30, 5), by_part = by_whole;
      for (const ConvolveMode mode : {ConvolveMode::Add, ConvolveMode::Write}) {
        for (const double negligible_level : {0.0, 0.01}) {
          convolve(by_whole, mode, {whole}, kernel, negligible_level, {.threads = 2});
          convolve(by_part, mode, {cut, part.left, part.top}, kernel, negligible_level, {.threads = 2});
          CHECK(largest_difference(by_whole, by_part) < 1e-5 + 2.0 * negligible_level);  // blocks begin elsewhere
        }
      }
    }
  }
  Image dark = random_picture(7, 5, 1);
  const Image before = dark;
  convolve(dark, ConvolveMode::Add, {Image{}}, disc, 0.0, {});
  CHECK(dark.pixels == before.pixels);
}

TEST_CASE("white kernels, and what is linear under them") {
  Kernel disc;
  disc.extent = {3, 3, 3, 3};
  double sum = 0.0;
  for (int k = 0; k < 49; ++k) {
    const double w = std::hypot(k % 7 - 3, k / 7 - 3) < 3.2 ? 1.0 : 0.0;
    disc.weight.push_back({w, w, w});
    sum += w;
  }
  for (Rgb& w : disc.weight) w = {w[0] / sum, w[1] / sum, w[2] / sum};
  // A ramp that ends along a slanted edge, dark beyond it, with a faint step across it.
  const int width = 90, height = 40;
  Image picture(width + 6, height + 6);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      for (int c = 0; c < 3; ++c)
        picture.at(x, y, c) =
            x + 0.3 * y < 70.0 ? 1.0F + 0.01F * static_cast<float>(x + c * y) + (x > 30 ? 1e-3F : 0.0F) : 0.0F;
  Image exact(width, height), loose(width, height);
  std::ranges::fill(exact.pixels, std::numeric_limits<float>::quiet_NaN());
  convolve(exact, ConvolveMode::Write, {picture}, disc, 0.0, {.threads = 1});
  convolve(loose, ConvolveMode::Add, {picture}, disc, 0.01, {.threads = 2});
  double worst = 0.0, worst_loose = 0.0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) {
        double expected = 0.0;
        for (int k = 0; k < 49; ++k)
          expected += disc.weight[static_cast<std::size_t>(k)][0] * picture.at(x + 6 - k % 7, y + 6 - k / 7, c);
        worst = std::max(worst, std::abs(expected - exact.at(x, y, c)));
        worst_loose = std::max(worst_loose, std::abs(expected - loose.at(x, y, c)));
      }
    }
  }
  CHECK(worst < 1e-5);
  CHECK(worst_loose < 0.01);
  CHECK(worst_loose > 1e-4);  // the step was not refined
}

TEST_CASE("a spot at any level comes back at its position, with its flux and the shape's moments") {
  // A window of a frame of odd size, so that no level's pixels are aligned with the frame's.
  Frame frame{601, 503, 37, 11, 701, 555, 0.02};
  Light light;
  light.radius_rad = 0.01;
  const LightPiece piece = pieces_of(light).front();
  for (int k = 0; k < 10; ++k) {
    const int level = k / 2;
    const Upsampling how = k % 2 == 0 ? Upsampling::Interpolating : Upsampling::Smooth;
    CAPTURE(level);
    const double radius_px = 5.0 * std::exp2(level) + 2.0;
    const double rotation = 0.4;
    const LinearMap map =
        LinearMap{{std::cos(rotation), std::sin(rotation)}, {-0.7 * std::sin(rotation), 0.7 * std::cos(rotation)}} *
        (radius_px / std::tan(light.radius_rad));
    const LinearMap at_level = map * std::exp2(-level);
    ImagePyramid pyramid(frame, how);
    const PyramidFrame at = pyramid.frame_for(level, extent_of(piece, at_level));
    // Fills the pixel of this level that contains a point of the sensor, by the frame's map.
    const Vec2 point = frame.sensor_from_pixel({300.0, 250.0});
    const Vec2 px = at.frame.pixel_from_sensor(point);
    Image spot(at.frame.width, at.frame.height);
    const int x = static_cast<int>(px.x), y = static_cast<int>(px.y);
    for (int c = 0; c < 3; ++c) spot.at(x, y, c) = 1.0F + static_cast<float>(c);
    const Vec2 expected = frame.pixel_from_sensor(at.frame.sensor_from_pixel({x + 0.5, y + 0.5}));
    const double spread = how == Upsampling::Smooth ? smooth_variance(level) : 0.0;
    pyramid.add({spot}, at, make_kernel(piece, at_level, at.moved, spread), 0.0, {});
    const Image flat = std::move(pyramid).flattened({});
    CHECK(std::ranges::all_of(flat.pixels, [](float v) { return v >= 0.0F; }));
    for (int c = 0; c < 3; ++c) {
      const Moments m = moments_of(flat, c);
      CHECK(m.flux == test::approx(1.0 + c).epsilon(1e-5));
      CHECK(length(m.mean - expected) < 0.01 * radius_px);
      const LinearMap wanted = mapped_covariance(map, piece.covariance);
      // A pixel's light is spread over it, with a variance of a twelfth of its side squared about its middle, which is
      // part of the light's own.
      const LinearMap off = m.covariance + LinearMap{} * (std::exp2(2 * level) / 12.0) - wanted;
      CHECK(std::abs(off.x.x) + std::abs(off.y.y) + std::abs(off.x.y) < 0.01 * trace_of(wanted) + 0.2);
    }
  }
}

TEST_CASE("layers that go down early sum to the same") {
  const Frame frame{70, 50, 0, 0, 70, 50, 0.1};
  const auto drawn = [&](bool early) {
    ImagePyramid pyramid(frame);
    for (const int level : {3, 2, 0}) {
      const Kernel kernel = random_kernel({2, 1, 1, 2}, 5);
      const PyramidFrame at = pyramid.frame_for(level, kernel.extent);
      if (early) pyramid.upsample_to(std::max(level, 1), {});
      const Image picture = random_picture(at.frame.width, at.frame.height, 9);
      pyramid.add({picture}, at, kernel, 0.0, {});
      if (level > 0) pyramid.add_sharp(random_picture(70, 50, 4), {});
    }
    return std::move(pyramid).flattened({});
  };
  const Image early = drawn(true), late = drawn(false);
  double worst = 0.0;
  for (std::size_t k = 0; k < late.pixels.size(); ++k)
    worst = std::max(worst, static_cast<double>(std::abs(early.pixels[k] - late.pixels[k])));
  CHECK(worst < 1e-5);
}

TEST_CASE("a part of a sharp picture is added where it belongs, with and without other light") {
  const Frame frame{70, 50, 0, 0, 70, 50, 0.1};
  const Window lit{13, 20, 31, 7};
  Image whole = random_picture(70, 50, 4);
  darken_around(whole, lit);
  const Image cut = cut_out(whole, lit);
  for (const bool has_blurred : {false, true}) {
    const auto drawn = [&](const auto& add) {
      ImagePyramid pyramid(frame);
      const Kernel kernel = random_kernel({2, 1, 1, 2}, 5);
      const PyramidFrame at = pyramid.frame_for(2, kernel.extent);
      const Image blurred = random_picture(at.frame.width, at.frame.height, 9);
      if (has_blurred) pyramid.add({blurred}, at, kernel, 0.0, {});
      add(pyramid);
      return std::move(pyramid).flattened({});
    };
    const Image by_whole = drawn([&](ImagePyramid& pyramid) { pyramid.add_sharp(whole, {}); });
    const Image by_part =
        drawn([&](ImagePyramid& pyramid) { pyramid.add_sharp(PicturePart{cut, lit.left, lit.top}, {}); });
    CHECK(largest_difference(by_whole, by_part) < 1e-5);
  }
}

TEST_CASE("what is drawn at two levels at once comes down as if added at the finer") {
  const Frame frame{64, 48, 0, 0, 64, 48, 0.1};
  ImagePyramid pyramid(frame);
  // The mean over each pixel of a polynomial, at level 2: upsampling preserves it.
  const auto mean = [](double x0, double x1) { return (x1 * x1 * x1 - x0 * x0 * x0) / 3.0 / (x1 - x0) + 100.0; };
  Kernel delta;
  delta.weight = {{1.0, 1.0, 1.0}};
  const PyramidFrame at = pyramid.frame_for(2, {});
  Image picture(at.frame.width, at.frame.height);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      for (int c = 0; c < 3; ++c)
        picture.at(x, y, c) = static_cast<float>(16.0 * mean(4.0 * (at.left + x), 4.0 * (at.left + x + 1)));
  pyramid.add({picture}, at, delta, 0.0, {});
  const Image flat = std::move(pyramid).flattened({});
  for (int x = 0; x < 64; ++x) CHECK(flat.at(x, 20, 1) == test::approx(mean(x, x + 1)).epsilon(1e-4));
}
