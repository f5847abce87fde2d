// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/light_pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace contrejour::inline internal::area {
namespace {

constexpr int kDiscSide = 32;         // pixels across a disc,
constexpr int kPieceSide = 12;        // or across a piece of it where these are more
constexpr int kDiscSubsamples = 8;    // samples along a side of a pixel at its rim
constexpr int kMaxSamplesAcross = 64;  // of a piece

// A uniform disc whose diameter is `side` pixels.
Image disc(int side) {
  Image level(side, side, 1);
  const double radius = 0.5 * side;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      int inside = 0;
      for (int k = 0; k < kDiscSubsamples * kDiscSubsamples; ++k) {
        const double u = x + (k % kDiscSubsamples + 0.5) / kDiscSubsamples - radius;
        const double v = y + (k / kDiscSubsamples + 0.5) / kDiscSubsamples - radius;
        if (u * u + v * v <= radius * radius) ++inside;
      }
      level.at(x, y) = static_cast<float>(inside) / (kDiscSubsamples * kDiscSubsamples);
    }
  }
  return level;
}

LightShape shape_of(const Light& light, int across) {
  if (light.shape) return *light.shape;
  const int side = std::max(kDiscSide, kPieceSide * across);
  const double pixel = 2.0 * std::tan(light.radius_rad) / side;
  return {disc(side), {0.5 * side, 0.5 * side}, {pixel, 0.0}, {0.0, -pixel}};
}

// Tents over `count` equal parts of the pixels [0, length); they add up to 1 everywhere.
struct Tents {
  int count = 1;
  double length = 1.0;

  [[nodiscard]] double at(int tent, double px) const {
    if (count == 1) return 1.0;
    const double position = std::clamp(px / length * count - 0.5, 0.0, count - 1.0);
    return std::max(0.0, 1.0 - std::abs(position - tent));
  }
};

// The sum of each channel; a single channel counts as all three.
Rgb channel_sums(const Image& level) {
  Rgb sum{};
  for (std::size_t k = 0; k < level.pixels.size(); ++k) {
    if (level.channels == 1) {
      for (double& s : sum) s += level.pixels[k];
    } else {
      sum[k % 3] += level.pixels[k];
    }
  }
  return sum;
}

Rgb level_at(const Image& level, int x, int y) {
  if (level.channels == 1) return {level.at(x, y), level.at(x, y), level.at(x, y)};
  return {level.at(x, y, 0), level.at(x, y, 1), level.at(x, y, 2)};
}

double total(const Rgb& rgb) { return rgb[0] + rgb[1] + rgb[2]; }

// Sets the covariance of the samples and makes their positions relative to their centroid, which it returns.
Vec2 centre(LightPiece& piece) {
  Vec2 mean;
  double weight = 0.0;
  for (const ShapeSample& s : piece.samples) {
    mean = mean + s.at * total(s.fraction);
    weight += total(s.fraction);
  }
  mean = mean * (1.0 / weight);
  LinearMap sum = kZeroMap;
  for (ShapeSample& s : piece.samples) {
    s.at = s.at - mean;
    const double w = total(s.fraction) / weight;
    sum = sum + LinearMap{s.at * (w * s.at.x), s.at * (w * s.at.y)};
  }
  // The variance of each sample's square: a twelfth of its sides' squares.
  const LinearMap square{piece.right, piece.down};
  piece.covariance = sum + square * transposed(square) * (1.0 / 12.0);
  return mean;
}

// The part of a shape under two tents; without samples if it is dark.
LightPiece piece_of(const Light& light, const LightShape& shape, const Rgb& whole, const Tents& across, int column,
                    const Tents& down, int row) {
  LightPiece piece;
  piece.right = shape.right;
  piece.down = shape.down;
  Rgb sum{};
  for (int y = 0; y < shape.level.height; ++y) {
    const double weight_y = down.at(row, y + 0.5);
    for (int x = 0; weight_y > 0.0 && x < shape.level.width; ++x) {
      const double weight = weight_y * across.at(column, x + 0.5);
      Rgb fraction = level_at(shape.level, x, y);
      const double of_all = total(fraction) / total(whole);
      for (std::size_t c = 0; c < 3; ++c) {
        fraction[c] = weight * (whole[c] > 0.0 ? fraction[c] / whole[c] : of_all);
        sum[c] += fraction[c];
      }
      if (!(total(fraction) > 0.0)) continue;
      const Vec2 from = Vec2{x + 0.5, y + 0.5} - shape.centre_px;
      piece.samples.push_back({shape.right * from.x + shape.down * from.y, fraction});
    }
  }
  if (piece.samples.empty()) return piece;
  const Vec2 middle = centre(piece);
  piece.middle = middle;
  piece.point = light;
  piece.point.radius_rad = 0.0;
  piece.point.shape = nullptr;
  piece.point.direction = offset_direction(light.direction, middle);
  for (std::size_t c = 0; c < 3; ++c) piece.point.value[c] = light.value[c] * sum[c];
  for (ShapeSample& s : piece.samples)
    for (std::size_t c = 0; c < 3; ++c) s.fraction[c] = sum[c] > 0.0 ? s.fraction[c] / sum[c] : 0.0;
  return piece;
}

}  // namespace

LightPiece soft_piece() {
  constexpr int kSide = 16;
  LightPiece piece;
  Rgb sum{};
  for (int k = 0; k < kSide * kSide; ++k) {
    const double u = (k % kSide + 0.5) * 2.0 / kSide - 1.0, v = (k / kSide + 0.5) * 2.0 / kSide - 1.0;
    const double fraction = (1.0 - std::abs(u)) * (1.0 - std::abs(v));
    piece.samples.push_back({{u, v}, {fraction, fraction, fraction}});
    for (double& s : sum) s += fraction;
  }
  for (ShapeSample& s : piece.samples)
    for (std::size_t c = 0; c < 3; ++c) s.fraction[c] /= sum[c];
  piece.right = {2.0 / kSide, 0.0};
  piece.down = {0.0, -2.0 / kSide};
  centre(piece);
  const double scale = 1.0 / std::sqrt(piece.covariance.x.x);
  for (ShapeSample& s : piece.samples) s.at = s.at * scale;
  piece.right = piece.right * scale;
  piece.down = piece.down * scale;
  piece.covariance = {};
  piece.is_symmetric = true;
  return piece;
}

std::vector<LightPiece> pieces_of(const Light& light, int across) {
  std::vector<LightPiece> pieces;
  if (light.is_point()) {
    pieces.push_back({light, {}, {}, {}, kZeroMap, {}, true, true});
    return pieces;
  }
  const LightShape given = shape_of(light, across);
  const double width = given.level.width * length(given.right), height = given.level.height * length(given.down);
  const double longest = std::max(width, height);
  // A shape without a size, or with one that is not finite, stays undivided; planning rejects it if it is invalid.
  const bool has_size = longest > 0.0 && std::isfinite(width) && std::isfinite(height);
  const auto parts = [&](double side) {
    if (!has_size) return 1;
    return std::max(1, static_cast<int>(std::ceil(across * side / longest - 1e-9)));
  };
  const int parts_x = parts(width), parts_y = parts(height);
  const int by =
      std::max(given.level.width / (kMaxSamplesAcross * parts_x), given.level.height / (kMaxSamplesAcross * parts_y)) +
      1;
  const LightShape shape = coarser(given, light.shape ? by : 1);
  const Rgb whole = channel_sums(shape.level);
  const Tents columns{parts_x, static_cast<double>(shape.level.width)};
  const Tents rows{parts_y, static_cast<double>(shape.level.height)};
  for (int row = 0; row < parts_y; ++row) {
    for (int column = 0; column < parts_x; ++column) {
      LightPiece piece = piece_of(light, shape, whole, columns, column, rows, row);
      if (piece.samples.empty() || !(piece.point.direction.z > 0.0)) continue;
      piece.is_disc = !light.shape && parts_x == 1 && parts_y == 1;
      piece.is_symmetric = piece.is_disc || parts_x * parts_y > 1;
      pieces.push_back(std::move(piece));
    }
  }
  // The light is entirely behind the camera or nowhere: planning rejects such a point with an error message.
  if (pieces.empty()) {
    Light point = light;
    point.radius_rad = 0.0;
    point.shape = nullptr;
    pieces.push_back({point, {}, {}, {}, kZeroMap, {}, true, true});
  }
  return pieces;
}

}  // namespace contrejour::inline internal::area
