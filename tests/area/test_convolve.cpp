// Kernels, convolution, and pictures of several resolutions added up: against plain sums and polynomials.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include <doctest/doctest.h>

#include "render/area/convolve.h"
#include "render/area/layers.h"

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

Kernel random_kernel(KernelReach reach, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> level(0.0, 1.0);
  Kernel kernel;
  kernel.reach = reach;
  for (int k = 0; k < kernel.width() * kernel.height(); ++k)
    kernel.weight.push_back(k % 5 == 0 ? Rgb{} : Rgb{level(random), level(random), level(random)});
  return kernel;
}

// Some rows of a picture, all others of which become dark.
Image cut_to_rows(Image& picture, int top, int rows) {
  Image cut(picture.width, rows);
  for (int y = 0; y < picture.height; ++y) {
    const bool is_kept = y >= top && y < top + rows;
    if (is_kept) std::ranges::copy(picture.row(y), cut.row(y - top).begin());
    if (!is_kept) std::ranges::fill(picture.row(y), 0.0F);
  }
  return cut;
}

// The light's flux and first and second moments about a place.
struct Moments {
  double flux = 0.0;
  Vec2 mean;
  LinearMap covariance = kNowhere;
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
    convolve(sum, ConvolveMode::Add, picture, 0, kernel, 0.0, {.threads = 1});
    convolve(again, ConvolveMode::Add, picture, 0, kernel, 0.0, {.threads = 3});
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

TEST_CASE("rows without light may be left out, wherever they are, of smooth pictures, too") {
  Kernel disc;
  disc.reach = {2, 2, 2, 2};
  for (int k = 0; k < 25; ++k) disc.weight.push_back({0.04, 0.04, 0.04});
  for (const Kernel& kernel : {random_kernel({3, 1, 2, 4}, 7), disc}) {
    for (const int top : {0, 3, 11}) {
      for (const int rows : {0, 1, 2, 9}) {
        CAPTURE(top);
        CAPTURE(rows);
        Image whole(70 + kernel.width() - 1, 30 + kernel.height() - 1);
        for (std::size_t k = 0; k < whole.pixels.size(); ++k) whole.pixels[k] = 1e-3F * static_cast<float>(k % 217);
        for (float& v : whole.row(top)) v = 0.0F;  // light may begin with the row after
        const Image cut = cut_to_rows(whole, top, rows);
        Image by_whole = random_picture(70, 30, 5), by_rows = by_whole;
        for (const ConvolveMode mode : {ConvolveMode::Add, ConvolveMode::Write}) {
          convolve(by_whole, mode, whole, 0, kernel, 0.01, {.threads = 2});
          convolve(by_rows, mode, cut, top, kernel, 0.01, {.threads = 2});
          double worst = 0.0;
          for (std::size_t k = 0; k < by_whole.pixels.size(); ++k)
            worst = std::max(worst, static_cast<double>(std::abs(by_whole.pixels[k] - by_rows.pixels[k])));
          CHECK(worst < 0.01);  // rows at a picture's border count as rough
        }
      }
    }
  }
}

TEST_CASE("white kernels, and what is linear under them") {
  Kernel disc;
  disc.reach = {3, 3, 3, 3};
  double sum = 0.0;
  for (int k = 0; k < 49; ++k) {
    const double w = std::hypot(k % 7 - 3, k / 7 - 3) < 3.2 ? 1.0 : 0.0;
    disc.weight.push_back({w, w, w});
    sum += w;
  }
  for (Rgb& w : disc.weight) w = {w[0] / sum, w[1] / sum, w[2] / sum};
  // A ramp that ends along a slanted edge, dark beyond, and a faint step across it.
  const int width = 90, height = 40;
  Image picture(width + 6, height + 6);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      for (int c = 0; c < 3; ++c)
        picture.at(x, y, c) =
            x + 0.3 * y < 70.0 ? 1.0F + 0.01F * static_cast<float>(x + c * y) + (x > 30 ? 1e-3F : 0.0F) : 0.0F;
  Image exact(width, height), loose(width, height);
  std::ranges::fill(exact.pixels, std::numeric_limits<float>::quiet_NaN());
  convolve(exact, ConvolveMode::Write, picture, 0, disc, 0.0, {.threads = 1});
  convolve(loose, ConvolveMode::Add, picture, 0, disc, 0.01, {.threads = 2});
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
  CHECK(worst_loose > 1e-4);  // the step was left as it is
}

TEST_CASE("a spot at any level comes back at its place, with its flux and the shape's moments") {
  // A frame cut out of one of an odd size, so that no level's pixels begin with the frame's.
  Frame frame{601, 503, 37, 11, 701, 555, 0.02};
  Light light;
  light.radius_rad = 0.01;
  const LightPiece piece = pieces_of(light).front();
  for (int level = 0; level < 5; ++level) {
    CAPTURE(level);
    const double radius_px = 5.0 * std::exp2(level) + 2.0;
    const double turn = 0.4;
    const LinearMap map = LinearMap{{std::cos(turn), std::sin(turn)}, {-0.7 * std::sin(turn), 0.7 * std::cos(turn)}} *
                          (radius_px / std::tan(light.radius_rad));
    const LinearMap at_level = map * std::exp2(-level);
    Layers layers(frame);
    const LayerFrame at = layers.frame_for(level, reach_of(piece, at_level));
    // The pixel of this level that holds a point of the sensor, filled: the frame says where that is.
    const Vec2 place = frame.sensor_from_pixel({300.0, 250.0});
    const Vec2 px = at.frame.pixel_from_sensor(place);
    Image spot(at.frame.width, at.frame.height);
    const int x = static_cast<int>(px.x), y = static_cast<int>(px.y);
    for (int c = 0; c < 3; ++c) spot.at(x, y, c) = 1.0F + static_cast<float>(c);
    const Vec2 expected = frame.pixel_from_sensor(at.frame.sensor_from_pixel({x + 0.5, y + 0.5}));
    layers.add(spot, 0, at, make_kernel(piece, at_level, at.moved), 0.0, {});
    const Image flat = std::move(layers).flattened({});
    for (int c = 0; c < 3; ++c) {
      const Moments m = moments_of(flat, c);
      CHECK(m.flux == doctest::Approx(1.0 + c).epsilon(1e-5));
      CHECK(length(m.mean - expected) < 0.01 * radius_px);
      const LinearMap wanted = mapped_covariance(map, piece.covariance);
      // A pixel's light lies anywhere in it, a twelfth of its square about its middle, which counts as the light's own.
      const LinearMap off = m.covariance + LinearMap{} * (std::exp2(2 * level) / 12.0) - wanted;
      CHECK(std::abs(off.x.x) + std::abs(off.y.y) + std::abs(off.x.y) < 0.01 * trace_of(wanted) + 0.2);
    }
  }
}

TEST_CASE("layers that go down early sum to the same") {
  const Frame frame{70, 50, 0, 0, 70, 50, 0.1};
  const auto drawn = [&](bool early) {
    Layers layers(frame);
    for (const int level : {3, 2, 0}) {
      const Kernel kernel = random_kernel({2, 1, 1, 2}, 5);
      const LayerFrame at = layers.frame_for(level, kernel.reach);
      if (early) layers.descend_to(std::max(level, 1), {});
      layers.add(random_picture(at.frame.width, at.frame.height, 9), 0, at, kernel, 0.0, {});
      if (level > 0) layers.add_sharp(random_picture(70, 50, 4), 0, {});
    }
    return std::move(layers).flattened({});
  };
  const Image early = drawn(true), late = drawn(false);
  double worst = 0.0;
  for (std::size_t k = 0; k < late.pixels.size(); ++k)
    worst = std::max(worst, static_cast<double>(std::abs(early.pixels[k] - late.pixels[k])));
  CHECK(worst < 1e-5);
}

TEST_CASE("some rows of a sharp picture are added where they belong, before and after other light") {
  const Frame frame{70, 50, 0, 0, 70, 50, 0.1};
  Image whole = random_picture(70, 50, 4);
  const Image rows = cut_to_rows(whole, 20, 7);
  for (const bool has_blurred : {false, true}) {
    const auto drawn = [&](const Image& sharp, int top) {
      Layers layers(frame);
      const Kernel kernel = random_kernel({2, 1, 1, 2}, 5);
      const LayerFrame at = layers.frame_for(2, kernel.reach);
      if (has_blurred) layers.add(random_picture(at.frame.width, at.frame.height, 9), 0, at, kernel, 0.0, {});
      layers.add_sharp(sharp, top, {});
      return std::move(layers).flattened({});
    };
    const Image by_whole = drawn(whole, 0), by_rows = drawn(rows, 20);
    double worst = 0.0;
    for (std::size_t k = 0; k < by_whole.pixels.size(); ++k)
      worst = std::max(worst, static_cast<double>(std::abs(by_whole.pixels[k] - by_rows.pixels[k])));
    CHECK(worst < 1e-5);
  }
}

TEST_CASE("what is drawn at two levels at once comes down as if added at the finer") {
  const Frame frame{64, 48, 0, 0, 64, 48, 0.1};
  Layers layers(frame);
  // The mean over each pixel of a polynomial, at level 2: halves keep it.
  const auto mean = [](double x0, double x1) { return (x1 * x1 * x1 - x0 * x0 * x0) / 3.0 / (x1 - x0) + 100.0; };
  Kernel delta;
  delta.weight = {{1.0, 1.0, 1.0}};
  const LayerFrame at = layers.frame_for(2, {});
  Image picture(at.frame.width, at.frame.height);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      for (int c = 0; c < 3; ++c)
        picture.at(x, y, c) = static_cast<float>(16.0 * mean(4.0 * (at.left + x), 4.0 * (at.left + x + 1)));
  layers.add(picture, 0, at, delta, 0.0, {});
  const Image flat = std::move(layers).flattened({});
  for (int x = 0; x < 64; ++x) CHECK(flat.at(x, 20, 1) == doctest::Approx(mean(x, x + 1)).epsilon(1e-4));
}
