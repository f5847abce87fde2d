// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/drawings.h"

#include <algorithm>
#include <cstddef>
#include <deque>
#include <utility>

namespace contrejour::inline internal::area {
namespace {

constexpr double kLevelShare = 0.1;    // of the frame's squared error: for coarse pixels,
constexpr double kMisfitShare = 0.5;   // and for ghosts that are drawn with another ghost's blur
constexpr double kFirstShare = 0.02;   // of that: error of a ghost that saves an image, in the first trial
constexpr int kTrials = 4;

// Ghosts that may be drawn together: those of an undivided light, or those of all pieces of all divided lights.
struct Job {
  std::shared_ptr<const LightPiece> piece;
  std::vector<const PlannedLight*> planned;  // one a pair
  std::vector<std::size_t> ghost;            // one a pair
  std::vector<PieceGhost> pairs;
  bool is_point = false;
};

class Jobs {
 public:
  explicit Jobs(const SurveyedFrame& frame, double allowed_squares) {
    std::vector<BlurredGhost> wholes;
    for (const SurveyedLight& light : frame.lights)
      for (const GhostBlur& whole : light.wholes) wholes.push_back(whole.over(frame.peak));
    const std::vector<int> levels = levels_of(wholes, allowed_squares);
    soft_.piece = std::make_shared<const LightPiece>(soft_piece());
    std::size_t next = 0;
    for (const SurveyedLight& light : frame.lights) {
      add(light, {levels.data() + next, light.wholes.size()});
      next += light.wholes.size();
    }
    if (!soft_.pairs.empty()) all.push_back(std::move(soft_));
  }

  std::vector<Job> all;

 private:
  void add(const SurveyedLight& light, std::span<const int> levels) {
    const bool is_whole = light.parts.across == 1;
    Job own;
    Job& job = is_whole ? own : soft_;
    if (is_whole) job.piece = std::make_shared<const LightPiece>(light.parts.pieces.front());
    job.is_point = job.piece->samples.empty();
    for (std::size_t p = 0; p < light.parts.pieces.size(); ++p) {
      for (std::size_t g = 0; g < light.ghosts.size(); ++g) {
        const GhostBlur* blur = &light.blurs[p][g];
        if (!is_whole) blur = &softened_.emplace_back(softened(*blur, light.parts.pieces[p]));
        job.planned.push_back(&light.parts.planned[p]);
        job.ghost.push_back(light.ghosts[g]);
        job.pairs.push_back({blur, levels[g]});
      }
    }
    if (is_whole) all.push_back(std::move(own));
  }

  Job soft_;
  std::deque<GhostBlur> softened_;
};

// Finds as few images as the allowed error permits, by raising or lowering the error that an image may save.
std::vector<BlurClasses> classes_of(const std::vector<Job>& jobs, const Frame& frame, double peak,
                                    double allowed_squares) {
  std::vector<BlurClasses> all;
  double each = kFirstShare * allowed_squares;
  for (int trial = 1;; ++trial) {
    all.clear();
    double squares = 0.0;
    for (const Job& job : jobs) {
      all.push_back(job.is_point ? BlurClasses{} : blur_classes(job.pairs, *job.piece, frame, peak, each));
      squares += all.back().squares;
    }
    const bool is_allowed = squares <= allowed_squares;
    if (is_allowed && (trial >= kTrials || squares > 0.3 * allowed_squares)) return all;
    if (trial >= 2 * kTrials) return all;
    each *= is_allowed ? 3.0 : 0.3;
  }
}

// Adds a pair to a drawing. A light that successive pairs share is listed once.
void add_pair(Drawing& drawing, const Job& job, std::size_t k, const PlannedLight*& last) {
  if (job.planned[k] != last) drawing.lights.push_back(*job.planned[k]);
  last = job.planned[k];
  drawing.pairs.push_back({job.ghost[k], drawing.lights.size() - 1});
}

}  // namespace

std::vector<Drawing> drawings_of(const SurveyedFrame& frame, const FrameSettings& settings) {
  const double squares = settings.area_error * settings.area_error * settings.frame.width * settings.frame.height;
  const Jobs jobs(frame, kLevelShare * squares);
  const std::vector<BlurClasses> classes = classes_of(jobs.all, settings.frame, frame.peak, kMisfitShare * squares);
  std::vector<Drawing> drawings;
  Drawing sharp;
  for (std::size_t j = 0; j < jobs.all.size(); ++j) {
    const Job& job = jobs.all[j];
    const PlannedLight* last = nullptr;
    for (std::size_t k = 0; job.is_point && k < job.pairs.size(); ++k) add_pair(sharp, job, k, last);
    for (const BlurClass& made : classes[j].classes) {
      Drawing drawing{{}, {}, job.piece, made.level, made.px_from_tangents};
      last = nullptr;
      for (const std::size_t k : made.ghosts) add_pair(made.is_sharp ? sharp : drawing, job, k, last);
      if (!made.is_sharp) drawings.push_back(std::move(drawing));
    }
  }
  if (!sharp.pairs.empty()) drawings.push_back(std::move(sharp));
  const auto rank = [](const Drawing& d) { return d.piece == nullptr ? 1 : 2 * d.level; };
  std::stable_sort(drawings.begin(), drawings.end(),
                   [&](const Drawing& a, const Drawing& b) { return rank(a) > rank(b); });
  return drawings;
}

}  // namespace contrejour::inline internal::area
