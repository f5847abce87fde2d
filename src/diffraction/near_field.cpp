// SPDX-License-Identifier: Apache-2.0
#include "diffraction/near_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/scalar.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kOctaveRows = kRowsPerOctave;
constexpr double kBetweenRays_px = 0.1;  // at an octave's end: chords are nearly linear between rays

// The direction in half turns from straight down.
double turns_of(Vec2 p) { return std::atan2(p.y, p.x) / kPi + 0.5; }

// The radii between which a ray from the centre lies within a square; the second is smaller if it misses the square.
struct Chord {
  double from_px = 0.0, to_px = 0.0;
};

Chord chord_of(const SquareAt& square, Vec2 along) {
  Chord chord{0.0, std::numeric_limits<double>::infinity()};
  const auto between = [&](double low, double high, double slope) {
    if (slope == 0.0) {
      if (low > 0.0 || high < 0.0) chord.to_px = -1.0;
      return;
    }
    const double a = low / slope, b = high / slope;
    chord.from_px = std::max(chord.from_px, std::min(a, b));
    chord.to_px = std::min(chord.to_px, std::max(a, b));
  };
  between(square.low.x, square.high.x, along.x);
  between(square.low.y, square.high.y, along.y);
  return chord;
}

double nearest_px(const SquareAt& s) {
  const Vec2 distance{std::max({s.low.x, -s.high.x, 0.0}), std::max({s.low.y, -s.high.y, 0.0})};
  return length(distance);
}

double farthest_px(const SquareAt& s) {
  return length(Vec2{std::max(std::abs(s.low.x), std::abs(s.high.x)), std::max(std::abs(s.low.y), std::abs(s.high.y))});
}

}  // namespace

// The directions of a square in half turns: from the first of its corners to the last, with the others between.
struct NearField::Arc {
  std::array<double, 5> turns{};  // rising
  std::size_t count = 0;

  explicit Arc(const SquareAt& s) {
    const std::array<Vec2, 4> corner{s.low, {s.high.x, s.low.y}, s.high, {s.low.x, s.high.y}};
    const bool all_round = s.low.x < 0.0 && s.low.y < 0.0 && s.high.x > 0.0 && s.high.y > 0.0;
    if (all_round) {  // a full turn, from a corner to itself
      const double first = turns_of(corner[0]);
      for (const Vec2 p : corner) insert(first + wrapped(turns_of(p) - first));
      insert(first + 2.0);
      return;
    }
    const double middle = turns_of((s.low + s.high) * 0.5);
    for (const Vec2 p : corner) {
      const double turn = turns_of(p);
      insert(turn + 2.0 * std::round((middle - turn) * 0.5));
    }
  }

 private:
  static double wrapped(double turns) { return turns - 2.0 * std::floor(0.5 * turns); }

  void insert(double turn) {
    std::size_t k = count++;
    for (; k > 0 && turns[k - 1] > turn; --k) turns[k] = turns[k - 1];
    turns[k] = turn;
  }
};

NearField::NearField(std::span<const CellOctave> octaves, double first_px,
                     const std::function<double(double)>& weight) {
  for (const CellOctave& from : octaves) {
    Octave octave;
    octave.first_row_px = first_px * row_ratio(-0.5);
    octave.first_px = octaves_.empty() ? 0.0 : octave.first_row_px;
    octave.end_px = first_px * row_ratio(static_cast<double>(kOctaveRows) - 0.5);
    octave.edge = from.edge;
    for (const double turn : from.edge) octave.along.push_back({std::sin(turn * kPi), -std::cos(turn * kPi)});
    std::vector<double> row_weight;
    for (std::size_t row = 0; row <= kOctaveRows; ++row) {
      const double edge = row == 0 ? octave.first_px : first_px * row_ratio(static_cast<double>(row) - 0.5);
      octave.row_edge2.push_back(edge * edge);
      row_weight.push_back(weight(first_px * row_ratio(static_cast<double>(row))));
    }
    octave.below.resize(from.cells() * (kOctaveRows + 1));
    for (std::size_t cell = 0; cell < from.cells(); ++cell) {
      std::array<double, 3>* const below = octave.below.data() + cell * (kOctaveRows + 1);
      for (std::size_t row = 0; row < kOctaveRows; ++row) {
        const double area = 0.5 * (octave.row_edge2[row + 1] - octave.row_edge2[row]) * row_weight[row];
        for (std::size_t c = 0; c < 3; ++c) below[row + 1][c] = below[row][c] + area * from.at(row, cell)[c];
      }
    }
    octaves_.push_back(std::move(octave));
    first_px *= 2.0;
  }
}

// Adds the flux between two radii in a cell; weight: radians.
void NearField::add_ray(const Octave& octave, std::size_t cell, double weight, double from_px, double to_px,
                        std::array<double, 3>& sum) {
  const std::array<double, 3>* const below = octave.below.data() + cell * (kOctaveRows + 1);
  const auto add_within = [&](double radius_px, double sign) {
    const double position =
        radius_px > octave.first_row_px ? kRowsPerOctave * std::log2(radius_px / octave.first_row_px) : 0.0;
    const std::size_t row = std::min(static_cast<std::size_t>(position), kOctaveRows - 1);
    const double inner = octave.row_edge2[row];
    const double t = (radius_px * radius_px - inner) / (octave.row_edge2[row + 1] - inner);
    for (std::size_t c = 0; c < 3; ++c) sum[c] += sign * (below[row][c] + t * (below[row + 1][c] - below[row][c]));
  };
  add_within(to_px, weight);
  add_within(from_px, -weight);
}

// Adds the flux between two directions within a cell, in half turns from the beginning of the cell's half turn.
void NearField::add_sector(const Octave& octave, const Sector& sector, const SquareAt& square,
                           std::array<double, 3>& sum) {
  const double from = octave.edge[sector.cell], width = octave.edge[sector.cell + 1] - from;
  const double across_px = (sector.to - sector.from) * kPi * octave.end_px;
  const int rays = 1 + static_cast<int>(across_px / kBetweenRays_px);
  const double step = (sector.to - sector.from) / rays;
  for (int k = 0; k < rays; ++k) {
    const double t = (sector.from + (k + 0.5) * step - from) / width;
    const Vec2 along = (octave.along[sector.cell] * (1.0 - t) + octave.along[sector.cell + 1] * t) * sector.sign;
    const Chord chord = chord_of(square, along);
    const double near = std::max(chord.from_px, octave.first_px), far = std::min(chord.to_px, octave.end_px);
    if (far > near) add_ray(octave, sector.cell, step * kPi, near, far, sum);
  }
}

void NearField::add_arc(const Octave& octave, const Arc& arc, const SquareAt& square, std::array<double, 3>& sum) {
  const std::size_t cells = octave.edge.size() - 1;
  double turn = arc.turns[0], half_turns = std::floor(turn);
  const auto after = std::upper_bound(octave.edge.begin(), octave.edge.end(), turn - half_turns);
  std::size_t cell = std::min(static_cast<std::size_t>(after - octave.edge.begin()) - 1, cells - 1);
  for (std::size_t next = 1; next < arc.count;) {
    const double end = std::min(arc.turns[next], half_turns + octave.edge[cell + 1]);
    // In the other half turn directions are opposite.
    const double sign = static_cast<std::int64_t>(half_turns) % 2 == 0 ? 1.0 : -1.0;
    if (end > turn) add_sector(octave, {cell, turn - half_turns, end - half_turns, sign}, square, sum);
    turn = std::max(turn, end);
    if (end >= arc.turns[next]) {
      ++next;
    } else if (++cell == cells) {
      cell = 0;
      half_turns += 1.0;
    }
  }
}

std::array<double, 3> NearField::flux(const SquareAt& square) const {
  const double nearest = nearest_px(square), farthest = farthest_px(square);
  const Arc arc(square);
  std::array<double, 3> sum{};
  for (const Octave& octave : octaves_)
    if (octave.first_px < farthest && octave.end_px > nearest) add_arc(octave, arc, square, sum);
  return sum;
}

}  // namespace contrejour::inline internal
