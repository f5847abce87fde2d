// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/ghost_survey.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/tasks.h"
#include "ghosts/light_frame.h"
#include "render/area_lights/frame_peak.h"

namespace contrejour::inline internal::area {
namespace {

// The squared error that lights may make by being divided too coarsely, over the frame's squared error.
constexpr double kPiecesFraction = 1.1;

double middle_wavelength(const PlannedLight& light) { return light.passes[light.passes.size() / 2].lambda_nm; }

}  // namespace

std::vector<DividedLight> whole_lights(std::span<const Light> lights) {
  std::vector<DividedLight> wholes;
  for (std::size_t k = 0; k < lights.size(); ++k) wholes.push_back({k, 1, pieces_of(lights[k]), {}});
  return wholes;
}

std::vector<Light> points_of(std::span<const DividedLight> lights) {
  std::vector<Light> points;
  for (const DividedLight& light : lights)
    for (const LightPiece& piece : light.pieces) points.push_back(piece.point);
  return points;
}

GhostSurvey::GhostSurvey(const LensState& lens, const FramePlan& plan, std::span<const Light> lights,
                         const FrameSettings& settings, const Context& context)
    : lens_(lens), plan_(plan), lights_(lights), settings_(settings), context_(context), steps_(lens, plan.tables) {}

// The factor from an irradiance, relative to the light's at the middle wavelength, to a pixel's value in the brightest
// channel.
double GhostSurvey::value_of(const PlannedLight& light, std::size_t ghost) const {
  const auto by = [&](double lambda_nm) { return plan_.reflectances.of(plan_.ghosts[ghost], lambda_nm); };
  const double middle = by(middle_wavelength(light));
  Rgb gain{};
  for (const PlannedPass& pass : light.passes) {
    const double times = middle > 0.0 ? by(pass.lambda_nm) / middle : 1.0;
    const Rgb tinted = plan_.adjustments[ghost].tinted(pass.gain);
    for (std::size_t c = 0; c < 3; ++c) gain[c] += times * tinted[c];
  }
  double largest = 0.0;
  for (const double g : gain) largest = std::max(largest, std::abs(g));
  return largest * settings_.frame.pixel_pitch_mm * settings_.frame.pixel_pitch_mm;
}

std::vector<GhostMotion> GhostSurvey::motions(std::span<const DividedLight> lights,
                                              std::span<const PieceGhostIndex> indices) const {
  std::vector<std::vector<LightWindows>> windows(lights.size());
  for (std::size_t k = 0; k < lights.size(); ++k)
    for (const PlannedLight& planned : lights[k].planned) windows[k].emplace_back(lens_, planned.source);
  std::vector<GhostMotion> motions(indices.size());
  parallel_for(indices.size(), context_, [&](std::size_t k) {
    const PieceGhostIndex& at = indices[k];
    const PlannedLight& planned = lights[at.light].planned[at.piece];
    if (planned.passes.empty()) return;
    motions[k] = ghost_motion(steps_.at(middle_wavelength(planned)), plan_.ghosts[at.ghost], planned.source,
                              windows[at.light][at.piece]);
  });
  return motions;
}

GhostBlur GhostSurvey::blur(const DividedLight& light, const PieceGhostIndex& index, const GhostMotion& motion) const {
  return blur_of(motion, light.pieces[index.piece], settings_.frame, plan_.adjustments[index.ghost].shift_mm,
                 value_of(light.planned[index.piece], index.ghost));
}

Result<std::vector<DividedLight>> GhostSurvey::cut(const std::set<Cut>& wanted) const {
  std::vector<DividedLight> divided;
  for (const auto& [light, across] : wanted) divided.push_back({light, across, pieces_of(lights_[light], across), {}});
  auto planned = plan_more_lights(plan_, lens_, points_of(divided), settings_, context_);
  if (!planned) return tl::unexpected(planned.error());
  auto next = planned->begin();
  for (DividedLight& light : divided)
    for (std::size_t k = 0; k < light.pieces.size(); ++k) {
      light.planned.push_back(std::move(*next++));
      light.planned.back().index = light.light;
    }
  return divided;
}

std::vector<GhostOfArea> GhostSurvey::uncut(const std::vector<DividedLight>& wholes) const {
  const std::size_t count = plan_.ghosts.size();
  std::vector<PieceGhostIndex> indices;
  for (std::size_t k = 0; k < wholes.size() * count; ++k) indices.push_back({k / count, 0, k % count});
  std::vector<GhostMotion> found = motions(wholes, indices);
  std::vector<GhostOfArea> ghosts(indices.size());
  for (std::size_t k = 0; k < indices.size(); ++k) {
    ghosts[k].light = indices[k].light;
    ghosts[k].ghost = indices[k].ghost;
    ghosts[k].motion = std::move(found[k]);
    ghosts[k].blur = blur(wholes[indices[k].light], indices[k], ghosts[k].motion);
  }
  return ghosts;
}

Result<void> GhostSurvey::examine_parts(std::span<GhostOfArea> ghosts, const std::vector<DividedLight>& wholes,
                                        const AreaBudget& budget) const {
  std::set<Cut> wanted;
  std::vector<GhostOfArea*> unsure;
  for (GhostOfArea& ghost : ghosts) {
    const LightPiece& whole = wholes[ghost.light].pieces.front();
    if (whole.samples.empty()) continue;
    ghost.doubt = doubt_about(ghost, whole, budget);
    if (ghost.doubt > 0.0) {
      unsure.push_back(&ghost);
      wanted.emplace(ghost.light, 2);
    } else {
      foresee_errors(ghost, whole, {}, budget);
    }
  }
  if (unsure.empty()) return {};
  const auto divided = cut(wanted);
  if (!divided) return tl::unexpected(divided.error());
  std::vector<PieceGhostIndex> indices;
  for (const GhostOfArea* ghost : unsure) {
    const auto at = std::ranges::find(*divided, ghost->light, &DividedLight::light);
    for (std::size_t p = 0; p < at->pieces.size(); ++p)
      indices.push_back({static_cast<std::size_t>(at - divided->begin()), p, ghost->ghost});
  }
  std::vector<GhostMotion> found = motions(*divided, indices);
  std::size_t next = 0;
  for (GhostOfArea* ghost : unsure) {
    const DividedLight& parts = (*divided)[indices[next].light];
    for (std::size_t p = 0; p < parts.pieces.size(); ++p, ++next) {
      ghost->part_blurs.push_back(blur(parts, indices[next], found[next]));
      ghost->part_motions.push_back(std::move(found[next]));
    }
    foresee_errors(*ghost, wholes[ghost->light].pieces.front(), parts.pieces, budget);
  }
  return {};
}

Result<std::vector<SurveyedLight>> GhostSurvey::cut_as_chosen(std::span<const GhostOfArea> ghosts,
                                                              std::vector<DividedLight> wholes) const {
  std::map<Cut, SurveyedLight> by_cut;
  std::set<Cut> finer;
  for (const GhostOfArea& ghost : ghosts) {
    const auto add = [&](int across, double part) {
      const Cut which{ghost.light, across};
      SurveyedLight& light = by_cut[which];
      light.ghosts.push_back(ghost.ghost);
      light.light_fractions.push_back(part);
      light.wholes.push_back(dimmed(ghost.blur, part));
      if (across > 1) finer.insert(which);
    };
    for (std::size_t k = 0; k < kAcross.size(); ++k)
      if (ghost.parts[k] > 0.0) add(kAcross[k], ghost.parts[k]);
  }
  auto divided = cut(finer);
  if (!divided) return tl::unexpected(divided.error());
  std::vector<PieceGhostIndex> indices;
  for (std::size_t at = 0; at < divided->size(); ++at) {
    const DividedLight& parts = (*divided)[at];
    for (std::size_t p = 0; p < parts.pieces.size(); ++p)
      for (const std::size_t ghost : by_cut.at({parts.light, parts.across}).ghosts) indices.push_back({at, p, ghost});
  }
  const std::vector<GhostMotion> found = motions(*divided, indices);
  for (std::size_t k = 0; k < indices.size(); ++k) {
    const DividedLight& parts = (*divided)[indices[k].light];
    SurveyedLight& light = by_cut.at({parts.light, parts.across});
    light.blurs.resize(parts.pieces.size());
    std::vector<GhostBlur>& blurs = light.blurs[indices[k].piece];
    blurs.push_back(dimmed(blur(parts, indices[k], found[k]), light.light_fractions[blurs.size()]));
  }
  std::vector<SurveyedLight> surveyed;
  for (auto& [which, light] : by_cut) {
    if (which.second == 1) {
      light.parts = wholes[which.first];
      light.blurs.push_back(light.wholes);
    } else {
      light.parts = std::move(
          *std::ranges::find(*divided, which, [](const DividedLight& one) { return Cut{one.light, one.across}; }));
    }
    surveyed.push_back(std::move(light));
  }
  return surveyed;
}

Result<SurveyedFrame> GhostSurvey::of(std::vector<DividedLight> wholes) const {
  std::vector<GhostOfArea> ghosts = uncut(wholes);
  if (context_.cancelled()) return interrupted();
  std::vector<GhostBlur> blurs;
  for (const GhostOfArea& ghost : ghosts) blurs.push_back(ghost.blur);
  const Frame& frame = settings_.frame;
  AreaBudget budget;
  budget.peak = peak_of(blurs, frame);
  budget.squares = kPiecesFraction * settings_.area_error * settings_.area_error * frame.width * frame.height;
  budget.spot_squares = kSpotFraction * settings_.area_error * settings_.area_error * frame.width * frame.height;
  for (const GhostBlur& blur : blurs)
    if (blur.level > 0.0) budget.flux += blur.flux;
  if (const auto looked = examine_parts(ghosts, wholes, budget); !looked) return tl::unexpected(looked.error());
  choose_pieces(ghosts, budget);
  auto lights = cut_as_chosen(ghosts, std::move(wholes));
  if (!lights) return tl::unexpected(lights.error());
  if (context_.cancelled()) return interrupted();
  return SurveyedFrame{std::move(*lights), budget.peak};
}

}  // namespace contrejour::inline internal::area
