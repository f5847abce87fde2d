// SPDX-License-Identifier: Apache-2.0
#include "render/stop_patterns/dirt_diffraction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include "base/scalar.h"

namespace contrejour::inline internal::stop_patterns {
namespace {

constexpr double kSharpSpeck = 5.5;  // in units of sqrt(lambda z): the rim of wider specks is nearly straight
constexpr double kSlicesOfUnit = 3.5;
constexpr double kSizesPerOctave = 4.0;  // classes of specks with a common flux
constexpr double kMinLevel = 0.01, kMaxLevel = 2.0;
constexpr int kMaxCells = 384;  // across the plane
constexpr double kCellsOfRadius = 2.0;
constexpr int kMaxTiles = 512;  // a side; finer fringes are not sampled
constexpr unsigned kFewTiles = 2;  // tiles between the first and last that a disc meets, for which they are examined
constexpr double kNearlyStraight = 1e-6;  // rad, as dirt.cpp's
constexpr double kCleanWithin = 0.003;  // relative to the level
constexpr double kOneSample = 2.0, kFewSamples = 5.0;  // samples across a square that is averaged
constexpr double kStepOfUnit = 0.3;  // in units: a wider square is averaged in parts
constexpr double kMaxParts = 6.0;
constexpr double kFluxSteps = 32.0;  // per unit

bool is_speck(const DirtStroke& s) { return s.length_mm < s.width_mm; }
double area_of(const DirtStroke& s) { return s.width_mm * (s.length_mm + 0.25 * kPi * s.width_mm); }

// The mean of sqrt(r^2 - y^2) from `low` to `high`.
double mean_half_chord(double r, double low, double high) {
  const auto integral = [&](double y) {
    const double c = std::clamp(y / r, -1.0, 1.0);
    return 0.5 * r * r * (c * std::sqrt(1.0 - c * c) + std::asin(c));
  };
  return (integral(high) - integral(low)) / (high - low);
}

// The fraction of a stroke's line that lies in the square from -extent to extent.
double fraction_within(const DirtStroke& s, double extent) {
  constexpr int kSteps = 32;
  int inside = 0;
  for (int k = 0; k < kSteps; ++k) {
    const Vec2 at = s.at((k + 0.5) / kSteps - 0.5);
    if (std::max(std::abs(at.x), std::abs(at.y)) < extent) ++inside;
  }
  return static_cast<double>(inside) / kSteps;
}

}  // namespace

// The samples of a tile, and the first ones beyond it, so that a look-up needs one tile only.
struct DirtDiffraction::Tile {
  static constexpr int kSide = 32;
  bool is_clean = true;
  std::array<float, (kSide + 1) * (kSide + 1)> lost{};
};

DirtDiffraction::DirtDiffraction(std::span<const DirtStroke> shapes, double extent_mm, double lambda_z_mm2,
                                 std::shared_ptr<const StraightEdge> edge)
    : extent_mm_(extent_mm), fringe_unit_mm_(std::sqrt(lambda_z_mm2)), per_mm_(1.0 / fringe_unit_mm_),
      edge_(std::move(edge)), pitch_mm_(fringe_unit_mm_ / kSamplesOfUnit) {
  add_shapes(shapes);
  sort_into_cells();
  if (2.0 * extent_mm > Tile::kSide * kMaxTiles * pitch_mm_) pitch_mm_ = 0.0;
  double pitch_mm = pitch_mm_;
  for (Level& level : levels_) {
    if (!(pitch_mm > 0.0)) break;
    level.per_mm = 1.0 / pitch_mm;
    level.tiles = static_cast<unsigned>(2.0 * extent_mm / (Tile::kSide * pitch_mm)) + 1;
    level.tile = std::vector<std::atomic<const Tile*>>(static_cast<std::size_t>(level.tiles) * level.tiles);
    pitch_mm *= 2.0;
  }
}

DirtDiffraction::~DirtDiffraction() {
  for (const Level& level : levels_)
    for (const auto& tile : level.tile) delete tile.load();
}

DirtDiffraction::Shape DirtDiffraction::shape_of(const DirtStroke& stroke) const {
  Shape shape;
  shape.stroke = stroke;
  shape.amplitude = static_cast<float>(1.0 - std::sqrt(1.0 - stroke.opacity));
  shape.along = {std::cos(stroke.angle_rad), std::sin(stroke.angle_rad)};
  const double width = stroke.width_mm * per_mm_, length = stroke.length_mm * per_mm_;
  if (is_speck(stroke)) {
    if (width > kSharpSpeck) return shape;
    shape.slices = std::clamp(static_cast<int>(std::ceil(kSlicesOfUnit * width)), 1, kMaxSlices);
    for (int k = 0; k < shape.slices; ++k) {
      const double low = width * (static_cast<double>(k) / shape.slices - 0.5), high = low + width / shape.slices;
      shape.half_length[static_cast<std::size_t>(k)] =
          static_cast<float>(0.5 * length + mean_half_chord(0.5 * width, low, high));
    }
  } else if (std::abs(stroke.bend_rad) > kNearlyStraight) {
    shape.radius_mm = stroke.length_mm / stroke.bend_rad;
    shape.bent_about_mm = stroke.middle_mm + Vec2{-shape.along.y, shape.along.x} * shape.radius_mm;
    const double inner_mm = 0.5 * stroke.length_mm - StraightEdge::kReach * fringe_unit_mm_;
    if (inner_mm > 0.0) shape.inner_cosine = std::cos(inner_mm / std::abs(shape.radius_mm));
  }
  return shape;
}

// Integrates over rings about the axis of a round speck. width: in units.
DirtDiffraction::Speck DirtDiffraction::speck_of(double width) const {
  Speck out{0.0, 0.0};
  const Shape shape = shape_of({{}, 0.0, 0.0, width * fringe_unit_mm_, 0.0, 1.0});
  const double end = 0.5 * width + StraightEdge::kReach, step = 1.0 / kFluxSteps;
  for (double r = 0.5 * step; r < end; r += step) {
    const double power = std::norm(speck_wave(shape, {r, 0.0}));
    out.power += 2.0 * kPi * r * step * power;
    if (power > kMinWave * kMinWave) out.outer_radius = r + step - 0.5 * width;
  }
  out.power /= 0.25 * kPi * width * width;
  return out;
}

// Sets how far a shape's wave is strong enough to be drawn, and the light that it takes there: the integral over the
// plane of 1 - |1 - a D|^2, where the wave D integrates to the shape's area. Returns false if the wave is too weak
// everywhere.
bool DirtDiffraction::set_outer_radius(Shape& shape, std::map<int, Speck>& specks, double& taken_mm2) const {
  const DirtStroke& stroke = shape.stroke;
  const double width = stroke.width_mm * per_mm_;
  shape.outer_radius_mm = StraightEdge::kReach * fringe_unit_mm_;
  if (!is_speck(stroke)) {
    if (shape.amplitude * std::abs(slit(0.0, 0.5 * width)) < kMinWave) return false;
    taken_mm2 = scratch_flux(shape);
    return true;
  }
  if (shape.slices == 0) {
    taken_mm2 = stroke.opacity * area_of(stroke);
    return true;
  }
  // The speck is treated as a round one of the same area.
  const double diameter = 2.0 * std::sqrt(area_of(stroke) / kPi) * per_mm_;
  const int size = static_cast<int>(std::lround(kSizesPerOctave * std::log2(diameter)));
  const auto [at, is_new] = specks.try_emplace(size);
  if (is_new) at->second = speck_of(std::exp2(size / kSizesPerOctave));
  shape.outer_radius_mm = std::min(shape.outer_radius_mm, at->second.outer_radius * fringe_unit_mm_);
  taken_mm2 = area_of(stroke) * shape.amplitude * (2.0 - shape.amplitude * at->second.power);
  return shape.outer_radius_mm > 0.0;
}

double DirtDiffraction::scratch_flux(const Shape& shape) const {
  const double half = 0.5 * shape.stroke.width_mm * per_mm_, end = half + StraightEdge::kReach;
  const double step = std::min(1.0 / kFluxSteps, half / 4.0);
  const auto steps = static_cast<int>(std::min(std::ceil(end / step), 2048.0));
  double across = 0.0;
  for (int k = 0; k < steps; ++k)
    across += 2.0 * end / steps * (1.0 - std::norm(1.0F - shape.amplitude * slit((k + 0.5) * end / steps, half)));
  return across * fringe_unit_mm_ * area_of(shape.stroke) / shape.stroke.width_mm;
}

// Each shape must take as much light as its sharp shadow: the difference is spread evenly over the plane.
void DirtDiffraction::add_shapes(std::span<const DirtStroke> shapes) {
  std::map<int, Speck> specks;
  double spread_mm2 = 0.0;
  for (const DirtStroke& stroke : shapes) {
    Shape shape = shape_of(stroke);
    double taken_mm2 = 0.0;
    const bool is_visible = set_outer_radius(shape, specks, taken_mm2);
    if (!is_visible) taken_mm2 = 0.0;
    spread_mm2 += (stroke.opacity * area_of(stroke) - taken_mm2) * fraction_within(stroke, extent_mm_);
    if (is_visible) shapes_.push_back(std::move(shape));
  }
  level_ = std::clamp(1.0 - spread_mm2 / (4.0 * extent_mm_ * extent_mm_), kMinLevel, kMaxLevel);
}

DirtDiffraction::Wave DirtDiffraction::wave(const Shape& shape, Vec2 at_mm) const {
  if (!is_speck(shape.stroke)) return scratch_wave(shape, at_mm);
  const Vec2 from = at_mm - shape.stroke.middle_mm;
  const Vec2 own{dot(shape.along, from), cross(shape.along, from)};
  if (shape.slices > 0) return speck_wave(shape, own * per_mm_);
  const double beyond = std::max(0.0, std::abs(own.x) - 0.5 * shape.stroke.length_mm);
  const double t = std::sqrt(beyond * beyond + own.y * own.y);
  return edge_->at((0.5 * shape.stroke.width_mm - t) * per_mm_);
}

// own: coordinates along and across the speck, in units.
DirtDiffraction::Wave DirtDiffraction::speck_wave(const Shape& shape, Vec2 own) const {
  const double width = shape.stroke.width_mm * per_mm_, slice = width / shape.slices;
  Wave sum = 0.0F, above = edge_->at(own.y + 0.5 * width);
  for (int k = 0; k < shape.slices; ++k) {
    const Wave below = edge_->at(own.y + 0.5 * width - (k + 1) * slice);
    sum += (above - below) * slit(own.x, shape.half_length[static_cast<std::size_t>(k)]);
    above = below;
  }
  return sum;
}

// The wave of a slit along the scratch's line. Points near a curved scratch are measured along and across its circle.
DirtDiffraction::Wave DirtDiffraction::scratch_wave(const Shape& shape, Vec2 at_mm) const {
  const DirtStroke& s = shape.stroke;
  const double half_width = 0.5 * s.width_mm * per_mm_;
  const double half_length = 0.5 * (s.length_mm + 0.25 * kPi * s.width_mm) * per_mm_;
  if (shape.radius_mm == 0.0) {
    const Vec2 from = (at_mm - s.middle_mm) * per_mm_;
    return slit(cross(shape.along, from), half_width) * slit(dot(shape.along, from), half_length);
  }
  const double side = std::copysign(1.0, shape.radius_mm), radius_mm = std::abs(shape.radius_mm);
  const Vec2 about = at_mm - shape.bent_about_mm;
  const double distance_mm = std::sqrt(dot(about, about));
  const Wave across = slit((radius_mm - distance_mm) * per_mm_, half_width);
  const double to_middle = -side * cross(shape.along, about);  // times the cosine of the angle from the middle
  if (to_middle > shape.inner_cosine * distance_mm || across == 0.0F) return across;
  return across * slit(std::atan2(dot(shape.along, about), to_middle) * radius_mm * per_mm_, half_length);
}

// A counting sort: the shapes of each cell are contiguous, with ascending indices.
void DirtDiffraction::sort_into_cells() {
  double outer_radius = 0.0;
  for (const Shape& shape : shapes_) outer_radius = std::max(outer_radius, shape.outer_radius_mm);
  cells_ = std::clamp(static_cast<int>(kCellsOfRadius * 2.0 * extent_mm_ / std::max(outer_radius, 1e-9)), 1, kMaxCells);
  const double cell_mm = 2.0 * extent_mm_ / cells_;
  const CellFlags grid(cells_, extent_mm_, [](int, int) { return false; });
  const auto for_each_cell = [&](auto visit) {
    for (std::uint32_t k = 0; k < shapes_.size(); ++k) {
      const Shape& shape = shapes_[k];
      const Vec2 middle = shape.stroke.middle_mm;
      const double around = shape.around_mm();
      for (int y = grid.cell_of(middle.y - around); y <= grid.cell_of(middle.y + around); ++y)
        for (int x = grid.cell_of(middle.x - around); x <= grid.cell_of(middle.x + around); ++x) {
          const Vec2 at{(x + 0.5) * cell_mm - extent_mm_, (y + 0.5) * cell_mm - extent_mm_};
          if (shape.stroke.distance_mm(at) <= shape.outer_radius_mm + cell_mm)
            visit(static_cast<std::size_t>(y * cells_ + x), k);
        }
    }
  };
  first_.assign(static_cast<std::size_t>(cells_) * static_cast<std::size_t>(cells_) + 1, 0);
  for_each_cell([&](std::size_t cell, std::uint32_t) { ++first_[cell + 1]; });
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  shapes_of_cell_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for_each_cell([&](std::size_t cell, std::uint32_t k) { shapes_of_cell_[next[cell]++] = k; });
  dirty_ = CellFlags(cells_, extent_mm_, [&](int x, int y) { return !shapes_about(x, y).empty(); });
}

// The transmittance relative to the level: the squared product of the waves plus the light that is spread over the
// plane (level_ - 1, which may be negative), and not below zero.
double DirtDiffraction::transmitted(Wave amplitude) const {
  return std::max(0.0, (static_cast<double>(std::norm(amplitude)) + level_ - 1.0) / level_);
}

double DirtDiffraction::transmitted(Vec2 at_mm) const {
  Wave all = 1.0F;
  for (const std::uint32_t k : shapes_about(dirty_.cell_of(at_mm.x), dirty_.cell_of(at_mm.y))) {
    const Shape& shape = shapes_[k];
    const Vec2 from = at_mm - shape.stroke.middle_mm;
    if (dot(from, from) < shape.around_mm() * shape.around_mm()) all *= 1.0F - shape.amplitude * wave(shape, at_mm);
  }
  return transmitted(all);
}

std::span<const std::uint32_t> DirtDiffraction::shapes_about(int x, int y) const {
  const auto cell = static_cast<std::size_t>(y * cells_ + x);
  return {shapes_of_cell_.data() + first_[cell], first_[cell + 1] - first_[cell]};
}

std::unique_ptr<DirtDiffraction::Tile> DirtDiffraction::sampled_tile(unsigned tile_x, unsigned tile_y) const {
  constexpr int kSide = Tile::kSide + 1;
  auto tile = std::make_unique<Tile>();
  const Vec2 low{tile_x * Tile::kSide * pitch_mm_ - extent_mm_, tile_y * Tile::kSide * pitch_mm_ - extent_mm_};
  const double last = (kSide - 1) * pitch_mm_;
  std::vector<std::uint32_t> near;
  for (int y = dirty_.cell_of(low.y); y <= dirty_.cell_of(low.y + last); ++y)
    for (int x = dirty_.cell_of(low.x); x <= dirty_.cell_of(low.x + last); ++x)
      near.insert(near.end(), shapes_about(x, y).begin(), shapes_about(x, y).end());
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  std::array<Wave, kSide * kSide> amplitude;
  amplitude.fill(1.0F);
  const auto index = [&](double mm) { return static_cast<int>(std::clamp(mm / pitch_mm_, 0.0, kSide - 1.0)); };
  for (const std::uint32_t k : near) {
    const Shape& shape = shapes_[k];
    const Vec2 middle = shape.stroke.middle_mm - low;
    const double around = shape.around_mm();
    for (int y = index(std::ceil((middle.y - around) / pitch_mm_) * pitch_mm_); y <= index(middle.y + around); ++y) {
      const double off = y * pitch_mm_ - middle.y, across2 = around * around - off * off;
      if (!(across2 > 0.0)) continue;
      const double across = std::sqrt(across2);
      if (middle.x + across < 0.0 || middle.x - across > last) continue;
      for (int x = index(middle.x - across); x <= index(middle.x + across); ++x)
        amplitude[static_cast<std::size_t>(y * kSide + x)] *=
            1.0F - shape.amplitude * wave(shape, low + Vec2{x * pitch_mm_, y * pitch_mm_});
    }
  }
  for (std::size_t k = 0; k < amplitude.size(); ++k)
    tile->lost[k] = static_cast<float>(1.0 - transmitted(amplitude[k]));
  return tile;
}

// One sample of a level; 0 outside the plane.
float DirtDiffraction::sample(std::size_t level, long column, long row) const {
  constexpr long kSide = Tile::kSide;
  const long samples = kSide * static_cast<long>(levels_[level].tiles);
  if (column < 0 || row < 0 || column >= samples || row >= samples) return 0.0F;
  const Tile& from = tile(level, static_cast<unsigned>(column / kSide), static_cast<unsigned>(row / kSide));
  return from.lost[static_cast<std::size_t>(row % kSide * (kSide + 1) + column % kSide)];
}

std::unique_ptr<DirtDiffraction::Tile> DirtDiffraction::smoothed_tile(std::size_t level, unsigned x, unsigned y) const {
  constexpr long kSide = Tile::kSide;
  auto tile = std::make_unique<Tile>();
  std::array<float, 2 * kSide + 3> across{};
  for (long row = 0; row <= kSide; ++row)
    for (long down = -1; down <= 1; ++down) {
      const float weight = down == 0 ? 0.5F : 0.25F;
      for (long column = 0; column < static_cast<long>(across.size()); ++column)
        across[static_cast<std::size_t>(column)] =
            sample(level - 1, 2 * kSide * x + column - 1, 2 * (kSide * y + row) + down);
      for (long column = 0; column <= kSide; ++column) {
        const float* const at = across.data() + 2 * column;
        tile->lost[static_cast<std::size_t>(row * (kSide + 1) + column)] +=
            weight * (0.25F * at[0] + 0.5F * at[1] + 0.25F * at[2]);
      }
    }
  return tile;
}

const DirtDiffraction::Tile& DirtDiffraction::tile(std::size_t level, unsigned x, unsigned y) const {
  auto& slot = levels_[level].tile[static_cast<std::size_t>(y) * levels_[level].tiles + x];
  const Tile* there = slot.load(std::memory_order_acquire);
  if (there != nullptr) return *there;
  auto made = level == 0 ? sampled_tile(x, y) : smoothed_tile(level, x, y);
  for (const float lost : made->lost) made->is_clean = made->is_clean && std::abs(lost) <= kCleanWithin;
  if (slot.compare_exchange_strong(there, made.get(), std::memory_order_acq_rel)) return *made.release();
  return *there;
}

// Interpolates bilinearly.
double DirtDiffraction::between_samples(std::size_t level, Vec2 at_mm) const {
  const Level& of = levels_[level];
  const double x = (at_mm.x + extent_mm_) * of.per_mm, y = (at_mm.y + extent_mm_) * of.per_mm;
  const auto column = static_cast<unsigned>(x), row = static_cast<unsigned>(y);
  constexpr unsigned kSide = Tile::kSide;
  const Tile& from = tile(level, column / kSide, row / kSide);
  if (from.is_clean) return 1.0;
  const auto s = static_cast<float>(x - column), t = static_cast<float>(y - row);
  const float* const lost = from.lost.data() + row % kSide * (kSide + 1) + column % kSide;
  const float low = lost[0] + s * (lost[1] - lost[0]);
  const float high = lost[kSide + 1] + s * (lost[kSide + 2] - lost[kSide + 1]);
  return 1.0 - static_cast<double>(low + t * (high - low));
}

// The mean over a square, in parts: each part is a look-up at the level whose samples, smoothed and interpolated,
// represent means over about two of them (w^2 / 12 = 4^level / 3).
double DirtDiffraction::transmission(Vec2 at_mm, double width_mm) const {
  const bool is_sampled = pitch_mm_ > 0.0 && std::max(std::abs(at_mm.x), std::abs(at_mm.y)) + width_mm < extent_mm_;
  const double samples = width_mm * levels_.front().per_mm;
  if (is_sampled && samples <= kOneSample) return between_samples(0, at_mm);
  const double requested = is_sampled ? (samples <= kFewSamples ? 2.0 : 3.0)
                                      : std::min(std::ceil(width_mm * per_mm_ / kStepOfUnit), kMaxParts);
  const int parts = std::max(1, static_cast<int>(requested));
  const double part = samples / (2.0 * parts);
  const int level = part > 1.0 ? std::ilogb(part * std::numbers::sqrt2) : 0;
  double sum = 0.0;
  for (int k = 0; k < parts * parts; ++k) {
    const Vec2 at = at_mm + Vec2{(k % parts + 0.5) / parts - 0.5, (k / parts + 0.5) / parts - 0.5} * width_mm;
    sum += is_sampled ? between_samples(std::min(static_cast<std::size_t>(level), levels_.size() - 1), at)
                      : transmitted(at);
  }
  return sum / (parts * parts);
}

bool DirtDiffraction::is_clean(Vec2 middle_mm, double radius_mm) const {
  const Vec2 low = middle_mm - Vec2{radius_mm, radius_mm}, high = middle_mm + Vec2{radius_mm, radius_mm};
  if (!dirty_.any_within(low, high)) return true;
  if (!(pitch_mm_ > 0.0) || !(std::max({-low.x, -low.y, high.x, high.y}) < extent_mm_)) return false;
  const auto tile_of = [&](double mm) { return static_cast<unsigned>((mm + extent_mm_) / (Tile::kSide * pitch_mm_)); };
  if (tile_of(high.x) - tile_of(low.x) > kFewTiles || tile_of(high.y) - tile_of(low.y) > kFewTiles) return false;
  for (unsigned y = tile_of(low.y); y <= tile_of(high.y); ++y)
    for (unsigned x = tile_of(low.x); x <= tile_of(high.x); ++x)
      if (!tile(0, x, y).is_clean) return false;
  return true;
}

std::size_t DirtDiffraction::bytes() const {
  std::size_t sum = shapes_.size() * sizeof(Shape) + (first_.size() + shapes_of_cell_.size()) * sizeof(std::uint32_t);
  for (const Level& level : levels_)
    for (const auto& tile : level.tile) sum += sizeof(tile) + (tile.load() != nullptr ? sizeof(Tile) : 0);
  return sum;
}

}  // namespace contrejour::inline internal::stop_patterns
