// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/blurred_images.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <map>
#include <utility>

namespace contrejour::inline internal::area {
namespace {

constexpr double kLevelFraction = 0.1;    // of the frame's squared error: for coarse pixels,
constexpr double kMisfitFraction = 0.25;  // and for ghosts that are drawn with another ghost's blur
constexpr double kFirstFraction = 0.02;   // of that: error of a ghost that saves an image, in the first choice tried

// Ghosts that may be drawn together: those of an undivided light, or those of all pieces of all divided lights.
struct Job {
  std::shared_ptr<const LightPiece> piece;
  std::vector<const PlannedLight*> planned;  // one a pair
  std::vector<std::size_t> ghost;            // one a pair
  std::vector<PieceGhost> pairs;
  bool is_point = false;
};

PlannedLight dimmed(PlannedLight light, double factor) {
  for (PlannedPass& pass : light.passes)
    for (double& gain : pass.gain) gain *= factor;
  return light;
}

class Jobs {
 public:
  // squares: the frame's squared error.
  Jobs(const SurveyedFrame& frame, double squares) : peak_(frame.peak), spot_squares_(kSpotFraction * squares) {
    std::vector<BlurredGhost> wholes;
    for (const SurveyedLight& light : frame.lights)
      for (const GhostBlur& whole : light.wholes) wholes.push_back(whole.over(frame.peak));
    const std::vector<int> levels = levels_of(wholes, kLevelFraction * squares);
    soft_.piece = std::make_shared<const LightPiece>(soft_piece());
    std::size_t next = 0;
    for (const SurveyedLight& light : frame.lights) {
      add(light, {levels.data() + next, light.wholes.size()});
      next += light.wholes.size();
    }
    if (!soft_.pairs.empty()) all.push_back(std::move(soft_));
  }

  std::vector<Job> all;

  // The ghost of the whole light that pieces with this index make.
  [[nodiscard]] const GhostBlur& spot(std::size_t index) const { return *spots_[index]; }

 private:
  void add(const SurveyedLight& light, std::span<const int> levels) {
    const bool is_whole = light.parts.across == 1;
    Job own;
    Job& job = is_whole ? own : soft_;
    if (is_whole) job.piece = std::make_shared<const LightPiece>(light.parts.pieces.front());
    job.is_point = job.piece->samples.empty();
    std::vector<int> fine;
    std::vector<double> overlapping;
    for (std::size_t g = 0; g < levels.size(); ++g) {
      fine.push_back(spot_level(light.wholes[g].over(peak_), levels[g], spot_squares_));
      double all_px = 0.0;
      for (const std::vector<GhostBlur>& blurs : light.blurs) all_px += blurs[g].area_px;
      overlapping.push_back(std::clamp(all_px / light.wholes[g].area_px, 1.0, static_cast<double>(light.blurs.size())));
    }
    for (std::size_t p = 0; p < light.parts.pieces.size(); ++p) {
      for (std::size_t g = 0; g < light.ghosts.size(); ++g) {
        const GhostBlur* blur = &light.blurs[p][g];
        if (!is_whole) blur = &softened_.emplace_back(softened(*blur, light.parts.pieces[p]));
        job.planned.push_back(planned(light.parts.planned[p], light.light_fractions[g]));
        job.ghost.push_back(light.ghosts[g]);
        job.pairs.push_back({blur, fine[g], spots_.size() + g, overlapping[g]});
      }
    }
    for (const GhostBlur& whole : light.wholes) spots_.push_back(&whole);
    if (is_whole) all.push_back(std::move(own));
  }

  // The light of a ghost of which only a part is made with this division.
  const PlannedLight* planned(const PlannedLight& light, double part) {
    if (part == 1.0) return &light;
    return &dimmed_.emplace_back(dimmed(light, part));
  }

  double peak_, spot_squares_;
  std::vector<const GhostBlur*> spots_;  // all ghosts of whole lights
  Job soft_;
  std::deque<GhostBlur> softened_;
  std::deque<PlannedLight> dimmed_;
};

// Chooses clusters for all jobs by the error that an image may save: the larger that is, the fewer images there are.
// Only errors of a geometric series are tried. Between the coarsest choice that makes no more than the error aimed at
// and the next one, all ghosts fade as the errors change; with one of them alone, ghosts would change their images
// together, from one frame to the next.
class ClusterChoice {
 public:
  ClusterChoice(const std::vector<Job>& jobs, const Frame& frame, double peak, double allowed_squares)
      : jobs_(jobs), frame_(frame), peak_(peak), allowed_(allowed_squares) {}

  [[nodiscard]] std::vector<BlurClusters> clusters() {
    const double aim = kAim * allowed_;
    int step = 0;
    while (step < kMaxSteps && squares(step + 1) <= aim) ++step;
    while (step > -kMaxSteps && squares(step) > aim) --step;
    const double below = squares(step), above = squares(step + 1);
    const double part = above > below ? std::clamp((aim - below) / (above - below), 0.0, 1.0) : 0.0;
    std::vector<BlurClusters> means;
    for (std::size_t k = 0; k < jobs_.size(); ++k)
      means.push_back(mean_of(tried_.at(step)[k], tried_.at(step + 1)[k], part));
    return means;
  }

 private:
  static constexpr int kMaxSteps = 16;
  static constexpr double kAim = 0.6, kRatio = 1.5;

  double squares(int step) {
    auto [at, is_new] = tried_.try_emplace(step);
    const double each = kFirstFraction * allowed_ * std::pow(kRatio, step);
    double sum = 0.0;
    for (std::size_t k = 0; k < jobs_.size(); ++k) {
      if (is_new)
        at->second.push_back(jobs_[k].is_point ? BlurClusters{}
                                               : blur_clusters(jobs_[k].pairs, *jobs_[k].piece, frame_, peak_, each));
      sum += at->second[k].squares;
    }
    return sum;
  }

  const std::vector<Job>& jobs_;
  const Frame& frame_;
  double peak_, allowed_;
  std::map<int, std::vector<BlurClusters>> tried_;  // by the step of the series
};

// Counts the ghosts that an image draws.
struct Tally {
  double ghosts = 0.0;
  double independent = 0.0;  // each counts less if it overlaps others like it

  void add(const PieceGhost& one, double part) {
    if (!(one.blur->level > 0.0)) return;
    ghosts += part;
    independent += part / one.overlapping;
  }
};

// Divides the frame's squared error among the images. Each may make the part of the ghosts that it draws, since
// `adaptive` allows every ghost the same error, with a constant for frames of few ghosts. Pieces of one light are drawn
// with the same errors at nearly the same places, so that m ghosts that overlap make m times the sum of their squares.
// Blurring removes most of the errors: with kBlurred times the squares, a disc differs from the same pieces drawn by
// `bundle` by 53 dB and more, and with 10 times by 49.
void divide_error(std::span<BlurredImage> images, std::span<const Tally> tallies) {
  constexpr double kFew = 16.0, kBlurred = 5.0;
  double all = kFew;
  for (const Tally& tally : tallies) all += tally.ghosts;
  for (std::size_t k = 0; k < images.size(); ++k) {
    const Tally& tally = tallies[k];
    if (!(tally.ghosts > 0.0)) continue;
    const double part = (kFew + tally.ghosts) / all * tally.independent / tally.ghosts;
    images[k].error_fraction = std::min(images[k].piece ? kBlurred * part : part, 1.0);
  }
}

// Adds a part of a pair to an image. A light that successive pairs share is listed once.
void add_pair(BlurredImage& image, const Job& job, std::size_t k, double part, const PlannedLight*& last) {
  if (part < 1.0) {
    image.lights.push_back(dimmed(*job.planned[k], part));
    last = nullptr;
  } else {
    if (job.planned[k] != last) image.lights.push_back(*job.planned[k]);
    last = job.planned[k];
  }
  image.pairs.push_back({job.ghost[k], image.lights.size() - 1});
}

FineWindow window_of(const GhostBlur& spot, const Frame& frame, int level) {
  return window_around(spot.at_px, spot.size_px.y + spot.blur_px.y, frame, level);
}

}  // namespace

std::vector<BlurredImage> blurred_images(const SurveyedFrame& frame, const FrameSettings& settings) {
  const double squares = settings.area_error * settings.area_error * settings.frame.width * settings.frame.height;
  const Jobs jobs(frame, squares);
  const std::vector<BlurClusters> clusters =
      ClusterChoice(jobs.all, settings.frame, frame.peak, kMisfitFraction * squares).clusters();
  std::vector<BlurredImage> images;
  std::vector<Tally> tallies;
  BlurredImage sharp;
  Tally of_sharp;
  for (std::size_t j = 0; j < jobs.all.size(); ++j) {
    const Job& job = jobs.all[j];
    const PlannedLight* last = nullptr;
    for (std::size_t k = 0; job.is_point && k < job.pairs.size(); ++k) {
      add_pair(sharp, job, k, 1.0, last);
      of_sharp.add(job.pairs[k], 1.0);
    }
    for (const BlurCluster& made : clusters[j].clusters) {
      BlurredImage own{{}, {}, job.piece, made.level, made.px_from_tangents, {}};
      Tally of_own;
      BlurredImage& image = made.is_sharp ? sharp : own;
      Tally& tally = made.is_sharp ? of_sharp : of_own;
      if (made.level < 0)
        own.window = window_of(jobs.spot(job.pairs[made.ghosts.front()].spot), settings.frame, made.level);
      last = nullptr;
      for (std::size_t m = 0; m < made.ghosts.size(); ++m) {
        add_pair(image, job, made.ghosts[m], made.light_fractions[m], last);
        tally.add(job.pairs[made.ghosts[m]], made.light_fractions[m]);
      }
      if (made.is_sharp) continue;
      images.push_back(std::move(own));
      tallies.push_back(of_own);
    }
  }
  if (!sharp.pairs.empty()) {
    images.push_back(std::move(sharp));
    tallies.push_back(of_sharp);
  }
  divide_error(images, tallies);
  const auto rank = [](const BlurredImage& d) { return d.piece == nullptr ? 1 : 2 * d.level; };
  std::stable_sort(images.begin(), images.end(),
                   [&](const BlurredImage& a, const BlurredImage& b) { return rank(a) > rank(b); });
  return images;
}

}  // namespace contrejour::inline internal::area
