// SPDX-License-Identifier: Apache-2.0
// The linear least-squares problem of one station's picture: the levels of pictures of ghosts in each channel, with the
// light scattered about the light's own image as unknowns besides.
// Thread-safety: pure functions; the same bits for any number of threads.
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "measure/prescription/lens_stations.h"

namespace contrejour::inline internal {

// Normal equations of one channel: y = sum of levels times columns, weighted. The halo's columns come last.
struct ChannelMatrix {
  Eigen::MatrixXd a;  // J^T W J
  Eigen::VectorXd b;  // J^T W y
  double yy = 0;  // y^T W y
  double pixels = 0;  // with a weight
};
using StationMatrix = std::array<ChannelMatrix, 3>;

// Halo: a falling power of the distance from the light, times a piecewise linear function of its logarithm; the same
// times cos(phi) and cos(2 phi), with phi from the direction that leads away from the optical axis, because vignetting
// and perspective make it uneven and oblong; and a level that is the same everywhere.
class HaloColumns {
 public:
  HaloColumns(Vec2 light_px, Vec2 centre_px, double masked_px, int width, int height);
  [[nodiscard]] int radial_count() const { return static_cast<int>(knots_px_.size()); }
  [[nodiscard]] int count() const { return 3 * radial_count() + 1; }  // round ones, cos(phi), cos(2 phi), the level
  [[nodiscard]] bool is_masked(int x, int y) const { return length(from_light(x, y)) < masked_px_; }
  // At a pixel two neighbouring knots have values; those of a harmonic are multiplied by its factor.
  struct Values {
    int first = 0;
    double at_first = 0, at_next = 0;
    std::array<double, 3> harmonics{};
  };
  [[nodiscard]] Values at(int x, int y) const;
  [[nodiscard]] double level(const Eigen::VectorXd& levels, int x, int y) const;

 private:
  [[nodiscard]] Vec2 from_light(int x, int y) const { return Vec2{x + 0.5, y + 0.5} - light_px_; }
  Vec2 light_px_, outwards_;
  double masked_px_;
  std::vector<double> knots_px_;
};

// Weights of a station's pixels.
struct WeightSettings {
  double model_error = 0.05;  // of what ghosts and halo are expected to have there
  double huber = 3.0;  // standard deviations from which residuals count linearly
  double halo_error = 0.1;  // of the halo's level, which is not quite round
};

// Inverse variances by noise and by what the columns cannot describe, robust about the best non-negative levels of this
// station by itself. masked_px: about the light.
[[nodiscard]] Image station_weights(const FitStation& station, const std::vector<Patch>& columns,
                                    const HaloColumns& halo, const WeightSettings& settings);

[[nodiscard]] StationMatrix station_matrix(const FitStation& station, const Image& weights,
                                           const std::vector<Patch>& columns, const HaloColumns& halo);

// Columns of a matrix, chosen by ranges.
using ColumnIndices = std::vector<Eigen::Index>;
void append_columns(ColumnIndices& to, Eigen::Index first, Eigen::Index count);
[[nodiscard]] ChannelMatrix chosen_columns(const ChannelMatrix& of, const ColumnIndices& at);

// The best values of the unknowns after the first ones, for given values of those.
[[nodiscard]] Eigen::VectorXd others_given(const ChannelMatrix& all, const Eigen::VectorXd& kept);

// The equations of the first `kept` unknowns, with the others at their best. prior: inverse variances of the others
// about 0, by their number, or empty.
[[nodiscard]] ChannelMatrix eliminated(const ChannelMatrix& all, Eigen::Index kept, const Eigen::VectorXd& prior = {});

}  // namespace contrejour::inline internal
