// SPDX-License-Identifier: Apache-2.0
#include "render/stop_patterns/pattern_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

namespace contrejour::inline internal::stop_patterns {
namespace {

constexpr double kFluxBeyond = 0.01;  // fraction that may be left out
constexpr int kSectorsOfQuadrant = 12;
constexpr int kSectors = 4 * kSectorsOfQuadrant;

// Sectors are spaced evenly along the square |x| + |y| = 1, which requires no angles.
int sector_of(double x, double y) {
  const double along = kSectorsOfQuadrant / (std::abs(x) + std::abs(y));
  const double sector_angle =
      x >= 0.0 ? (y >= 0.0 ? y * along : 4 * kSectorsOfQuadrant + y * along) : 2 * kSectorsOfQuadrant - y * along;
  return std::clamp(static_cast<int>(sector_angle), 0, kSectors - 1);
}
Vec2 direction_at(double sector) {
  const double quadrant = std::floor(sector / kSectorsOfQuadrant), fraction = sector / kSectorsOfQuadrant - quadrant;
  const Vec2 first = Vec2{1.0 - fraction, fraction} * (1.0 / std::hypot(1.0 - fraction, fraction));
  const auto turns = static_cast<int>(quadrant) % 4;
  return turns == 0   ? first
         : turns == 1 ? Vec2{-first.y, first.x}
         : turns == 2 ? first * -1.0
                      : Vec2{first.y, -first.x};
}

// The bounding polygon of each sector of a disc of radius 1: of the ends and the middle of its arc.
const std::array<BoundingPolygon, kSectors>& sector_hulls() {
  static const auto all = [] {
    std::array<BoundingPolygon, kSectors> hulls;
    for (std::size_t sector = 0; sector < hulls.size(); ++sector)
      for (const double at : {0.0, 0.5, 1.0}) hulls[sector].include(direction_at(static_cast<double>(sector) + at));
    return hulls;
  }();
  return all;
}

// The number of elements that pass a test, of which all that pass come first. The search starts at a guess and does not
// read elements far from the result.
template <class T, class Test>
std::size_t count_passing(std::span<const T> all, std::size_t guess, const Test& test) {
  std::size_t low = std::min(guess, all.size()), high = low;
  for (std::size_t step = 1; high < all.size() && test(all[high]); step *= 2) {
    low = high + 1;
    high = std::min(high + step, all.size());
  }
  for (std::size_t step = 1; low > 0 && !test(all[low - 1]); step *= 2) {
    high = low - 1;
    low -= std::min(low, step);
  }
  const auto between = all.subspan(low, high - low);
  return low + static_cast<std::size_t>(std::ranges::partition_point(between, test) - between.begin());
}

}  // namespace

PatternTexture::PatternTexture(int side, double extent, std::vector<float> samples)
    : picture_(side, extent, std::move(samples)) {
  find_remainders();
}

// What each ring of each sector contains itself.
std::vector<PatternTexture::SectorRemainder> PatternTexture::sector_rings() const {
  const auto pitch = static_cast<float>(2.0 * extent() / side());
  const float area = pitch * pitch;
  const std::size_t steps = rings() + 1;
  std::vector<SectorRemainder> out(kSectors * steps);
  const float* value = samples().data();
  for (int row = 0; row < side(); ++row) {
    const double y = 0.5 * side() - row - 0.5;
    for (int column = 0; column < side(); ++column, ++value) {
      const double x = column + 0.5 - 0.5 * side();
      const std::size_t ring = std::min(static_cast<std::size_t>(std::sqrt(x * x + y * y)), rings());
      SectorRemainder& remainder = out[static_cast<std::size_t>(sector_of(x, y)) * steps + ring];
      remainder.brightest = std::max(remainder.brightest, *value);
      remainder.flux += *value * area;
      remainder.squared += *value * *value * area;
    }
  }
  return out;
}

// Sums, from each ring outwards, over all sectors and by sector.
void PatternTexture::find_remainders() {
  sector_remainders_ = sector_rings();
  const std::size_t steps = rings() + 1;
  remainders_.assign(steps, {});
  for (std::size_t k = 0; k < sector_remainders_.size(); ++k) {
    const SectorRemainder& from = sector_remainders_[k];
    Remainder& to = remainders_[k % steps];
    to = {std::max(to.brightest, static_cast<double>(from.brightest)), to.squared + from.squared, to.flux + from.flux};
  }
  const auto add_outer = [&](auto* of) {
    for (std::size_t k = steps - 1; k-- > 0;) {
      of[k].brightest = std::max(of[k].brightest, of[k + 1].brightest);
      of[k].squared += of[k + 1].squared;
      of[k].flux += of[k + 1].flux;
    }
  };
  add_outer(remainders_.data());
  for (std::size_t sector = 0; sector < kSectors; ++sector) add_outer(&sector_remainders_[sector * steps]);
}

BoundingPolygon PatternTexture::bounding_polygon_above(double level, double flux) const {
  const std::size_t steps = rings() + 1;
  const double max_flux = flux * remainders_.front().flux / kSectors;
  const auto bright = [&](const SectorRemainder& remainder) {
    return remainder.brightest > level || remainder.flux > max_flux;
  };
  BoundingPolygon bounding_polygon;
  std::size_t dark = steps / 2;
  for (std::size_t sector = 0; sector < kSectors; ++sector) {
    dark = count_passing(std::span(sector_remainders_).subspan(sector * steps, steps), dark, bright);
    const double radius = std::min(static_cast<double>(dark) * 2.0 * extent() / side(), extent());
    bounding_polygon.include(sector_hulls()[sector], radius);
  }
  return bounding_polygon;
}

double PatternTexture::radius_above(double level) const {
  const double max_flux = kFluxBeyond * remainders_.front().flux;
  const auto bright = [&](const Remainder& remainder) {
    return remainder.brightest > level || remainder.flux > max_flux;
  };
  const auto first = std::partition_point(remainders_.begin(), remainders_.end(), bright);
  return std::min(static_cast<double>(first - remainders_.begin()) * 2.0 * extent() / side(), extent());
}

const PatternTexture::Remainder& PatternTexture::remainder_beyond(double radius) const {
  const double ring = std::max(radius, 0.0) * 0.5 * side() / extent();
  return remainders_[std::min(static_cast<std::size_t>(ring), remainders_.size() - 1)];
}

double PatternTexture::brightest_beyond(double radius) const { return remainder_beyond(radius).brightest; }
double PatternTexture::squared_beyond(double radius) const { return remainder_beyond(radius).squared; }

double PatternTexture::flux() const {
  const double pitch = 2.0 * extent() / side();
  return std::accumulate(samples().begin(), samples().end(), 0.0) * pitch * pitch;
}

}  // namespace contrejour::inline internal::stop_patterns
