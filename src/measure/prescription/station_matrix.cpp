// SPDX-License-Identifier: Apache-2.0
#include "measure/prescription/station_matrix.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "measure/prescription/nonnegative.h"

namespace contrejour::inline internal {
namespace {

constexpr double kFall = 2.5;        // exponent of the halo's fall: light diffracted and scattered falls by 2 to 3
constexpr double kKnotRatio = 1.6;   // of the distances of two knots
constexpr int kRowsAtOnce = 8;
constexpr int kRounds = 3;           // of weights and levels
constexpr double kFirstError = 0.2;  // of a pixel's value, before anything is fitted
constexpr double kEmptyColumnRidge = 1e-12;  // relative, for columns that no pixel of the picture holds

// Rows of columns at the pixels of some rows of the picture, for one channel.
class Rows {
 public:
  Rows(const FitStation& station, const Image& weights, const std::vector<Patch>& columns, const HaloColumns& halo)
      : station_(station), weights_(weights), columns_(columns), halo_(halo),
        width_(static_cast<Eigen::Index>(station.rate.width)) {}

  // Adds the rows top .. bottom - 1 to the equations.
  void add(int top, int bottom, int channel, ChannelMatrix& to) {
    const Eigen::Index count = width_ * (bottom - top);
    const auto ghosts = static_cast<Eigen::Index>(columns_.size());
    rows_.setZero(count, ghosts + halo_.count());
    values_.setZero(count);
    for (int y = top; y < bottom; ++y) fill_halo(y, top, channel, to);
    for (Eigen::Index k = 0; k < ghosts; ++k)
      fill_column(columns_[static_cast<std::size_t>(k)], k, top, bottom, channel);
    to.a.selfadjointView<Eigen::Lower>().rankUpdate(rows_.transpose());
    to.b.noalias() += rows_.transpose() * values_;
    to.yy += values_.squaredNorm();
  }

 private:
  [[nodiscard]] Eigen::Index row_of(int x, int y, int top) const { return (y - top) * width_ + x; }

  [[nodiscard]] double root_weight(int x, int y, int channel) const {
    return std::sqrt(static_cast<double>(weights_.at(x, y, channel)));
  }

  void fill_halo(int y, int top, int channel, ChannelMatrix& to) {
    const auto first = static_cast<Eigen::Index>(columns_.size());
    for (int x = 0; x < station_.rate.width; ++x) {
      const double root = root_weight(x, y, channel);
      if (root == 0.0) continue;
      const Eigen::Index row = row_of(x, y, top);
      const HaloColumns::Values values = halo_.at(x, y);
      for (int h = 0; h < 3; ++h) {
        const Eigen::Index at = first + h * halo_.radial_count() + values.first;
        rows_(row, at) = root * values.harmonics[static_cast<std::size_t>(h)] * values.at_first;
        rows_(row, at + 1) = root * values.harmonics[static_cast<std::size_t>(h)] * values.at_next;
      }
      rows_(row, first + halo_.count() - 1) += root;
      values_[row] = root * static_cast<double>(station_.rate.at(x, y, channel));
      ++to.pixels;
    }
  }

  void fill_column(const Patch& patch, Eigen::Index k, int top, int bottom, int channel) {
    const int first = std::max(top, patch.top), last = std::min(bottom, patch.top + patch.image.height);
    const int left = std::max(patch.left, 0), right = std::min(patch.left + patch.image.width, station_.rate.width);
    for (int y = first; y < last; ++y) {
      for (int x = left; x < right; ++x) {
        rows_(row_of(x, y, top), k) =
            root_weight(x, y, channel) * static_cast<double>(patch.image.at(x - patch.left, y - patch.top, channel));
      }
    }
  }

  const FitStation& station_;
  const Image& weights_;
  const std::vector<Patch>& columns_;
  const HaloColumns& halo_;
  Eigen::Index width_;
  Eigen::MatrixXd rows_;
  Eigen::VectorXd values_;
};

double column_value(const Patch& patch, int x, int y, int channel) {
  const int u = x - patch.left, v = y - patch.top;
  const bool inside = u >= 0 && v >= 0 && u < patch.image.width && v < patch.image.height;
  return inside ? static_cast<double>(patch.image.at(u, v, channel)) : 0.0;
}

// Levels of ghosts and of the halo, of one channel of one station.
struct MatrixLevels {
  Eigen::VectorXd ghosts, halo;
};

// No level falls below 0 but those of the halo's harmonics. Otherwise a ghost that is wide enough to be nearly even
// takes any level, and the even level makes up for it.
MatrixLevels levels_of(const ChannelMatrix& all, Eigen::Index ghosts, Eigen::Index round) {
  const Eigen::Index last = all.b.size() - 1, harmonics = last - ghosts - round;
  ColumnIndices at;
  append_columns(at, 0, ghosts + round);
  at.push_back(last);
  append_columns(at, ghosts + round, harmonics);
  const ChannelMatrix ordered = chosen_columns(all, at);
  const ChannelMatrix kept = eliminated(ordered, ghosts + round + 1);
  const Eigen::VectorXd positive = nonnegative_least_squares(kept.a, kept.b).x;
  MatrixLevels levels{positive.head(ghosts), Eigen::VectorXd(all.b.size() - ghosts)};
  levels.halo << positive.segment(ghosts, round), others_given(ordered, positive), positive.tail(1);
  return levels;
}

Image first_weights(const FitStation& station, const HaloColumns& halo) {
  Image weights(station.rate.width, station.rate.height);
  for (int y = 0; y < weights.height; ++y) {
    for (int x = 0; x < weights.width; ++x) {
      if (halo.is_masked(x, y)) continue;
      for (int c = 0; c < 3; ++c) {
        const double noise = static_cast<double>(station.weight.at(x, y, c));
        if (noise <= 0.0) continue;
        const double off = kFirstError * std::max(static_cast<double>(station.rate.at(x, y, c)), 0.0);
        weights.at(x, y, c) = static_cast<float>(1.0 / (1.0 / noise + off * off));
      }
    }
  }
  return weights;
}

void reweight(const FitStation& station, const std::vector<Patch>& columns, const HaloColumns& halo,
              const std::array<MatrixLevels, 3>& levels, const WeightSettings& settings, Image& weights) {
  for (int c = 0; c < 3; ++c) {
    const MatrixLevels& of = levels[static_cast<std::size_t>(c)];
    for (int y = 0; y < weights.height; ++y) {
      for (int x = 0; x < weights.width; ++x) {
        float& weight = weights.at(x, y, c);
        if (weight == 0.0F) continue;
        const double scattered = halo.level(of.halo, x, y);
        double ghosts = 0.0;
        for (std::size_t k = 0; k < columns.size(); ++k) {
          const double level = of.ghosts[static_cast<Eigen::Index>(k)];
          if (level > 0.0) ghosts += level * column_value(columns[k], x, y, c);
        }
        const double off = settings.model_error * ghosts, off_halo = settings.halo_error * scattered;
        const double variance = 1.0 / static_cast<double>(station.weight.at(x, y, c)) + off * off + off_halo * off_halo;
        const double residual =
            std::abs(static_cast<double>(station.rate.at(x, y, c)) - ghosts - scattered) / std::sqrt(variance);
        weight = static_cast<float>((residual > settings.huber ? settings.huber / residual : 1.0) / variance);
      }
    }
  }
}

}  // namespace

HaloColumns::HaloColumns(Vec2 light_px, Vec2 centre_px, double masked_px, int width, int height)
    : light_px_(light_px), outwards_{1.0, 0.0}, masked_px_(masked_px) {
  const double off_axis = length(light_px - centre_px);
  if (off_axis > 0.0) outwards_ = (light_px - centre_px) * (1.0 / off_axis);
  // Knots do not depend on where the light is, so that all stations have the same columns.
  const double farthest = std::hypot(width, height);
  for (double r = masked_px;; r *= kKnotRatio) {
    knots_px_.push_back(r);
    if (r >= farthest) break;
  }
  if (knots_px_.size() < 2) knots_px_.push_back(knots_px_.front() * kKnotRatio);
}

HaloColumns::Values HaloColumns::at(int x, int y) const {
  const Vec2 offset = from_light(x, y);
  const double distance = length(offset);
  const double r = std::clamp(distance, knots_px_.front(), knots_px_.back());
  const auto next = std::clamp<std::ptrdiff_t>(std::ranges::upper_bound(knots_px_, r) - knots_px_.begin(), 1,
                                               static_cast<std::ptrdiff_t>(knots_px_.size()) - 1);
  const double low = knots_px_[static_cast<std::size_t>(next - 1)], high = knots_px_[static_cast<std::size_t>(next)];
  const double t = std::log(r / low) / std::log(high / low);
  const double cosine = distance > 0.0 ? (offset.x * outwards_.x + offset.y * outwards_.y) / distance : 0.0;
  return {static_cast<int>(next - 1),
          (1.0 - t) * std::pow(r / low, -kFall),
          t * std::pow(r / high, -kFall),
          {1.0, cosine, 2.0 * cosine * cosine - 1.0}};
}

double HaloColumns::level(const Eigen::VectorXd& levels, int x, int y) const {
  const Values values = at(x, y);
  double sum = levels[count() - 1];
  for (int h = 0; h < 3; ++h) {
    const Eigen::Index at = h * radial_count() + values.first;
    sum += values.harmonics[static_cast<std::size_t>(h)] *
           (values.at_first * levels[at] + values.at_next * levels[at + 1]);
  }
  return sum;
}

StationMatrix station_matrix(const FitStation& station, const Image& weights, const std::vector<Patch>& columns,
                             const HaloColumns& halo) {
  StationMatrix matrix;
  const auto count = static_cast<Eigen::Index>(columns.size()) + halo.count();
  Rows rows(station, weights, columns, halo);
  for (int c = 0; c < 3; ++c) {
    ChannelMatrix& of = matrix[static_cast<std::size_t>(c)];
    of.a.setZero(count, count);
    of.b.setZero(count);
    for (int top = 0; top < station.rate.height; top += kRowsAtOnce)
      rows.add(top, std::min(top + kRowsAtOnce, station.rate.height), c, of);
    of.a = Eigen::MatrixXd(of.a.selfadjointView<Eigen::Lower>());
  }
  return matrix;
}

Image station_weights(const FitStation& station, const std::vector<Patch>& columns, const HaloColumns& halo,
                      const WeightSettings& settings) {
  Image weights = first_weights(station, halo);
  for (int round = 0; round < kRounds; ++round) {
    const StationMatrix matrix = station_matrix(station, weights, columns, halo);
    std::array<MatrixLevels, 3> levels;
    for (std::size_t c = 0; c < 3; ++c)
      levels[c] = levels_of(matrix[c], static_cast<Eigen::Index>(columns.size()), halo.radial_count());
    reweight(station, columns, halo, levels, settings, weights);
  }
  return weights;
}

void append_columns(ColumnIndices& to, Eigen::Index first, Eigen::Index count) {
  for (Eigen::Index k = 0; k < count; ++k) to.push_back(first + k);
}

ChannelMatrix chosen_columns(const ChannelMatrix& of, const ColumnIndices& at) {
  return {of.a(at, at), of.b(at), of.yy, of.pixels};
}

Eigen::VectorXd others_given(const ChannelMatrix& all, const Eigen::VectorXd& kept) {
  const Eigen::Index others = all.b.size() - kept.size();
  Eigen::MatrixXd a = all.a.bottomRightCorner(others, others);
  for (Eigen::Index k = 0; k < others; ++k) a(k, k) = a(k, k) > 0.0 ? a(k, k) * (1.0 + kEmptyColumnRidge) : 1.0;
  return a.ldlt().solve(all.b.tail(others) - all.a.bottomLeftCorner(others, kept.size()) * kept);
}

ChannelMatrix eliminated(const ChannelMatrix& all, Eigen::Index kept, const Eigen::VectorXd& prior) {
  const Eigen::Index others = all.b.size() - kept;
  ChannelMatrix rest;
  rest.pixels = all.pixels;
  rest.a = all.a.topLeftCorner(kept, kept);
  rest.b = all.b.head(kept);
  rest.yy = all.yy;
  if (others == 0) return rest;
  Eigen::MatrixXd a = all.a.bottomRightCorner(others, others);
  if (prior.size() == others) a.diagonal() += prior;
  // In units of their own influence.
  Eigen::VectorXd scale(others);
  for (Eigen::Index k = 0; k < others; ++k) scale[k] = a(k, k) > 0.0 ? 1.0 / std::sqrt(a(k, k)) : 0.0;
  a = (scale.asDiagonal() * a * scale.asDiagonal()).eval();
  for (Eigen::Index k = 0; k < others; ++k) a(k, k) = scale[k] > 0.0 ? 1.0 + kEmptyColumnRidge : 1.0;
  const Eigen::LDLT<Eigen::MatrixXd> factors(a);
  const Eigen::MatrixXd cross = scale.asDiagonal() * all.a.bottomLeftCorner(others, kept);
  const Eigen::VectorXd right = scale.cwiseProduct(all.b.tail(others));
  const Eigen::VectorXd solved = factors.solve(right);
  rest.a -= cross.transpose() * factors.solve(cross);
  rest.b -= cross.transpose() * solved;
  rest.yy -= right.dot(solved);
  return rest;
}

}  // namespace contrejour::inline internal
