// SPDX-License-Identifier: Apache-2.0
// Pictures of a lens's ghosts from published polynomials, with the faults of sabatschus2022's code one by one.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <vector>

#include "base/tasks.h"
#include "contrejour/expert/ghost.h"
#include "contrejour/expert/iris.h"
#include "polynomial/published/ghost_rays_to_fit.h"
#include "polynomial/published/light_polynomial.h"
#include "polynomial/published/splat.h"

namespace contrejour::inline internal::polynomial {
namespace {

using published::PictureOptions;

struct DrawnGhost {
  Ghost ghost;
  Rectangle box;  // of the plane z = 0 that its rays come through
};

std::vector<DrawnGhost> drawn_ghosts(const LensState& lens, const PictureOptions& options, const Context& context) {
  const std::vector<Ghost> ghosts = enumerate_ghosts(lens, GhostScope::OneSideOfStop);
  std::vector<std::optional<Rectangle>> openings(ghosts.size());
  parallel_for(ghosts.size(), {context.threads, context.cancel, {}}, [&](std::size_t k) {
    openings[k] = GhostToFit(lens, ghosts[k], options.lambda_nm).opening(options.light);
  });
  std::vector<DrawnGhost> drawn;
  for (std::size_t k = 0; k < ghosts.size(); ++k)
    if (openings[k]) drawn.push_back({ghosts[k], *openings[k]});
  return drawn;
}

// The polynomials that the renderer reads for a ghost: outputs of whichever ghosts stand there.
struct ReadOutputs {
  Ghost x_of, y_of;
  std::size_t x_output = 0, y_output = 1;  // 0: x, 1: y
  Ghost stop_of;
};

// All pairs of surfaces, from 1, in the published order.
std::vector<Ghost> all_pairs(const LensState& lens, bool with_stop) {
  std::vector<Ghost> pairs;
  const int count = static_cast<int>(lens.surfaces.size()), stop = lens.stop_index + 1;
  for (int i = 1; i <= count; ++i)
    for (int j = i + 1; j <= count; ++j)
      if (with_stop || (i != stop && j != stop)) pairs.push_back({i, j});
  return pairs;
}

// The ghost whose polynomials a renderer reads that numbers pairs without the stop, of a fit that numbers all.
Ghost misnumbered(const LensState& lens, const Ghost& ghost) {
  const std::vector<Ghost> rendered = all_pairs(lens, false), fitted = all_pairs(lens, true);
  return fitted[static_cast<std::size_t>(std::ranges::find(rendered, ghost) - rendered.begin())];
}

std::vector<ReadOutputs> read_outputs(const LensState& lens, const std::vector<DrawnGhost>& drawn,
                                      const PictureOptions& options) {
  std::vector<ReadOutputs> read;
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    Ghost ghost = drawn[k].ghost;
    if (options.faults.next_ghost) ghost = drawn[std::min(k + 1, drawn.size() - 1)].ghost;
    if (options.faults.stop_counted) ghost = misnumbered(lens, ghost);
    read.push_back({ghost, ghost, 0, 1, ghost});
  }
  if (!options.faults.output_order) return read;
  SeededRandom random(options.seed);
  std::vector<std::size_t> order(2 * drawn.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t k = order.size(); k > 1; --k) std::swap(order[k - 1], order[random.below(k)]);
  const std::vector<ReadOutputs> right = read;
  for (std::size_t k = 0; k < read.size(); ++k) {
    read[k].x_of = right[order[2 * k] / 2].x_of, read[k].x_output = order[2 * k] % 2;
    read[k].y_of = right[order[2 * k + 1] / 2].x_of, read[k].y_output = order[2 * k + 1] % 2;
  }
  return read;
}

// The outputs of all ghosts that are read, for the picture's light; none of pairs that are no ghosts.
class FittedOutputs {
 public:
  // Sensor x and y, stop x and y, transmittance; empty: no polynomials.
  using Outputs = std::vector<LightPolynomial>;

  bool fit(const LensState& lens, const std::vector<ReadOutputs>& read, const PictureOptions& options,
           const Context& context) {
    std::vector<Ghost> ghosts;
    for (const ReadOutputs& outputs : read)
      for (const Ghost& ghost : {outputs.x_of, outputs.y_of, outputs.stop_of})
        if (outputs_.emplace(ghost, Outputs{}).second) ghosts.push_back(ghost);
    std::vector<Outputs> fitted(ghosts.size());
    const bool done = parallel_for(ghosts.size(), context, [&](std::size_t k) {
      if (has_ghost(lens, ghosts[k])) fitted[k] = fit_one(lens, ghosts[k], options);
    });
    for (std::size_t k = 0; k < ghosts.size(); ++k) outputs_[ghosts[k]] = std::move(fitted[k]);
    return done;
  }

  [[nodiscard]] const Outputs& of(const Ghost& ghost) const { return outputs_.at(ghost); }

 private:
  static Outputs fit_one(const LensState& lens, const Ghost& ghost, const PictureOptions& options) {
    const Vec2 centre = options.faults.extrapolated ? Vec2{} : options.light;
    const Vec2 light = (options.light - centre) * (1.0 / options.half_range);
    Outputs outputs;
    for (const published::Samples& samples : GhostToFit(lens, ghost, options.lambda_nm).samples(options, centre)) {
      const auto dense = published::DenseFit::fit(samples, options.degree);
      if (!dense) return {};  // too few rays take this path
      outputs.emplace_back(dense->polynomial(), light);
    }
    return outputs;
  }

  std::map<Ghost, Outputs> outputs_;
};

Vec2 point_in(const Rectangle& box, Vec2 unit) {
  return {box.low.x + unit.x * (box.high.x - box.low.x), box.low.y + unit.y * (box.high.y - box.low.y)};
}

double flux_of(const DrawnGhost& drawn, Vec2 light) { return area_of(drawn.box) / std::sqrt(1.0 + dot(light, light)); }

SplatTarget target_for(const LensState& lens, const PictureOptions& options) {
  return {options.width, options.height, {0.5 * lens.sensor_width_mm, 0.5 * lens.sensor_height_mm}};
}

Result<void> check_picture(const PictureOptions& options) {
  constexpr int kMost = 16384;
  const bool sizes = options.width > 0 && options.height > 0 && options.width <= kMost && options.height <= kMost;
  if (!sizes || options.points < 1 || options.points > kMost || options.samples < 1)
    return failure(ErrorCode::InvalidArgument, "pictures need a size and a number of points from 1 to 16384");
  if (options.degree < 1 || options.degree > published::kLargestDegree || !(options.half_range > 0.0))
    return failure(ErrorCode::InvalidArgument, "pictures need a degree of 1 to 16 and a range of lights above 0");
  return {};
}

}  // namespace
}  // namespace contrejour::inline internal::polynomial

namespace contrejour::published {

Result<Image> draw_traced_ghosts(const LensState& lens, const PictureOptions& options, const Context& context) {
  if (const auto good = polynomial::check_picture(options); !good) return tl::unexpected(good.error());
  polynomial::SplatTarget target = polynomial::target_for(lens, options);
  const polynomial::SplatPoints points{options.points, options.random_points, options.seed};
  for (const auto& drawn : polynomial::drawn_ghosts(lens, options, context)) {
    const polynomial::GhostToFit ghost(lens, drawn.ghost, options.lambda_nm);
    const auto ray = [&](Vec2 unit) -> std::optional<polynomial::SplatRay> {
      const TracedRay traced = ghost.trace_at(options.light, polynomial::point_in(drawn.box, unit));
      if (!ghost.passes(traced)) return std::nullopt;
      return polynomial::SplatRay{traced.sensor_mm, traced.transmission};
    };
    if (!polynomial::splat(target, ray, points, polynomial::flux_of(drawn, options.light), context))
      return interrupted();
  }
  return target.image();
}

Result<Image> draw_fitted_ghosts(const LensState& lens, const PictureOptions& options, const Context& context) {
  if (const auto good = polynomial::check_picture(options); !good) return tl::unexpected(good.error());
  polynomial::SplatTarget target = polynomial::target_for(lens, options);
  const polynomial::SplatPoints points{options.points, options.random_points, options.seed};
  const auto drawn = polynomial::drawn_ghosts(lens, options, context);
  const auto read = polynomial::read_outputs(lens, drawn, options);
  polynomial::FittedOutputs fitted;
  if (!fitted.fit(lens, read, options, context)) return interrupted();
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    const auto &x = fitted.of(read[k].x_of), &y = fitted.of(read[k].y_of), &stop = fitted.of(read[k].stop_of);
    if (x.empty() || y.empty() || stop.empty()) continue;
    const polynomial::GhostToFit ghost(lens, drawn[k].ghost, options.lambda_nm);
    const auto ray = [&](Vec2 unit) -> std::optional<polynomial::SplatRay> {
      const Vec2 at = ghost.normalised(polynomial::point_in(drawn[k].box, unit));
      if (!options.faults.no_stop_position && iris_distance(lens.iris, {stop[2].at(at), stop[3].at(at)}) > 0.0)
        return std::nullopt;
      return polynomial::SplatRay{{x[read[k].x_output].at(at), y[read[k].y_output].at(at)},
                                  std::max(stop[4].at(at), 0.0)};
    };
    if (!polynomial::splat(target, ray, points, polynomial::flux_of(drawn[k], options.light), context))
      return interrupted();
  }
  return target.image();
}

}  // namespace contrejour::published
