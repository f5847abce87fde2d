// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/exposure.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "base/tasks.h"
#include "contrejour/expert/metrics.h"
#include "requests/layered_mean.h"

namespace contrejour {
namespace {

// The RMS error of a mean of two flares as a fraction of their RMS difference, for a shape that moves by more than its
// width: the copies stand apart. For an edge, whose true mean is a straight rise, it is less, 1 / sqrt(12).
constexpr double kErrorOfTwo = 0.5;
// The ratio of successive differences: 1 / 4 where all is smooth, 1 / 2 for edges, 1 / sqrt(2) for copies that stand
// apart, which is assumed before there are two differences.
constexpr double kLeastRatio = 0.25, kFirstRatio = 0.7071, kLargestRatio = 0.9;

// The RMS difference of two images over the peak of the second; 0 where they are equal.
Result<double> difference(const Image& a, const Image& b) {
  const auto comparison = compare(b, a);
  if (!comparison) return tl::unexpected(comparison.error());
  return comparison->psnr_db ? std::pow(10.0, -*comparison->psnr_db / 20.0) : 0.0;
}

Image scaled(Image image, double factor) {
  for (float& sample : image.pixels) sample *= static_cast<float>(factor);
  return image;
}

class Exposure {
 public:
  Exposure(const DrawAtTimes& draw, const ExposureOptions& options, const Context& context)
      : draw_(draw), options_(options), context_(context), progress_(context.progress) {
    context_.progress = {};
  }

  Result<ExposedFlare> run() {
    if (options_.lights_move) {
      auto swept = with_lights_on_their_way();
      if (!swept) return tl::unexpected(swept.error());
      if (*swept) return finished(std::move(**swept));
    }
    return finished(over_time());
  }

 private:
  using Found = Result<std::optional<LayeredFlare>>;

  Result<LayeredFlare> draw(const ExposureTimes& times) {
    auto flare = draw_(times, context_);
    if (!flare) return flare;
    if (context_.cancelled()) return interrupted();
    ++drawn_;
    add_statistics(statistics_, flare->statistics);
    report_progress();
    return flare;
  }

  // How often the flare will be drawn is estimated from the error so far, which falls at least as edges let it, with
  // the number of intervals.
  void report_progress() {
    constexpr double kAtLeast = 3.0;
    if (!progress_) return;
    const double expected = std::clamp(error_at_ * error_ / options_.error, kAtLeast, options_.max_intervals + 1.0);
    done_ = std::max(done_, std::min(1.0, drawn_ / std::max(expected, drawn_ + 1.0)));
    progress_(done_);
  }

  // The lights on the whole of their way, drawn at once, if the change of the parameters meanwhile does not show.
  Found with_lights_on_their_way() {
    const auto first = draw({.parameters = 0.0});
    if (!first) return tl::unexpected(first.error());
    const auto last = draw({.parameters = options_.may_turn_back ? 0.5 : 1.0});
    if (!last) return tl::unexpected(last.error());
    const auto change = difference(first->image, last->image);
    if (!change) return tl::unexpected(change.error());
    error_ = kErrorOfTwo * *change;
    if (error_ > options_.error) return std::nullopt;
    auto swept = draw({0.5, 0.0, 1.0});
    if (!swept) return tl::unexpected(swept.error());
    return std::move(*swept);
  }

  // The trapezoidal rule, whose times are among those of twice as many intervals.
  Result<LayeredFlare> over_time() {
    auto sum = ends();
    if (!sum) return sum;
    int intervals = 1;
    double before = 0.0;
    bool is_done = error_ <= options_.error && !options_.may_turn_back;
    for (; !is_done && intervals < options_.max_intervals; intervals *= 2) {
      const auto change = add_middles(*sum, intervals);
      if (!change) return tl::unexpected(change.error());
      error_ = error_after(*change, std::exchange(before, *change));
      error_at_ = drawn_;
      is_done = error_ <= options_.error;
    }
    scale(*sum, 1.0 / intervals);
    return sum;
  }

  // Half of the flare at the opening and at the closing, and the error of this as the mean.
  Result<LayeredFlare> ends() {
    auto first = draw({0.0, 0.0, 0.0});
    if (!first) return first;
    auto last = draw({1.0, 1.0, 1.0});
    if (!last) return last;
    LayeredFlare sum;
    add_weighted(sum, *first, 0.5);
    add_weighted(sum, *last, 0.5);
    const auto change = difference(first->image, last->image);
    if (!change) return tl::unexpected(change.error());
    error_ = kErrorOfTwo * *change;
    error_at_ = drawn_;
    return sum;
  }

  // Adds the middles of all intervals. Returns by how much the mean changes.
  Result<double> add_middles(LayeredFlare& sum, int intervals) {
    const Image coarse = scaled(sum.image, 1.0 / intervals);
    for (int k = 0; k < intervals; ++k) {
      const double time = (k + 0.5) / intervals;
      const auto flare = draw({time, time, time});
      if (!flare) return tl::unexpected(flare.error());
      add_weighted(sum, *flare, 1.0);
    }
    return difference(coarse, scaled(sum.image, 0.5 / intervals));
  }

  // Successive differences fall by a ratio r, and have little in common with each other, so that the squares of those
  // to come add up: r^2 + r^4 + ... = r^2 / (1 - r^2).
  static double error_after(double change, double change_before) {
    const double ratio =
        change_before > 0.0 ? std::clamp(change / change_before, kLeastRatio, kLargestRatio) : kFirstRatio;
    return change * ratio / std::sqrt(1.0 - ratio * ratio);
  }

  Result<ExposedFlare> finished(Result<LayeredFlare> flare) {
    if (!flare) return tl::unexpected(flare.error());
    if (progress_) progress_(1.0);
    flare->statistics = statistics_;
    return ExposedFlare{std::move(*flare), drawn_, error_};
  }

  const DrawAtTimes& draw_;
  const ExposureOptions& options_;
  Context context_;
  RenderStatistics statistics_;
  int drawn_ = 0;
  double error_ = 0.0, error_at_ = 0.0;  // the estimate, and how often the flare was drawn for it
  std::function<void(double)> progress_;
  double done_ = 0.0;
};

}  // namespace

Result<ExposedFlare> expose(const DrawAtTimes& draw, const ExposureOptions& options, const Context& context) {
  return Exposure(draw, options, context).run();
}

}  // namespace contrejour
