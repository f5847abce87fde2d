// SPDX-License-Identifier: Apache-2.0
#include "measure/prescription/measured_figures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "base/tasks.h"
#include "measure/prescription/nonnegative.h"

namespace contrejour::inline internal {
namespace {

// The least uncertainty of figures, which the pixels' errors alone do not state: residuals of a drawn ghost are alike
// in neighbouring pixels.
constexpr double kLeastMiddle_px = 0.03, kLeastMiddleOfSize = 0.002, kLeastSize = 0.004;
constexpr double kHuber = 3.0;  // standard deviations from which a figure counts linearly
constexpr double kLevelError = 0.1;  // relative, of a ghost's level from station to station
constexpr double kFigureRidge = 1e-3;  // of the least error's weight: keeps figures that no pixel shows at 0
// The only channel to measure in pictures of a mosaic. Red and blue pixels are interpolated, which makes ghosts larger
// by half a per cent: a focus shift of 0.2 mm came out as 0.66, even with drawings that are spread as much.
constexpr std::size_t kGreen = 1;
constexpr int kMargin_px = 1;  // about a patch, for differences of its pixels

double pixel(const Patch& patch, int x, int y, int c) {
  const int u = x - patch.left, v = y - patch.top;
  const bool inside = u >= 0 && v >= 0 && u < patch.image.width && v < patch.image.height;
  return inside ? static_cast<double>(patch.image.at(u, v, c)) : 0.0;
}

struct Extent {
  Vec2 middle, size;  // of light by its second moments: full sides of an even box
};

Extent extent_of(const Patch& patch) {
  Vec2 first{}, second{};
  double sum = 0.0;
  for (int y = 0; y < patch.image.height; ++y) {
    for (int x = 0; x < patch.image.width; ++x) {
      double value = 0.0;
      for (int c = 0; c < 3; ++c) value += std::max(static_cast<double>(patch.image.at(x, y, c)), 0.0);
      const Vec2 at{patch.left + x + 0.5, patch.top + y + 0.5};
      first = first + at * value;
      second = second + Vec2{at.x * at.x, at.y * at.y} * value;
      sum += value;
    }
  }
  if (!(sum > 0.0)) return {};
  first = first * (1.0 / sum);
  const auto side = [&](double square, double mean) {
    return std::sqrt(12.0 * std::max(square / sum - mean * mean, 0.0));
  };
  return {first, {side(second.x, first.x), side(second.y, first.y)}};
}

// The change of a patch as it moves by a pixel in x or y, and as it grows about its middle in x or y, with its light.
std::array<Patch, kFigures> changes_of(const Patch& patch, Vec2 middle) {
  std::array<Patch, kFigures> changes;
  if (patch.image.pixels.empty()) return changes;
  for (Patch& change : changes)
    change = {patch.left - kMargin_px, patch.top - kMargin_px,
              Image(patch.image.width + 2 * kMargin_px, patch.image.height + 2 * kMargin_px)};
  for (int v = 0; v < changes[0].image.height; ++v) {
    for (int u = 0; u < changes[0].image.width; ++u) {
      const int x = changes[0].left + u, y = changes[0].top + v;
      for (int c = 0; c < 3; ++c) {
        const double by_x = 0.5 * (pixel(patch, x + 1, y, c) - pixel(patch, x - 1, y, c));
        const double by_y = 0.5 * (pixel(patch, x, y + 1, c) - pixel(patch, x, y - 1, c));
        const double level = pixel(patch, x, y, c);
        changes[0].image.at(u, v, c) = static_cast<float>(-by_x);
        changes[1].image.at(u, v, c) = static_cast<float>(-by_y);
        changes[2].image.at(u, v, c) = static_cast<float>(-(x + 0.5 - middle.x) * by_x - level);
        changes[3].image.at(u, v, c) = static_cast<float>(-(y + 0.5 - middle.y) * by_y - level);
      }
    }
  }
  return changes;
}

// A station's equations, with the columns in the order: ghosts' levels, all other ghosts, their figures, halo.
struct DrawnStation {
  StationMatrix matrix;
  std::vector<Extent> extents;
};

Result<DrawnStation> draw_station(const DrawnSweep& drawn, Vec2 centre_px, std::size_t k, Image& weights,
                                  const Context& context) {
  const LensStations& stations = *drawn.stations;
  const Frame frame = frame_of(stations, centre_px);
  auto patches = ghost_patches(stations, k, drawn.lens, frame, drawn.ghosts, context);
  if (!patches) return tl::unexpected(patches.error());
  const FitStation& station = stations.pictures.stations[k];
  const HaloColumns halo(stations.pictures.lights_px[k], stations.centre_px, masked_px(stations), frame.width,
                         frame.height);
  if (weights.pixels.empty()) {
    WeightSettings settings;
    settings.model_error = drawn.model_error;
    settings.huber = 5.0;  // edges that are displaced are what is to be measured
    weights = station_weights(station, *patches, halo, settings);
  }
  DrawnStation all;
  for (std::size_t g = 0; g < drawn.ghosts.size(); ++g) {
    all.extents.push_back(extent_of((*patches)[g]));
    for (Patch& change : changes_of((*patches)[g], all.extents.back().middle)) patches->push_back(std::move(change));
  }
  all.matrix = station_matrix(station, weights, *patches, halo);
  return all;
}

// Ghosts' levels over all stations, not below 0.
NonnegativeSolution common_levels(const std::vector<DrawnStation>& stations, std::size_t channel, Eigen::Index ghosts) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(ghosts, ghosts);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(ghosts);
  for (const DrawnStation& station : stations) {
    const ChannelMatrix& all = station.matrix[channel];
    ColumnIndices at;
    append_columns(at, 0, ghosts + 1);
    append_columns(at, ghosts + 1 + kFigures * ghosts, all.b.size() - (ghosts + 1 + kFigures * ghosts));
    const ChannelMatrix kept = eliminated(chosen_columns(all, at), ghosts);
    a += kept.a;
    b += kept.b;
  }
  return nonnegative_least_squares(a, b);
}

// The equations of a station's figures in one channel: levels may differ from the common ones by a little, halo and
// other ghosts are at their best.
ChannelMatrix figure_equations(const ChannelMatrix& all, const NonnegativeSolution& levels, Eigen::Index ghosts) {
  ColumnIndices at;
  append_columns(at, ghosts + 1, kFigures * ghosts);
  append_columns(at, 0, ghosts + 1);
  append_columns(at, ghosts + 1 + kFigures * ghosts, all.b.size() - (ghosts + 1 + kFigures * ghosts));
  ChannelMatrix of = chosen_columns(all, at);
  const Eigen::Index figures = kFigures * ghosts;
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(of.b.size());
  Eigen::VectorXd common = Eigen::VectorXd::Zero(of.b.size());
  Eigen::VectorXd prior = Eigen::VectorXd::Zero(of.b.size() - figures);
  for (Eigen::Index g = 0; g < ghosts; ++g) {
    scale.segment(kFigures * g, kFigures).setConstant(levels.x[g]);
    common[figures + g] = levels.x[g];
    const double error = kLevelError * levels.x[g] + std::min(levels.error[g], levels.x[g]);
    prior[g] = error > 0.0 ? 1.0 / (error * error) : 1e30;
  }
  const Eigen::VectorXd drawn = of.a * common;
  of.yy += common.dot(drawn - 2.0 * of.b);
  of.b = scale.cwiseProduct(of.b - drawn);
  of.a = (scale.asDiagonal() * of.a * scale.asDiagonal()).eval();
  return eliminated(of, figures, prior);
}

StationFigures station_figures(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, const std::vector<Extent>& extents) {
  Eigen::VectorXd least(b.size());
  for (std::size_t g = 0; g < extents.size(); ++g) {
    const auto row = kFigures * static_cast<Eigen::Index>(g);
    const Vec2 size = extents[g].size;
    least[row] = std::hypot(kLeastMiddle_px, kLeastMiddleOfSize * size.x);
    least[row + 1] = std::hypot(kLeastMiddle_px, kLeastMiddleOfSize * size.y);
    least[row + 2] = std::hypot(kLeastSize, kLeastMiddle_px / std::max(size.x, 0.5));
    least[row + 3] = std::hypot(kLeastSize, kLeastMiddle_px / std::max(size.y, 0.5));
  }
  // In units of the least errors.
  const Eigen::MatrixXd scaled = least.asDiagonal() * a * least.asDiagonal();
  const Eigen::Index count = b.size();
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(count, count);
  const Eigen::LDLT<Eigen::MatrixXd> ridged(scaled + kFigureRidge * unit);
  const Eigen::VectorXd off = ridged.solve(least.cwiseProduct(b));
  // (A^-1 + 1)^-1, which exists for a singular A, too.
  Eigen::MatrixXd weight = (unit + scaled).partialPivLu().solve(scaled);
  weight = 0.5 * (weight + weight.transpose()).eval();
  const Eigen::VectorXd inverse = least.cwiseInverse();
  StationFigures figures{least.cwiseProduct(off), inverse.asDiagonal() * weight * inverse.asDiagonal(),
                         static_cast<double>(count) - kFigureRidge * ridged.solve(unit).trace()};
  // Figures far off count less: a caustic, or a ghost taken for another.
  const Eigen::VectorXd root =
      (figures.off.cwiseAbs().cwiseProduct(figures.weight.diagonal().cwiseSqrt())).unaryExpr([](double deviations) {
        return deviations > kHuber ? std::sqrt(kHuber / deviations) : 1.0;
      });
  figures.weight = (root.asDiagonal() * figures.weight * root.asDiagonal()).eval();
  return figures;
}

}  // namespace

double MeasuredFigures::cost() const {
  double sum = 0.0;
  for (const StationFigures& of : by_station) sum += 0.5 * of.off.dot(of.weight * of.off);
  return sum;
}

double MeasuredFigures::rms_px() const {
  double sum = 0.0, weights = 0.0;
  for (const StationFigures& of : by_station) {
    for (Eigen::Index row = 0; row < of.off.size(); row += kFigures) {
      const double weight = of.weight(row, row) + of.weight(row + 1, row + 1);
      sum += weight * (of.off[row] * of.off[row] + of.off[row + 1] * of.off[row + 1]);
      weights += weight;
    }
  }
  return weights > 0.0 ? std::sqrt(sum / weights) : 0.0;
}

Result<MeasuredFigures> measured_figures(const DrawnSweep& drawn, Vec2 centre_px, std::vector<Image>& weights,
                                         const Context& context) {
  const std::size_t count = drawn.stations->pictures.stations.size();
  weights.resize(count);
  std::vector<DrawnStation> stations;
  std::optional<Error> error;
  const Context one{1, context.cancel, {}};
  const bool done = ordered_pipeline(
      count, {context.threads, context.cancel, {}},
      [&](std::size_t k) { return draw_station(drawn, centre_px, k, weights[k], one); },
      [&](std::size_t, Result<DrawnStation>& station) {
        if (!station && !error) error = station.error();
        if (station) stations.push_back(std::move(*station));
      });
  if (error) return tl::unexpected(*error);
  if (!done) return interrupted();
  const auto ghosts = static_cast<Eigen::Index>(drawn.ghosts.size());
  std::array<NonnegativeSolution, 3> levels;
  for (std::size_t c = 0; c < 3; ++c) levels[c] = common_levels(stations, c, ghosts);
  MeasuredFigures figures;
  for (const DrawnStation& station : stations) {
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(kFigures * ghosts, kFigures * ghosts);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(kFigures * ghosts);
    for (std::size_t c = 0; c < 3; ++c) {
      if (c != kGreen && drawn.stations->is_mosaic) continue;
      const ChannelMatrix of = figure_equations(station.matrix[c], levels[c], ghosts);
      a += of.a;
      b += of.b;
    }
    figures.by_station.push_back(station_figures(a, b, station.extents));
  }
  return figures;
}

}  // namespace contrejour::inline internal
