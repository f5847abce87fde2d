// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include "base/units.h"
#include "contrejour/expert/learn_lens.h"
#include "contrejour/expert/trace.h"
#include "measure/fit/levenberg_marquardt.h"
#include "measure/prescription/lens_numbers.h"
#include "measure/prescription/measured_figures.h"

namespace contrejour {
namespace {

constexpr int kNarrowest = 64;          // pixels of the coarsest resolution
constexpr double kCentreTolerance = 0.03;  // of the picture's width: how far the lens's axis may be from its middle
constexpr double kLeastCentreError_px = 0.05;  // of the light's image on the axis, full-size merged pixels
constexpr double kLeastSpanError_px = 0.1;     // of half the distance of two images
constexpr double kSpan = 0.7;                  // of the largest angle: where that distance is compared
constexpr double kPriorDominates = 0.7;  // of the tolerance: a standard error above this part of it says little
constexpr double kTogether = 0.7;  // relative tilts are noted if their errors are below this part of the tilts' own
constexpr double kMostTolerances = 6.0;  // a number's bounds
constexpr double kSettledCost = 1e-3;
// How the noise of drawings is found: by drawing the lens again after changes of this part of each prior.
constexpr int kNoiseDrawings = 3;
constexpr double kNoiseStep = 1e-3;

// One resolution.
struct PyramidLevel {
  LensStations stations;
  std::vector<Ghost> ghosts;
  std::vector<Image> weights;  // of pixels, kept while the lens changes
  std::vector<Eigen::MatrixXd> derivatives;
  // The light's own images (light_images_px): as the sweep's geometry has them, and their derivatives.
  double span_rad = 0;
  Eigen::Vector3d light_px = Eigen::Vector3d::Zero(), light_error_px = Eigen::Vector3d::Ones();
  Eigen::MatrixXd light_derivatives = {};
};

struct Adjustment {
  const LensPhotographs& photographs;
  const AdjustOptions& options;
  AdjustableLens lens;
  Eigen::VectorXd unknowns;  // the numbers, then the centre's shift in pixels of the level
  Eigen::VectorXd prior;     // standard errors
  int drawings = 0;
  std::optional<Error> error;
};

Result<PyramidLevel> prepare_level(const Adjustment& adjustment, int width, const Context& context) {
  auto stations = lens_stations(adjustment.photographs, adjustment.lens.nominal, width, context);
  if (!stations) return tl::unexpected(stations.error());
  auto ghosts = visible_ghosts(*stations, adjustment.lens.nominal, adjustment.options.max_ghosts, context);
  if (!ghosts) return tl::unexpected(ghosts.error());
  if (ghosts->empty()) return invalid_argument("no ghost of this lens reaches the pictures");
  return PyramidLevel{std::move(*stations), std::move(*ghosts), {}, {}};
}

Result<MeasuredFigures> measure(Adjustment& adjustment, PyramidLevel& level, const Eigen::VectorXd& unknowns,
                                const Context& context) {
  const auto state = lens_of(adjustment.lens, unknowns);
  if (!state) return tl::unexpected(state.error());
  ++adjustment.drawings;
  return measured_figures({&level.stations, *state, level.ghosts, adjustment.options.model_error},
                          centre_of(level.stations, unknowns), level.weights, context);
}

// The light's own images behind the lens, as the sweep's geometry describes them: the image of light perpendicular
// to the sensor, which is the geometry's centre (tilted elements leave it nearly where the lens's axis meets the
// sensor, decentred ones move it), and half the distance of two images at either side.
Result<Eigen::Vector3d> light_images_px(const Adjustment& adjustment, const PyramidLevel& level,
                                        const Eigen::VectorXd& unknowns) {
  const auto state = lens_of(adjustment.lens, unknowns);
  if (!state) return tl::unexpected(state.error());
  const Frame frame = frame_of(level.stations, centre_of(level.stations, unknowns));
  const auto image_px = [&](double angle_rad) {
    return frame.pixel_from_sensor(
        chief_ray_image_point(*state, {direction_from_angles(angle_rad, 0.0)}, state->design_wavelength_nm));
  };
  const Vec2 middle = image_px(0.0);
  const double half = 0.5 * length(image_px(level.span_rad) - image_px(-level.span_rad));
  return Eigen::Vector3d{middle.x, middle.y, half};
}

// Sets these three figures as the sweep's geometry has them, with their standard errors.
void set_light_images(const Adjustment& adjustment, PyramidLevel& level) {
  const SweepGeometry& geometry = adjustment.photographs.geometry;
  const std::vector<double>& angles = adjustment.photographs.sweep.angles_rad;
  level.span_rad = 0.0;
  for (const double angle : angles)
    level.span_rad = std::max(level.span_rad, kSpan * std::abs(angle - geometry.zero_rad));
  const double half = 0.5 * length(geometry.position_of(geometry.zero_rad + level.span_rad) -
                                   geometry.position_of(geometry.zero_rad - level.span_rad));
  const auto count = static_cast<double>(angles.size());
  const double scatter = geometry.rms_px * std::sqrt(count / std::max(count - 5.0, 1.0));  // five were fitted
  const double to_level = level.stations.full_pitch_mm / level.stations.pixel_pitch_mm;
  level.light_px = {level.stations.centre_px.x, level.stations.centre_px.y, to_level * half};
  level.light_error_px = to_level * Eigen::Vector3d{std::hypot(geometry.centre_error_px.x, kLeastCentreError_px),
                                                    std::hypot(geometry.centre_error_px.y, kLeastCentreError_px),
                                                    std::hypot(scatter / std::sqrt(count), kLeastSpanError_px)};
}

Result<void> set_light_derivatives(const Adjustment& adjustment, PyramidLevel& level) {
  const Eigen::VectorXd& at = adjustment.unknowns;
  level.light_derivatives.setZero(3, at.size());
  for (Eigen::Index n = 0; n < at.size(); ++n) {
    const bool is_number = n < at.size() - 2;
    const double step = is_number ? difference_step(adjustment.lens.numbers[static_cast<std::size_t>(n)]) : 0.5;
    Eigen::VectorXd up = at, down = at;
    up[n] += step;
    down[n] -= step;
    const auto above = light_images_px(adjustment, level, up);
    const auto below = light_images_px(adjustment, level, down);
    if (!above || !below) return tl::unexpected((above ? below : above).error());
    level.light_derivatives.col(n) = (*above - *below) / (2.0 * step);
  }
  return {};
}

void add_light_images(const PyramidLevel& level, const Eigen::Vector3d& images_px, NormalEquations& equations) {
  const Eigen::Vector3d off = images_px - level.light_px;
  const Eigen::Vector3d weight = level.light_error_px.cwiseAbs2().cwiseInverse();
  equations.cost += 0.5 * off.dot(weight.cwiseProduct(off));
  equations.gradient += level.light_derivatives.transpose() * weight.cwiseProduct(off);
  equations.hessian += level.light_derivatives.transpose() * weight.asDiagonal() * level.light_derivatives;
}

NormalEquations equations_of(const MeasuredFigures& figures, const PyramidLevel& level, const Eigen::VectorXd& unknowns,
                             const Eigen::VectorXd& prior) {
  const Eigen::VectorXd inverse = prior.cwiseAbs2().cwiseInverse();
  NormalEquations equations;
  equations.cost = figures.cost() + 0.5 * unknowns.cwiseAbs2().dot(inverse);
  equations.gradient = inverse.cwiseProduct(unknowns);
  equations.hessian = inverse.asDiagonal();
  for (std::size_t k = 0; k < figures.by_station.size(); ++k) {
    const StationFigures& of = figures.by_station[k];
    const Eigen::MatrixXd& by = level.derivatives[k];
    equations.gradient -= by.transpose() * (of.weight * of.off);
    equations.hessian += by.transpose() * of.weight * by;
  }
  return equations;
}

// The difference between drawings of nearly the same lens.
struct DrawingNoise {
  double cost = 0;  // RMS
  Eigen::MatrixXd covariance;  // of the unknowns that fit best
};

// A renderer's errors change with the lens, however little that changes.
DrawingNoise drawing_noise(const LeastSquaresProblem& problem, const Eigen::VectorXd& at,
                           const Eigen::VectorXd& prior) {
  const NormalEquations here = problem.equations(at);
  const Eigen::LDLT<Eigen::MatrixXd> solver(here.hessian);
  DrawingNoise noise{0.0, Eigen::MatrixXd::Zero(at.size(), at.size())};
  for (int k = 0; k < kNoiseDrawings; ++k) {
    Eigen::VectorXd step = kNoiseStep * prior;
    for (Eigen::Index n = 0; n < step.size(); ++n)
      if (((n + k) * (k + 1)) % 3 == 0) step[n] = -step[n];
    const NormalEquations there = problem.equations(at + step);
    if (!std::isfinite(there.cost)) continue;  // surfaces touch, or the caller has cancelled
    const Eigen::VectorXd change = here.hessian * step;
    noise.cost += std::pow(there.cost - here.cost - step.dot(here.gradient + 0.5 * change), 2) / kNoiseDrawings;
    // Both drawings err.
    const Eigen::VectorXd moved = solver.solve(there.gradient - here.gradient - change);
    noise.covariance += moved * moved.transpose() / (2.0 * kNoiseDrawings);
  }
  noise.cost = std::sqrt(noise.cost);
  return noise;
}

struct LevelResult {
  LeastSquaresResult fit;
  DrawingNoise noise;  // of the finest resolution
};

// Levenberg-Marquardt in one resolution. A lens that cannot be, with surfaces that cross, has an infinite cost. In the
// finest one, steps go on until they are predicted to gain nothing, though the noise of drawings hides what each gains.
Result<LevelResult> fit_level(Adjustment& adjustment, PyramidLevel& level, bool is_finest, const Context& context) {
  auto derivatives = figure_derivatives(level.stations, adjustment.lens, adjustment.unknowns, level.ghosts, context);
  if (!derivatives) return tl::unexpected(derivatives.error());
  level.derivatives = std::move(*derivatives);
  set_light_images(adjustment, level);
  if (auto ok = set_light_derivatives(adjustment, level); !ok) return tl::unexpected(ok.error());
  LeastSquaresProblem problem;
  problem.equations = [&](const Eigen::VectorXd& unknowns) {
    const auto figures = measure(adjustment, level, unknowns, context);
    const auto images_px = light_images_px(adjustment, level, unknowns);
    if (figures && images_px) {
      NormalEquations equations = equations_of(*figures, level, unknowns, adjustment.prior);
      add_light_images(level, *images_px, equations);
      return equations;
    }
    if (!figures && figures.error().code == ErrorCode::Cancelled) adjustment.error = figures.error();
    return NormalEquations{std::numeric_limits<double>::infinity(), Eigen::VectorXd::Zero(unknowns.size()),
                           Eigen::MatrixXd::Identity(unknowns.size(), unknowns.size())};
  };
  problem.cost = [&](const Eigen::VectorXd& unknowns) { return problem.equations(unknowns).cost; };
  problem.lower = -kMostTolerances * adjustment.prior;
  problem.upper = kMostTolerances * adjustment.prior;
  const int most = adjustment.options.max_iterations;
  LevelResult result{least_squares(problem, adjustment.unknowns, {most, kSettledCost}), {}};
  if (is_finest && !adjustment.error && std::isfinite(result.fit.cost)) {
    result.noise = drawing_noise(problem, result.fit.parameters, adjustment.prior);
    result.fit = least_squares(problem, result.fit.parameters, {most, kSettledCost, result.noise.cost});
  }
  if (adjustment.error) return tl::unexpected(*adjustment.error);
  if (!std::isfinite(result.fit.cost)) return invalid_argument("the lens as its file has it cannot be drawn");
  adjustment.unknowns = result.fit.parameters;
  return result;
}

// The centre's unknowns in the pixels of a level.
void set_centre_scale(Adjustment& adjustment, const PyramidLevel& level, double& last_pitch_mm) {
  const double pitch_mm = level.stations.pixel_pitch_mm;
  if (last_pitch_mm > 0.0) adjustment.unknowns.tail(2) *= last_pitch_mm / pitch_mm;
  last_pitch_mm = pitch_mm;
  adjustment.prior.tail(2).setConstant(kCentreTolerance * level.stations.pictures.stations.front().rate.width);
}

// Resolutions from coarse to fine.
std::vector<int> widths_of(int width) {
  std::vector<int> widths{width};
  while (widths.front() / 2 >= kNarrowest) widths.insert(widths.begin(), widths.front() / 2);
  return widths;
}

// Residuals that are larger than expected count, too, and the noise of drawings.
Eigen::MatrixXd covariance_of(const LevelResult& result, const Eigen::VectorXd& prior, double figures) {
  const Eigen::VectorXd inverse = prior.cwiseAbs2().cwiseInverse();
  const double scale = std::max(2.0 * result.fit.cost / std::max(figures, 1.0), 1.0);
  Eigen::MatrixXd hessian = (result.fit.hessian - Eigen::MatrixXd(inverse.asDiagonal())) / scale;
  hessian += inverse.asDiagonal();
  Eigen::MatrixXd covariance = hessian.ldlt().solve(Eigen::MatrixXd::Identity(hessian.rows(), hessian.cols()));
  covariance += result.noise.covariance;
  return covariance;
}

std::string tilted_body(const LearntNumber& tilt) {
  return tilt.first == tilt.last ? fmt::format("surface {}", tilt.first)
                                 : fmt::format("surfaces {}-{}", tilt.first, tilt.last);
}

// Turning all elements together looks like a shift of the axis, so that each tilt may be uncertain where its difference
// from their mean is not: a note with these differences.
void note_relative_tilts(const std::vector<LearntNumber>& numbers, const Eigen::MatrixXd& covariance, LearntKind kind,
                         AdjustedLens& adjusted) {
  Eigen::VectorXd is_tilt = Eigen::VectorXd::Zero(covariance.rows()), values = is_tilt;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    is_tilt[at] = numbers[k].kind == kind ? 1.0 : 0.0;
    values[at] = numbers[k].value;
  }
  const double count = is_tilt.sum();
  if (count < 2.0) return;
  std::string list;
  double least_error = std::numeric_limits<double>::infinity(), most_relative = 0.0;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    if (numbers[k].kind != kind) continue;
    Eigen::VectorXd difference = -is_tilt / count;
    difference[static_cast<Eigen::Index>(k)] += 1.0;
    const double error = std::sqrt(std::max(difference.dot(covariance * difference), 0.0));
    list += fmt::format("{}{} {:+.3f} +- {:.3f}", list.empty() ? "" : ", ", tilted_body(numbers[k]),
                        deg_from_rad(difference.dot(values)), deg_from_rad(error));
    least_error = std::min(least_error, numbers[k].error);
    most_relative = std::max(most_relative, error);
  }
  if (!(most_relative < kTogether * least_error)) return;
  adjusted.warnings.push_back(
      fmt::format("the pictures hardly tell a tilt of all elements together from a shift of the axis; over the mean of "
                  "all, the tilts about {} are, in degrees: {}",
                  kind == LearntKind::TiltX ? "x" : "y", list));
}

void add_numbers(const Adjustment& adjustment, const Eigen::MatrixXd& covariance, AdjustedLens& adjusted) {
  const Eigen::VectorXd errors = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  adjusted.numbers = adjustment.lens.numbers;
  std::string open;
  for (std::size_t k = 0; k < adjusted.numbers.size(); ++k) {
    LearntNumber& number = adjusted.numbers[k];
    number.value = adjustment.unknowns[static_cast<Eigen::Index>(k)];
    number.error = errors[static_cast<Eigen::Index>(k)];
    number.determined = number.error < kPriorDominates * number.tolerance;
    if (!number.determined) open += (open.empty() ? "" : "; ") + learnt_name(number);
  }
  for (const LearntKind kind : {LearntKind::TiltX, LearntKind::TiltY})
    note_relative_tilts(adjusted.numbers, covariance, kind, adjusted);
  if (!open.empty()) adjusted.warnings.push_back("the pictures say little beyond their tolerances about the " + open);
}

// The stop's radius in the file: wide open, the f-number that gives it.
void write_stop(const Adjustment& adjustment, AdjustedLens& adjusted) {
  const auto radius = std::ranges::find(adjusted.numbers, LearntKind::StopRadius, &LearntNumber::kind);
  if (radius == adjusted.numbers.end() || !radius->determined) return;
  if (adjustment.photographs.settings.f_number) {
    adjusted.warnings.push_back(fmt::format(
        "the stop's radius was {:+.2f} per cent off that of the f-number that was set; a lens's file has no "
        "place for that",
        100.0 * radius->value));
    return;
  }
  adjusted.lens.f_number /= 1.0 + radius->value;
  for (Surface& surface : adjusted.lens.surfaces)
    if (surface.kind == SurfaceKind::Stop) surface.semi_diameter_mm *= 1.0 + radius->value;
}

Result<void> check(const AdjustOptions& options) {
  const LensTolerances& of = options.tolerances;
  for (const double tolerance :
       {of.tilt_rad, of.decentre_mm, of.gap_mm, of.focus_mm, of.stop_radius, of.stop_position_mm})
    if (!(tolerance >= 0.0 && std::isfinite(tolerance))) return invalid_argument("tolerances must be 0 or more");
  if (options.max_ghosts < 1 || options.max_iterations < 1 || !(options.model_error >= 0.0))
    return invalid_argument("ghosts and iterations must be 1 or more, the error of the model 0 or more");
  return {};
}

}  // namespace

Result<AdjustedLens> adjust_lens(const LensPhotographs& photographs, const AdjustOptions& options,
                                 const Context& context) {
  if (auto ok = check(options); !ok) return tl::unexpected(ok.error());
  auto lens = adjustable_lens(photographs.lens, photographs.settings, options.tolerances);
  if (!lens) return tl::unexpected(lens.error());
  Adjustment adjustment{photographs, options, std::move(*lens), {}, {}, 0, {}};
  const auto count = static_cast<Eigen::Index>(adjustment.lens.numbers.size());
  adjustment.unknowns = Eigen::VectorXd::Zero(count + 2);
  adjustment.prior = Eigen::VectorXd::Ones(count + 2);
  for (Eigen::Index k = 0; k < count; ++k)
    adjustment.prior[k] = adjustment.lens.numbers[static_cast<std::size_t>(k)].tolerance;
  AdjustedLens adjusted;
  double pitch_mm = 0.0;
  const auto finest = lens_stations(photographs, adjustment.lens.nominal, options.max_width, context);
  if (!finest) return tl::unexpected(finest.error());
  const std::vector<int> widths = widths_of(finest->pictures.stations.front().rate.width);
  for (const int width : widths) {
    auto level = prepare_level(adjustment, width, context);
    if (!level) return tl::unexpected(level.error());
    const double full_pitch_mm = level->stations.full_pitch_mm;
    set_centre_scale(adjustment, *level, pitch_mm);
    const auto result = fit_level(adjustment, *level, width == widths.back(), context);
    if (!result) return tl::unexpected(result.error());
    if (width != widths.back()) continue;
    const double to_full = level->stations.pixel_pitch_mm / full_pitch_mm;
    const auto after = measure(adjustment, *level, adjustment.unknowns, context);
    const auto before = measure(adjustment, *level, Eigen::VectorXd::Zero(count + 2), context);
    if (!after || !before) return tl::unexpected((after ? before : after).error());
    adjusted.rms_before_px = to_full * before->rms_px();
    adjusted.rms_after_px = to_full * after->rms_px();
    adjusted.centre_px = centre_of(level->stations, adjustment.unknowns) * to_full;
    adjusted.ghosts = level->ghosts;
    double figures = 0.0;
    for (const StationFigures& of : after->by_station) figures += of.count;
    add_numbers(adjustment, covariance_of(*result, adjustment.prior, figures), adjusted);
  }
  adjusted.lens = adjustment.lens.prescription(adjustment.unknowns.head(count));
  write_stop(adjustment, adjusted);
  adjusted.drawings = adjustment.drawings;
  return adjusted;
}

}  // namespace contrejour
