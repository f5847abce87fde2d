// SPDX-License-Identifier: Apache-2.0
#include "studio/core/picture_job.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "contrejour/expert/parameter_text.h"
#include "contrejour/expert/renderer_settings.h"
#include "contrejour/expert/requests.h"
#include "contrejour/expert/settings.h"
#include "contrejour/renderer.h"
#include "studio/core/free_memory.h"
#include "studio/core/plate_picture.h"
#include "studio/core/still_lights.h"

namespace contrejour::studio {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kMuchSooner = 0.4;  // a draft that takes so little of its time lets the next one be finer
constexpr double kMostStillTime_ms = 100.0;
constexpr int kSmallestDraft = 64;

void replace(params::Values& values, std::string_view name, std::string text) {
  static_cast<void>(values.set(name, std::move(text)));  // within the parameter's range
}

// Renders on the job's thread, and keeps what frames have in common.
class PictureWorker {
 public:
  void work(const PictureOrder& order, PictureJob::Control& control) {
    draft(order, control);
    if (!control.rests_for(kRestBeforeRefining)) return;
    refine(order, control);
  }

 private:
  void draft(const PictureOrder& order, PictureJob::Control& control) {
    const DraftLevel& level = draft_levels()[level_];
    params::Values values = draft_values(order, level);
    const bool shifts_stars = StarLayers::are_wanted(values) && stars_.have(order.stars);
    if (shifts_stars) leave_out_stars(values);
    const Context context = control.context_until_end();
    // Lights that stand still keep their ghosts when the brightest of the others change.
    params::Values kept = values;
    replace(kept, "select", *order.values.text("select"));
    const std::string key = key_without_lights(kept);
    const auto draw_anew = [&](const PictureRequest& request) { return render_picture(request, *renderer_, context); };
    const auto draw = [&](const PictureRequest& request) {
      auto flare = still_lights_.draw(request, key, draw_anew);
      if (flare && shifts_stars) add_stars(order, level.divisor, flare->image);
      return flare;
    };
    PictureAnswer answer = rendered(order, values, context, [&] {
      return order.plate ? plates_.draft(order.plate, *order.lens, values, draw) : flare_of(order, values, draw);
    });
    answer.kind = PictureKind::Draft;
    if (!order.plate) answer.pixel_area = static_cast<double>(level.divisor * level.divisor);
    adapt(answer.time_ms - still_lights_.drawn_time_ms());
    control.publish(std::move(answer));
  }

  void refine(const PictureOrder& order, PictureJob::Control& control) {
    const Context context = control.context();
    PictureAnswer answer = rendered(order, order.values, context, [&] {
      return order.plate ? PlatePictures::refined(*order.plate, *order.lens, order.values, *renderer_, context)
                         : flare_of(order, order.values, [&](const PictureRequest& request) {
                             return render_picture(request, *renderer_, context);
                           });
    });
    answer.kind = PictureKind::Refined;
    if (control.is_outdated()) return;
    control.publish(std::move(answer));
    // For the drafts to come; without them they take longer.
    if (renderer_ && StarLayers::are_wanted(order.values))
      static_cast<void>(stars_.prepare(order.stars, order.values, *order.lens, *renderer_, context));
    if (released_after_ != lens_ && !control.is_outdated()) {
      release_free_memory();  // tables and pupils of the lens before
      released_after_ = lens_;
    }
  }

  static void leave_out_stars(params::Values& values) {
    static_cast<void>(values.set("starburst", "off"));
    static_cast<void>(values.set("glare", "0"));
  }

  void add_stars(const PictureOrder& order, int divisor, Image& draft) const {
    const auto size = params::parse_size(*order.values.text("size"));
    if (size)
      stars_.add(order.stars, {static_cast<double>(size->width), static_cast<double>(size->height)}, divisor, draft);
  }

  // draw: by the renderer, which then has the lens and the method.
  PictureAnswer rendered(const PictureOrder& order, const params::Values& values, const Context& context,
                         const std::function<Result<PlatePictures::Picture>()>& draw) {
    const auto start = Clock::now();
    PictureAnswer answer;
    answer.revision = order.revision;
    answer.has_plate = order.plate != nullptr;
    answer.space = space_of_picture(order);
    const auto ready = set_renderer(order, values);
    auto picture = ready ? draw() : Result<PlatePictures::Picture>(tl::unexpected(ready.error()));
    if (picture) {
      answer.ghosts = picture->ghosts;
      answer.image = std::make_shared<const Image>(std::move(picture->image));
    } else if (!context.cancelled()) {
      answer.error = picture.error().to_string();
    }
    answer.time_ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    return answer;
  }

  Result<void> set_renderer(const PictureOrder& order, const params::Values& values) {
    if (!renderer_) {
      auto created = Renderer::create();
      if (!created) return tl::unexpected(created.error());
      renderer_ = std::move(*created);
    }
    if (auto set = configure_renderer(*renderer_, values); !set) return set;
    if (lens_ == order.lens) return {};
    still_lights_.forget();
    if (auto set = renderer_->set_lens(*order.lens); !set) return set;
    lens_ = order.lens;
    return {};
  }

  static Result<PlatePictures::Picture> flare_of(const PictureOrder& order, const params::Values& values,
                                                 const DrawFlare& draw) {
    const auto request = picture_request(values, *order.lens);
    if (!request) return tl::unexpected(request.error());
    auto flare = draw(*request);
    if (!flare) return tl::unexpected(flare.error());
    return PlatePictures::Picture{std::move(flare->image), flare->statistics.ghosts_rendered};
  }

  // Late drafts raise the level at once; several early ones lower it, so that it does not alternate. Another level has
  // the lights that stand still drawn anew, for which the hand that drags a light would have to wait.
  void adapt(double time_ms) {
    if (time_ms > kDraftTime_ms) {
      level_ = std::min(level_ + 1, draft_levels().size() - 1);
      early_ = 0;
    } else if (time_ms > kMuchSooner * kDraftTime_ms || ++early_ < 8) {
      if (time_ms > kMuchSooner * kDraftTime_ms) early_ = 0;
    } else if (still_lights_.kept_time_ms() < kMostStillTime_ms) {
      level_ -= level_ > 0 ? 1 : 0;
      early_ = 0;
    }
  }

  std::optional<Renderer> renderer_;
  std::shared_ptr<const LensState> lens_, released_after_;
  StarLayers stars_;
  StillLights still_lights_;
  PlatePictures plates_;
  std::size_t level_ = 1;
  int early_ = 0;
};

std::string smaller_size(const std::string& text, int divisor) {
  const auto size = params::parse_size(text);
  if (!size) return text;
  return fmt::format("{}x{}", std::max(size->width / divisor, std::min(size->width, kSmallestDraft)),
                     std::max(size->height / divisor, std::min(size->height, kSmallestDraft)));
}

std::string selection_of(const std::vector<Ghost>& ghosts, std::size_t count) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < std::min(count, ghosts.size()); ++k) names.push_back(ghost_name(ghosts[k]));
  return fmt::format("list:{}", fmt::join(names, ","));
}

}  // namespace

const std::vector<DraftLevel>& draft_levels() {
  static const std::vector<DraftLevel> levels = {{1, "0.01", 0},  {2, "0.02", 0},  {2, "0.03", 60},
                                                 {3, "0.05", 30}, {4, "0.08", 16}, {4, "0.1", 8}};
  return levels;
}

params::Values draft_values(const PictureOrder& order, const DraftLevel& level) {
  params::Values values = order.values;
  if (order.plate) {
    const Image& rgb = order.plate->picture.rgb;
    replace(values, "size", fmt::format("{}x{}", rgb.width, rgb.height));
    replace(values, "pixel-aspect", fmt::format("{:.6g}", pixel_aspect_of(order.plate->picture)));
  }
  replace(values, "method", "adaptive");
  replace(values, "error", level.error);
  replace(values, "size", smaller_size(*values.text("size"), level.divisor));
  replace(values, "ringing", "none");
  replace(values, "wavelengths", "3");
  replace(values, "reflections", "2");
  replace(values, "device", "cpu");
  const bool is_whole = values.text("select") == "all";
  if (level.ghosts > 0 && is_whole && order.brightest.size() > level.ghosts)
    replace(values, "select", selection_of(order.brightest, level.ghosts));
  return values;
}

ColourSpace space_of_picture(const PictureOrder& order) {
  const auto of_plate = order.plate ? colour_space_of(order.plate->picture) : std::nullopt;
  return params::colour_space(order.values, of_plate.value_or(ColourSpace::Rec709));
}

PictureJob::Work picture_work() {
  return [worker = std::make_shared<PictureWorker>()](const PictureOrder& order, PictureJob::Control& control) {
    worker->work(order, control);
  };
}

}  // namespace contrejour::studio
