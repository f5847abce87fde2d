// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/sweep_geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <Eigen/LU>

#include "measure/fit/levenberg_marquardt.h"

namespace contrejour {
namespace {

constexpr int kParameters = 6;  // centre x, centre y, focal length, distortion, zero, roll
constexpr std::size_t kMinImages = 5;
constexpr double kMinSpread_px = 4.0;   // of the images, below which nothing can be told
constexpr double kHuber_px = 0.5;       // a residual beyond which an image counts less
constexpr double kBrightPart = 0.5;     // of the maximum: what certainly belongs to the light's image
// The pixels at its edge, which are lit in part, say between which pixels it lies.
constexpr double kFaintPart = 0.05, kEdgeRadii = 1.5, kEdgeMargin_px = 1.5;
constexpr double kSaturated = 0.98;     // of the white level
constexpr double kExpectedError = 0.01;  // of the picture's width: mounts and sensors are centred better than that
constexpr double kLeastError_px = 1e-6;  // of an image: exact ones leave the expected centre without influence

SweepGeometry geometry_of(const Eigen::VectorXd& p) { return {{p[0], p[1]}, p[2], p[3], p[4], p[5], 0.0, {}}; }

// The residuals of an image and their derivatives.
struct ImageTerm {
  Eigen::Vector2d residual;
  Eigen::Matrix<double, 2, kParameters> jacobian;
};

ImageTerm term_of(const SweepGeometry& g, const DirectImage& image) {
  const double t = std::tan(image.angle_rad - g.zero_rad);
  const double radius = g.focal_length_px * t * (1.0 + g.distortion * t * t);
  const double by_tangent = g.focal_length_px * (1.0 + 3.0 * g.distortion * t * t);
  const Eigen::Vector2d along(std::cos(g.roll_rad), -std::sin(g.roll_rad));
  const Eigen::Vector2d by_roll(-std::sin(g.roll_rad), -std::cos(g.roll_rad));
  ImageTerm term;
  term.residual = Eigen::Vector2d(g.centre_px.x, g.centre_px.y) + radius * along -
                  Eigen::Vector2d(image.position_px.x, image.position_px.y);
  term.jacobian.col(0) = Eigen::Vector2d(1.0, 0.0);
  term.jacobian.col(1) = Eigen::Vector2d(0.0, 1.0);
  term.jacobian.col(2) = radius / g.focal_length_px * along;
  term.jacobian.col(3) = g.focal_length_px * t * t * t * along;
  term.jacobian.col(4) = -by_tangent * (1.0 + t * t) * along;
  term.jacobian.col(5) = radius * by_roll;
  return term;
}

// Huber's loss: quadratic up to kHuber_px, linear beyond.
double loss(double distance_px) {
  return distance_px <= kHuber_px ? 0.5 * distance_px * distance_px : kHuber_px * (distance_px - 0.5 * kHuber_px);
}
double weight(double distance_px) { return distance_px <= kHuber_px ? 1.0 : kHuber_px / distance_px; }

// The expected centre counts as one more measurement, whose weight is relative to that of a light's image.
struct CentrePrior {
  Vec2 position_px;
  double weight = 0;
};

double cost_of(const Eigen::VectorXd& p, std::span<const DirectImage> images, const CentrePrior& prior) {
  const SweepGeometry g = geometry_of(p);
  const Vec2 off = g.centre_px - prior.position_px;
  double cost = 0.5 * prior.weight * dot(off, off);
  for (const DirectImage& image : images) cost += loss(term_of(g, image).residual.norm());
  return cost;
}

NormalEquations equations_of(const Eigen::VectorXd& p, std::span<const DirectImage> images, const CentrePrior& prior) {
  const SweepGeometry g = geometry_of(p);
  NormalEquations equations{0.0, Eigen::VectorXd::Zero(kParameters), Eigen::MatrixXd::Zero(kParameters, kParameters)};
  const Vec2 off = g.centre_px - prior.position_px;
  equations.cost = 0.5 * prior.weight * dot(off, off);
  equations.gradient.head<2>() = prior.weight * Eigen::Vector2d(off.x, off.y);
  equations.hessian.topLeftCorner<2, 2>() = prior.weight * Eigen::Matrix2d::Identity();
  for (const DirectImage& image : images) {
    const ImageTerm term = term_of(g, image);
    const double distance = term.residual.norm(), w = weight(distance);
    equations.cost += loss(distance);
    equations.gradient += w * term.jacobian.transpose() * term.residual;
    equations.hessian += w * term.jacobian.transpose() * term.jacobian;
  }
  return equations;
}

// A straight line through the first and last image stands for the geometry at the start.
Eigen::VectorXd start_of(std::span<const DirectImage> images) {
  const auto [low, high] = std::ranges::minmax_element(images, {}, &DirectImage::angle_rad);
  const Vec2 path = high->position_px - low->position_px;
  const double tangents = std::tan(high->angle_rad) - std::tan(low->angle_rad);
  const double sign = path.x < 0.0 ? -1.0 : 1.0;
  const double focal_length_px = sign * length(path) / std::max(tangents, 1e-6);
  const double roll = std::atan2(-sign * path.y, sign * path.x);
  const double radius = focal_length_px * std::tan(low->angle_rad);
  Eigen::VectorXd p(kParameters);
  p << low->position_px.x - radius * std::cos(roll), low->position_px.y + radius * std::sin(roll), focal_length_px, 0.0,
      0.0, roll;
  return p;
}

// Standard errors of the centre along the path and across it, from residuals of this variance.
Vec2 centre_errors(const Eigen::MatrixXd& hessian, double roll_rad, double variance) {
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(hessian);
  if (!lu.isInvertible()) return {1e9, 1e9};
  const Eigen::Matrix2d centre = variance * lu.inverse().topLeftCorner<2, 2>();
  const Eigen::Vector2d along(std::cos(roll_rad), -std::sin(roll_rad)), across(std::sin(roll_rad), std::cos(roll_rad));
  return {std::sqrt(std::max(along.dot(centre * along), 0.0)), std::sqrt(std::max(across.dot(centre * across), 0.0))};
}

struct Fitted {
  Eigen::VectorXd parameters;
  Eigen::MatrixXd hessian;
  double squares = 0, variance = 0;  // of the residuals; of a coordinate of an image
};

Fitted fitted(std::span<const DirectImage> images, const Eigen::VectorXd& start, const CentrePrior& prior) {
  const LeastSquaresProblem problem{[&](const Eigen::VectorXd& p) { return equations_of(p, images, prior); },
                                    [&](const Eigen::VectorXd& p) { return cost_of(p, images, prior); }};
  const LeastSquaresResult best = least_squares(problem, start, {200, 1e-14});
  Fitted fit{best.parameters, best.hessian, 0.0, 0.0};
  const SweepGeometry geometry = geometry_of(best.parameters);
  double freedom = -static_cast<double>(kParameters);
  for (const DirectImage& image : images) {
    const double off = term_of(geometry, image).residual.norm();
    fit.squares += weight(off) * off * off;
    freedom += 2.0;
  }
  fit.variance = fit.squares / std::max(freedom, 1.0);
  return fit;
}

// The centroid of what exceeds a level within a radius, in raw pixels.
struct Centroid {
  Vec2 at;
  double pixels = 0;
};

Centroid centroid_above(const RawFrame& frame, double level, Vec2 middle, double radius) {
  Centroid centroid;
  double weights = 0.0;
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const auto k = static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(x);
      const double above = frame.dn[k] - level;
      const Vec2 at{x + 0.5, y + 0.5};
      if (above <= 0.0 || length(at - middle) > radius) continue;
      centroid.at = centroid.at + at * above;
      weights += above;
      ++centroid.pixels;
    }
  }
  centroid.at = centroid.at * (1.0 / weights);
  return centroid;
}

}  // namespace

Vec2 SweepGeometry::position_of(double angle_rad) const {
  const double t = std::tan(angle_rad - zero_rad);
  const double radius = focal_length_px * t * (1.0 + distortion * t * t);
  return {centre_px.x + radius * std::cos(roll_rad), centre_px.y - radius * std::sin(roll_rad)};
}

std::optional<Vec2> direct_image_position(const RawFrame& direct) {
  if (direct.dn.empty()) return std::nullopt;
  const double highest = *std::ranges::max_element(direct.dn);
  const double range = direct.white_dn - direct.black_dn;
  if (highest - direct.black_dn < 0.02 * range || highest > direct.black_dn + kSaturated * range) return std::nullopt;
  const double above_black = highest - direct.black_dn;
  const Centroid bright = centroid_above(direct, direct.black_dn + kBrightPart * above_black, {}, 1e9);
  const double radius = kEdgeRadii * std::sqrt(bright.pixels / std::numbers::pi) + kEdgeMargin_px;
  const Centroid whole = centroid_above(direct, direct.black_dn + kFaintPart * above_black, bright.at, radius);
  return whole.at * 0.5;
}

ExpectedCentre expected_centre(int width, int height) { return {{0.5 * width, 0.5 * height}, kExpectedError * width}; }

Result<SweepGeometry> fit_geometry(std::span<const DirectImage> images, const std::optional<ExpectedCentre>& expected) {
  if (images.size() < kMinImages) {
    return invalid_argument(
        fmt::format("{} images of the light; at least {} determine the geometry", images.size(), kMinImages));
  }
  double spread = 0.0;
  for (const DirectImage& image : images)
    spread = std::max(spread, length(image.position_px - images.front().position_px));
  if (!(spread > kMinSpread_px)) {
    return invalid_argument(fmt::format("the light's image moves by {:.1f} pixels only: check the angles", spread));
  }
  if (expected && !(expected->error_px > 0.0)) return invalid_argument("the expected centre's error must be above 0");
  Fitted fit = fitted(images, start_of(images), {});
  if (expected) {
    const double error = std::max(std::sqrt(fit.variance), kLeastError_px) / expected->error_px;
    fit = fitted(images, fit.parameters, {expected->position_px, error * error});
  }
  SweepGeometry geometry = geometry_of(fit.parameters);
  geometry.rms_px = std::sqrt(fit.squares / static_cast<double>(images.size()));
  geometry.centre_error_px = centre_errors(fit.hessian, geometry.roll_rad, fit.variance);
  return geometry;
}

}  // namespace contrejour
