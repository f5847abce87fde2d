// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/flare_problem.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "base/tasks.h"
#include "measure/fit/pixel_equations.h"
#include "measure/model/flare_curves.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kChannels = 3;

struct GhostInStation {
  std::size_t index = 0;  // of the flare's ghosts
  GhostAtAngle at;
  GhostPixels pixels;
};

// A station's place if the optical centre were moved.
struct StationPlace {
  double s = 0;
  StationFrame frame;
};

StationPlace position_of(const FitStation& station, double centre_shift) {
  StationPlace place{station.s - centre_shift * station.frame.to_light.x, station.frame};
  place.frame.pixels.centre_px.x += centre_shift * station.frame.pixels.focal_length_px;
  if (place.s < 0.0) {
    place.s = -place.s;
    place.frame.to_light = place.frame.to_light * -1.0;
  }
  return place;
}

std::vector<GhostInStation> ghosts_in(const MeasuredFlare& flare, const StationPlace& station, bool with_derivatives) {
  std::vector<GhostInStation> ghosts;
  for (std::size_t k = 0; k < flare.ghosts.size(); ++k) {
    const auto at = ghost_at(flare.ghosts[k], station.s, flare.s_max);
    if (!at) continue;
    ghosts.push_back({k, *at, ghost_pixels(*at, station.frame, with_derivatives)});
  }
  return ghosts;
}

double area_of_pixel(const FitStation& station) {
  const double pixel = 1.0 / station.frame.pixels.focal_length_px;
  return pixel * pixel;
}

// Values of all pixels and channels.
std::vector<double> model_of(const std::vector<GhostInStation>& ghosts, const FitStation& station) {
  std::vector<double> model(station.rate.pixels.size(), 0.0);
  const double area = area_of_pixel(station);
  for (const GhostInStation& ghost : ghosts) {
    for (const GhostPixel& pixel : ghost.pixels.near_border) {
      for (std::size_t c = 0; c < kChannels; ++c) {
        const double level = ghost.at.border[c] * pixel.weights.border + pixel.inside[c] * pixel.weights.inside;
        model[kChannels * pixel.index + c] += area * level;
      }
    }
    for (const InnerPixel& pixel : ghost.pixels.inner) {
      for (std::size_t c = 0; c < kChannels; ++c) model[kChannels * pixel.index + c] += area * pixel.inside[c];
    }
    for (const std::uint32_t index : ghost.pixels.flat) {
      for (std::size_t c = 0; c < kChannels; ++c) model[kChannels * index + c] += area * ghost.at.inside[c];
    }
  }
  return model;
}

// A residual in standard deviations, its loss, and the factor by which robustness reduces its weight.
struct RobustTerm {
  double residual = 0, loss = 0, factor = 1;
};

RobustTerm robust_term(double difference, double weight, double huber) {
  const double residual = difference * std::sqrt(weight), size = std::abs(residual);
  if (size <= huber) return {residual, 0.5 * residual * residual, 1.0};
  return {residual, huber * (size - 0.5 * huber), huber / size};
}

double loss_of(const std::vector<double>& model, const FitStation& station, double huber) {
  double loss = 0.0;
  for (std::size_t k = 0; k < model.size(); ++k) {
    const auto weight = static_cast<double>(station.weight.pixels[k]);
    if (weight == 0.0) continue;
    loss += robust_term(model[k] - static_cast<double>(station.rate.pixels[k]), weight, huber).loss;
  }
  return loss;
}

// A ghost at a pixel: near its border, inside with a profile, or (neither) where its shade is flat.
struct GhostAtPixel {
  std::size_t ghost = 0;  // of the station's
  const GhostPixel* near_border = nullptr;
  const InnerPixel* inner = nullptr;
};

void set_border_term(const GhostInStation& ghost, const GhostPixel& pixel, double area, PixelTerm& term) {
  term.shape = kShapeCurves;
  for (std::size_t c = 0; c < kChannels; ++c) {
    std::array<double, kShapeCurves>& by_shape = term.by_shape[c];
    const double border = area * ghost.at.border[c], inside = area * pixel.inside[c];
    for (std::size_t k = 0; k < kShapeCurves; ++k)
      by_shape[k] = border * pixel.by_shape[k].border + inside * pixel.by_shape[k].inside;
    for (std::size_t k = 0; k < kPlaceCurves; ++k)
      by_shape[k] += area * pixel.weights.inside * pixel.inside_by_shape[k][c];
  }
  term.border = area * ghost.at.presence * pixel.weights.border;
  term.inside = area * ghost.at.presence * pixel.weights.inside;
}

void set_inner_term(const InnerPixel& pixel, double area, PixelTerm& term) {
  term.shape = kPlaceCurves;
  for (std::size_t c = 0; c < kChannels; ++c)
    for (std::size_t k = 0; k < kPlaceCurves; ++k) term.by_shape[c][k] = area * pixel.inside_by_shape[k][c];
  term.border = term.inside = 0.0;
}

void set_term(const std::vector<GhostInStation>& ghosts, const GhostAtPixel& at, double area, PixelTerm& term) {
  const GhostInStation& ghost = ghosts[at.ghost];
  term.ghost = at.ghost;
  if (at.near_border) return set_border_term(ghost, *at.near_border, area, term);
  if (at.inner) return set_inner_term(*at.inner, area, term);
  term.shape = 0;
  term.border = 0.0;
  term.inside = area * ghost.at.presence;
}

// The ghosts at all pixels, pixel after pixel and in ascending order.
struct GhostsAtPixels {
  std::vector<std::size_t> first;  // of each pixel, and the end
  std::vector<GhostAtPixel> ghosts;
};

GhostsAtPixels ghosts_at_pixels(const std::vector<GhostInStation>& ghosts, std::size_t pixels) {
  const auto for_each = [&](const auto& act) {
    for (std::size_t g = 0; g < ghosts.size(); ++g) {
      for (const GhostPixel& pixel : ghosts[g].pixels.near_border) act(pixel.index, GhostAtPixel{g, &pixel, nullptr});
      for (const InnerPixel& pixel : ghosts[g].pixels.inner) act(pixel.index, GhostAtPixel{g, nullptr, &pixel});
      for (const std::uint32_t index : ghosts[g].pixels.flat) act(index, GhostAtPixel{g, nullptr, nullptr});
    }
  };
  GhostsAtPixels all;
  all.first.resize(pixels + 1);
  for_each([&](std::uint32_t index, const GhostAtPixel& /*at*/) { ++all.first[index + 1]; });
  std::partial_sum(all.first.begin(), all.first.end(), all.first.begin());
  all.ghosts.resize(all.first.back());
  std::vector<std::size_t> next(all.first.begin(), all.first.end() - 1);
  for_each([&](std::uint32_t index, const GhostAtPixel& at) { all.ghosts[next[index]++] = at; });
  return all;
}

// A pixel's channels from an index on. Channels without weight may have any value.
PixelResidual residual_of(const std::vector<double>& model, const FitStation& station, std::size_t first,
                          double huber) {
  PixelResidual residual;
  for (std::size_t c = 0; c < kChannels; ++c) {
    const auto weight = static_cast<double>(station.weight.pixels[first + c]);
    if (weight == 0.0) continue;
    const double difference = model[first + c] - static_cast<double>(station.rate.pixels[first + c]);
    residual.weight[c] = weight * robust_term(difference, weight, huber).factor;
    residual.weighted[c] = residual.weight[c] * difference;
  }
  return residual;
}

// Normal equations of one station for the values of the curves of its ghosts, in the order of `ghosts`.
NormalEquations station_equations(const std::vector<GhostInStation>& ghosts, const FitStation& station, double huber) {
  const std::vector<double> model = model_of(ghosts, station);
  const double area = area_of_pixel(station);
  const GhostsAtPixels at_pixels = ghosts_at_pixels(ghosts, model.size() / kChannels);
  PixelEquations equations(ghosts.size());
  std::vector<PixelTerm> terms(ghosts.size());
  for (std::size_t index = 0; index + 1 < at_pixels.first.size(); ++index) {
    const std::size_t first = at_pixels.first[index], count = at_pixels.first[index + 1] - first;
    if (count == 0) continue;
    const PixelResidual residual = residual_of(model, station, kChannels * index, huber);
    if (residual.weight == std::array<double, kChannels>{}) continue;
    for (std::size_t k = 0; k < count; ++k) set_term(ghosts, at_pixels.ghosts[first + k], area, terms[k]);
    equations.add({terms.data(), count}, residual);
  }
  return {loss_of(model, station, huber), equations.gradient(), equations.hessian()};
}

// How a curve's value at a station depends on the unknowns.
struct CurveUnknowns {
  std::vector<Eigen::Index> index;
  std::vector<double> term;
};

// The shift of the optical centre moves all pixels and changes the light's angle.
CurveUnknowns unknowns_of(const FlareProblem& problem, const MeasuredFlare& flare, std::size_t ghost, std::size_t curve,
                          const StationPlace& place) {
  CurveUnknowns all;
  const ParameterLayout::CurveTerms terms = problem.layout.curve_terms(ghost, curve, place.s);
  for (std::size_t k = 0; k < terms.terms.size(); ++k) {
    all.index.push_back(terms.first + static_cast<Eigen::Index>(k));
    all.term.push_back(terms.terms[k]);
  }
  if (problem.with_centre) {
    const double by_s = curves_of(flare.ghosts[ghost])[curve]->derivative(place.s);
    all.index.push_back(problem.layout.size());
    all.term.push_back(place.frame.to_light.x * ((curve == 0 || curve == kClipCentre ? 1.0 : 0.0) - by_s));
  }
  return all;
}

// The chain rule from curves' values at a station to the unknowns.
void add_station(const NormalEquations& station, const std::vector<CurveUnknowns>& unknowns, NormalEquations& sum) {
  sum.cost += station.cost;
  for (std::size_t a = 0; a < unknowns.size(); ++a) {
    for (std::size_t i = 0; i < unknowns[a].index.size(); ++i) {
      const Eigen::Index row = unknowns[a].index[i];
      sum.gradient[row] += station.gradient[static_cast<Eigen::Index>(a)] * unknowns[a].term[i];
      // Blocks of a ghost with a later one stand above the diagonal only.
      for (std::size_t b = a / kGhostCurves * kGhostCurves; b < unknowns.size(); ++b) {
        const double value = station.hessian(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
        if (value == 0.0) continue;
        const bool same_ghost = a / kGhostCurves == b / kGhostCurves;
        for (std::size_t j = 0; j < unknowns[b].index.size(); ++j) {
          const Eigen::Index column = unknowns[b].index[j];
          sum.hessian(row, column) += value * unknowns[a].term[i] * unknowns[b].term[j];
          if (!same_ghost) sum.hessian(column, row) += value * unknowns[a].term[i] * unknowns[b].term[j];
        }
      }
    }
  }
}

// Adds the prior of the slopes' constant coefficients; `at`: the unknowns, `usual`: those of the flare given.
void add_prior(const FlareProblem& problem, const Eigen::VectorXd& at, const Eigen::VectorXd& usual,
               NormalEquations& sum) {
  constexpr std::array<std::size_t, 2> kSlopes{8, 9};
  const double weight = 1.0 / (problem.slope_error * problem.slope_error);
  for (std::size_t ghost = 0; ghost < problem.flare.ghosts.size(); ++ghost) {
    for (const std::size_t curve : kSlopes) {
      const ParameterLayout::CurveTerms terms = problem.layout.curve_terms(ghost, curve, 0.0);
      if (terms.terms.empty()) continue;
      const double off = at[terms.first] - usual[terms.first];
      sum.cost += 0.5 * weight * off * off;
      if (sum.gradient.size() == 0) continue;
      sum.gradient[terms.first] += weight * off;
      sum.hessian(terms.first, terms.first) += weight;
    }
  }
}

}  // namespace

void move_centre(FitStation& station, double centre_shift) {
  const StationPlace place = position_of(station, centre_shift);
  station.s = place.s;
  station.frame = place.frame;
}

Image model_image(const MeasuredFlare& flare, const FitStation& station) {
  const std::vector<double> model = model_of(ghosts_in(flare, position_of(station, 0.0), false), station);
  Image image(station.rate.width, station.rate.height);
  std::transform(model.begin(), model.end(), image.pixels.begin(), [](double v) { return static_cast<float>(v); });
  return image;
}

double FlareProblem::cost(const Eigen::VectorXd& unknowns) const {
  const double shift = with_centre ? unknowns[layout.size()] : 0.0;
  const MeasuredFlare now = layout.unpack(flare, unknowns);
  double sum = 0.0;
  ordered_pipeline(
      stations.size(), context,
      [&](std::size_t k) {
        const auto ghosts = ghosts_in(now, position_of(stations[k], shift), false);
        return loss_of(model_of(ghosts, stations[k]), stations[k], huber);
      },
      [&](std::size_t /*k*/, double loss) { sum += loss; });
  NormalEquations prior;
  add_prior(*this, unknowns, layout.pack(flare), prior);
  return sum + prior.cost;
}

NormalEquations FlareProblem::equations(const Eigen::VectorXd& unknowns) const {
  struct OfStation {
    std::vector<GhostInStation> ghosts;
    std::vector<CurveUnknowns> unknowns;
    NormalEquations equations;
  };
  const MeasuredFlare now = layout.unpack(flare, unknowns);
  const double shift = with_centre ? unknowns[layout.size()] : 0.0;
  const Eigen::Index size = unknowns.size();
  NormalEquations sum{0.0, Eigen::VectorXd::Zero(size), Eigen::MatrixXd::Zero(size, size)};
  ordered_pipeline(
      stations.size(), context,
      [&](std::size_t k) {
        OfStation one;
        const StationPlace place = position_of(stations[k], shift);
        one.ghosts = ghosts_in(now, place, true);
        for (const GhostInStation& ghost : one.ghosts) {
          for (std::size_t curve = 0; curve < kGhostCurves; ++curve)
            one.unknowns.push_back(unknowns_of(*this, now, ghost.index, curve, place));
        }
        one.equations = station_equations(one.ghosts, stations[k], huber);
        return one;
      },
      [&](std::size_t /*k*/, const OfStation& one) { add_station(one.equations, one.unknowns, sum); });
  add_prior(*this, unknowns, layout.pack(flare), sum);
  return sum;
}

}  // namespace contrejour::inline internal
