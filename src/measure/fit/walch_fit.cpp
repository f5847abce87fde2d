// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/walch_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <Eigen/Dense>

#include "measure/fit/ghost_pixels.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kWalchParameters = 12;
constexpr std::size_t kPredictFrom = 4;  // stations, from which on a parabola predicts the next
constexpr double kScaleOfZero = 1e-4;     // of a parameter that is 0, for its step
using WalchParameters = std::array<double, kWalchParameters>;

// Shape before shade, as the paper orders them.
WalchParameters walch_parameters(const GhostAtAngle& g) {
  return {g.outline.centre,     g.outline.left,        g.outline.right,  g.outline.half_height,
          g.outline.round_left, g.outline.round_right, g.border[0],      g.inside[0],
          g.shade.fade_in,      g.shade.fade_out,      g.shade.slope_in, g.shade.slope_out};
}

GhostAtAngle walch_ghost(const WalchParameters& p) {
  const auto above = [](double x, double smallest) { return std::max(x, smallest); };
  GhostAtAngle g;
  g.outline = {p[0],
               above(p[1], 1e-6),
               above(p[2], 1e-6),
               above(p[3], 1e-6),
               std::clamp(p[4], 0.05, 1.0),
               std::clamp(p[5], 0.05, 1.0)};
  g.shade = {above(p[8], 0.0), above(p[9], 0.0), above(p[10], 0.05), above(p[11], 0.05)};
  g.border[0] = above(p[6], 0.0);
  g.inside[0] = above(p[7], 0.0);
  return g;
}

std::vector<double> gauss_kernel(double sigma) {
  const int half = static_cast<int>(std::ceil(3.0 * sigma));
  std::vector<double> kernel;
  for (int k = -half; k <= half; ++k) kernel.push_back(std::exp(-0.5 * k * k / (sigma * sigma)));
  const double sum = std::accumulate(kernel.begin(), kernel.end(), 0.0);
  for (double& w : kernel) w /= sum;
  return kernel;
}

Image filtered_along(const Image& image, const std::vector<double>& kernel, int dx, int dy) {
  Image result(image.width, image.height, 1);
  const int half = static_cast<int>(kernel.size() / 2);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      double sum = 0.0;
      for (int k = -half; k <= half; ++k) {
        sum += kernel[static_cast<std::size_t>(k + half)] *
               static_cast<double>(
                   image.at(std::clamp(x + k * dx, 0, image.width - 1), std::clamp(y + k * dy, 0, image.height - 1)));
      }
      result.at(x, y) = static_cast<float>(sum);
    }
  }
  return result;
}

Image smoothed(const Image& image, double sigma) {
  const std::vector<double> kernel = gauss_kernel(sigma);
  return filtered_along(filtered_along(image, kernel, 1, 0), kernel, 0, 1);
}

Image laplacian(const Image& image) {
  Image result(image.width, image.height, 1);
  for (int y = 1; y + 1 < image.height; ++y) {
    for (int x = 1; x + 1 < image.width; ++x) {
      float around = 0.0F;
      for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) around += image.at(x + i, y + j);
      }
      result.at(x, y) = around - 9.0F * image.at(x, y);
    }
  }
  return result;
}

// Edges of the smoothed picture, smoothed again. All steps are linear, so that a difference's edges are the difference
// of edges.
Image edges_of(const Image& image, double sigma) { return smoothed(laplacian(smoothed(image, sigma)), sigma); }

double mean_square(const Image& image) {
  double sum = 0.0;
  for (const float v : image.pixels) sum += static_cast<double>(v) * static_cast<double>(v);
  return sum / static_cast<double>(std::max<std::size_t>(image.pixels.size(), 1));
}

// The parabola through a parameter's values at the stations fitted last, at the next one.
double predicted(std::span<const double> s, std::span<const double> values, double at) {
  const auto count = static_cast<Eigen::Index>(s.size());
  Eigen::MatrixXd powers(count, 3);
  Eigen::VectorXd right(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double x = s[static_cast<std::size_t>(k)] - at;
    powers.row(k) << 1.0, x, x * x;
    right[k] = values[static_cast<std::size_t>(k)];
  }
  return powers.colPivHouseholderQr().solve(right)[0];
}

WalchCost scaled_costs(const Image& picture, const Image& model, double smoothing_px, const WalchCost& scale) {
  Image difference = picture;
  for (std::size_t k = 0; k < difference.pixels.size(); ++k) difference.pixels[k] -= model.pixels[k];
  if (!(scale.mse > 0.0 && scale.edges > 0.0)) return {};
  return {mean_square(difference) / scale.mse, mean_square(edges_of(difference, smoothing_px)) / scale.edges};
}

double total(const WalchCost& cost, const WalchSettings& settings) {
  return settings.mse_weight * cost.mse + settings.edge_weight * cost.edges;
}

// The descent at one station.
struct WalchDescent {
  const FitStation& station;
  const WalchSettings& settings;
  Image picture;
  WalchFit& fit;
  std::vector<WalchParameters> at;
  double cost = 0;
  WalchCost scale = walch_scale(picture, settings.smoothing_px);

  [[nodiscard]] static Image model_of(const std::vector<WalchParameters>& parameters, const FitStation& station) {
    std::vector<GhostAtAngle> ghosts;
    for (const WalchParameters& p : parameters) ghosts.push_back(walch_ghost(p));
    return grey_model(ghosts, station);
  }

  double cost_of(const std::vector<WalchParameters>& parameters) {
    ++fit.image_evaluations;
    return total(scaled_costs(picture, model_of(parameters, station), settings.smoothing_px, scale), settings);
  }

  [[nodiscard]] WalchCost costs() const {
    return scaled_costs(picture, model_of(at, station), settings.smoothing_px, scale);
  }

  // A central difference says which way to go; the parameter is used as soon as it is updated.
  void descend(std::size_t ghost, std::size_t parameter, double& step) {
    std::vector<WalchParameters> more = at, less = at;
    more[ghost][parameter] += step;
    less[ghost][parameter] -= step;
    const double up = cost_of(more), down = cost_of(less);
    if (std::min(up, down) >= cost) {
      step *= 0.5;
      return;
    }
    at = up < down ? std::move(more) : std::move(less);
    cost = std::min(up, down);
  }
};

double scale_of(double value) { return std::max(std::abs(value), kScaleOfZero); }

std::vector<WalchParameters> start_of(const std::vector<std::vector<WalchParameters>>& fitted,
                                      std::span<const double> s, double at) {
  std::size_t nearest = 0;
  for (std::size_t k = 1; k < s.size(); ++k) {
    if (std::abs(s[k] - at) < std::abs(s[nearest] - at)) nearest = k;
  }
  std::vector<WalchParameters> start = fitted[nearest];
  if (fitted.size() < kPredictFrom) return start;
  for (std::size_t g = 0; g < start.size(); ++g) {
    for (std::size_t k = 0; k < kWalchParameters; ++k) {
      std::vector<double> values;
      for (const auto& one : fitted) values.push_back(one[g][k]);
      start[g][k] = predicted(s, values, at);
    }
  }
  return start;
}

}  // namespace

std::vector<GhostAtAngle> grey_ghosts(const MeasuredFlare& flare, double s) {
  std::vector<GhostAtAngle> ghosts;
  for (const MeasuredGhost& ghost : flare.ghosts) {
    auto at = ghost_at(ghost, s, flare.s_max);
    if (!at) continue;
    at->border[0] += at->border[1] + at->border[2];
    at->inside[0] += at->inside[1] + at->inside[2];
    ghosts.push_back(*at);
  }
  return ghosts;
}

Image grey_picture(const FitStation& station) {
  Image grey(station.rate.width, station.rate.height, 1);
  for (std::size_t k = 0; k < grey.pixels.size(); ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (station.weight.pixels[3 * k + c] > 0.0F) grey.pixels[k] += station.rate.pixels[3 * k + c];
    }
  }
  return grey;
}

Image grey_model(std::span<const GhostAtAngle> ghosts, const FitStation& station) {
  Image grey(station.rate.width, station.rate.height, 1);
  const double pixel = 1.0 / station.frame.pixels.focal_length_px;
  for (const GhostAtAngle& ghost : ghosts) {
    const GhostPixels pixels = ghost_pixels(ghost, station.frame, false);
    for (const GhostPixel& p : pixels.near_border) {
      grey.pixels[p.index] +=
          static_cast<float>(pixel * pixel * (ghost.border[0] * p.weights.border + ghost.inside[0] * p.weights.inside));
    }
    for (const std::uint32_t index : pixels.flat)
      grey.pixels[index] += static_cast<float>(pixel * pixel * ghost.inside[0]);
  }
  for (std::size_t k = 0; k < grey.pixels.size(); ++k) {
    if (station.weight.pixels[3 * k] == 0.0F) grey.pixels[k] = 0.0F;
  }
  return grey;
}

WalchCost walch_scale(const Image& picture, double smoothing_px) {
  return {mean_square(picture), mean_square(edges_of(picture, smoothing_px))};
}

WalchCost walch_costs(const Image& picture, const Image& model, double smoothing_px) {
  return scaled_costs(picture, model, smoothing_px, walch_scale(picture, smoothing_px));
}

double walch_cost(const Image& picture, const Image& model, const WalchSettings& settings) {
  return total(walch_costs(picture, model, settings.smoothing_px), settings);
}

WalchFit walch_fit(std::span<const FitStation> stations, const MeasuredFlare& start, const WalchSettings& settings,
                   const Context& context) {
  WalchFit fit;
  fit.ghosts.resize(stations.size());
  std::vector<std::size_t> order(stations.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
    const auto off = [&](std::size_t k) { return std::abs(stations[k].s - 0.5 * start.s_max); };
    return off(a) < off(b) || (off(a) == off(b) && a < b);
  });
  std::vector<std::vector<WalchParameters>> fitted;
  std::vector<double> fitted_s;
  double cost_sum = 0.0;
  for (const std::size_t k : order) {
    std::vector<WalchParameters> from;
    if (fitted.empty()) {
      for (const GhostAtAngle& at : grey_ghosts(start, stations[k].s)) from.push_back(walch_parameters(at));
    } else {
      from = start_of(fitted, fitted_s, stations[k].s);
    }
    WalchDescent descent{stations[k], settings, grey_picture(stations[k]), fit, from, 0.0};
    descent.cost = descent.cost_of(descent.at);
    std::vector<WalchParameters> steps = from;
    for (WalchParameters& ghost : steps) {
      for (double& step : ghost) step = settings.first_step * scale_of(step);
    }
    for (int iteration = 0; iteration < settings.iterations; ++iteration) {
      if (context.cancelled()) return fit;
      for (std::size_t g = 0; g < from.size(); ++g) {
        for (std::size_t p = 0; p < kWalchParameters; ++p) descent.descend(g, p, steps[g][p]);
      }
      if ((iteration + 1) % settings.iterations_per_rate == 0) {
        for (WalchParameters& ghost : steps) {
          for (double& step : ghost) step *= settings.rate_decay;
        }
      }
      fit.progress.push_back(
          {fit.image_evaluations, (cost_sum + descent.cost) / static_cast<double>(fitted.size() + 1)});
      fit.steps.push_back({k, fit.image_evaluations, descent.costs()});
    }
    cost_sum += descent.cost;
    fitted.push_back(descent.at);
    fitted_s.push_back(stations[k].s);
    for (const WalchParameters& p : descent.at) fit.ghosts[k].push_back(walch_ghost(p));
  }
  return fit;
}

}  // namespace contrejour::inline internal
