// SPDX-License-Identifier: Apache-2.0
#include "studio/core/figures_job.h"

#include <cmath>
#include <utility>

#include "contrejour/expert/requests.h"

namespace contrejour::studio {
namespace {

// Pictures are drawn meanwhile, and come first.
constexpr int kFiguresThreads = 1;
constexpr std::chrono::milliseconds kRestBeforeFigures{120}, kRestBeforeRanks{400};

Result<FiguresAnswer> figures_of(const FiguresOrder& order, const Context& context) {
  const auto light = light_of(order.values, *order.lens, order.light);
  if (!light) return tl::unexpected(light.error());
  const auto request = figures_request(order.values, *order.lens, &*light);
  if (!request) return tl::unexpected(request.error());
  auto figures = ghost_figures(*order.lens, *request, context);
  if (!figures) return tl::unexpected(figures.error());
  auto footprints = footprints_of(*order.lens, *figures, *light, request->frame, context);
  return FiguresAnswer{order.revision, order.light, std::move(*figures), std::move(footprints), {}, nullptr};
}

// Keeps the ranks of the lens.
class FiguresWorker {
 public:
  void work(const FiguresOrder& order, FiguresJob::Control& control) {
    if (!control.rests_for(kRestBeforeFigures)) return;
    auto figures = figures_of(order, control.context(kFiguresThreads));
    if (control.is_outdated()) return;
    if (!figures) return control.publish({order.revision, order.light, {}, {}, figures.error().to_string(), nullptr});
    figures->ranks = ranks_.find(order.values, *order.lens);
    control.publish(*figures);
    if (!figures->ranks) add_ranks(order, std::move(*figures), control);
  }

 private:
  void add_ranks(const FiguresOrder& order, FiguresAnswer figures, FiguresJob::Control& control) {
    control.goes_on_for_later();
    if (!control.rests_for(kRestBeforeRanks)) return;
    figures.ranks = ranks_.measure(order.values, *order.lens, control.context(kFiguresThreads));
    if (figures.ranks && !control.is_outdated()) control.publish(std::move(figures));
  }

  KeptRanks ranks_;
};

}  // namespace

Result<Light> light_of(const params::Values& values, const LensState& lens, std::size_t light) {
  const auto request = picture_request(values, lens);
  if (!request) return tl::unexpected(request.error());
  if (light >= request->lights.size()) return invalid_argument("the picture has no such light");
  return request->lights[light];
}

double angle_from_axis_rad(const Light& light) {
  const LightAngles angles = angles_from_direction(light.direction);
  const double angle = std::acos(std::fmin(1.0, light.direction.z / length(light.direction)));
  return angles.elevation_rad < 0 ? -angle : angle;
}

FiguresJob::Work figures_work() {
  return [worker = std::make_shared<FiguresWorker>()](const FiguresOrder& order, FiguresJob::Control& control) {
    worker->work(order, control);
  };
}

SectionJob::Work section_work() {
  return [](const SectionOrder& order, SectionJob::Control& control) {
    SectionRequest request;
    if (order.ghost) {
      request.ghosts = {*order.ghost};
      request.ghost_light_rad = order.light_rad;
    }
    control.publish({std::make_shared<const LensSection>(lens_section(*order.lens, request)), order.ghost});
  };
}

}  // namespace contrejour::studio
