// SPDX-License-Identifier: Apache-2.0
#include "studio/core/frame_cache.h"

#include <cmath>
#include <utility>

#include "contrejour/expert/renderer_settings.h"
#include "contrejour/expert/requests.h"
#include "contrejour/expert/settings.h"
#include "studio/core/keys.h"
#include "studio/core/plate_frames.h"
#include "studio/core/plate_picture.h"

namespace contrejour::studio {
namespace {

constexpr DraftLevel kPlayedLevel{2, "0.02", 0};

class CacheWorker {
 public:
  explicit CacheWorker(std::shared_ptr<FrameCache> cache) : cache_(std::move(cache)) {}

  void work(const CacheOrder& order, CacheJob::Control& control) {
    cache_->begin(order.revision);
    const int count = order.last - order.first + 1;
    for (int k = 0; k < count && !control.is_outdated(); ++k) {
      const int frame = order.first + (order.now - order.first + k) % count;
      if (cache_->has(frame)) continue;
      auto shown = frame_of(order, frame, control.context());
      if (!shown || !cache_->add(order.revision, frame, std::move(shown))) return;
      control.publish(cache_->count());
    }
  }

 private:
  // Null where it was cancelled, or cannot be rendered.
  std::shared_ptr<const DisplayAnswer> frame_of(const CacheOrder& order, int frame, const Context& context) {
    const Document document = at_frame(*order.document, frame);
    auto lens = params::lens_of(*document.lens, document.values());
    if (!lens) return nullptr;
    PictureOrder picture{order.revision, document.values(), std::make_shared<const LensState>(std::move(*lens))};
    picture.plate = order.plate;
    if (is_plate_sequence(document.plate.file))
      if (auto plate = plate_of(document.plate, frame)) picture.plate = std::move(*plate);
    const params::Values values = draft_values(picture, kPlayedLevel);
    auto image = image_of(picture, values, context);
    if (!image) return nullptr;
    return std::make_shared<const DisplayAnswer>(shown(order, *image, picture));
  }

  Result<Image> image_of(const PictureOrder& order, const params::Values& values, const Context& context) {
    if (!renderer_) {
      auto created = Renderer::create();
      if (!created) return tl::unexpected(created.error());
      renderer_ = std::move(*created);
    }
    if (auto set = configure_renderer(*renderer_, values); !set) return tl::unexpected(set.error());
    if (auto set = renderer_->set_lens(*order.lens); !set) return tl::unexpected(set.error());
    const auto draw = [&](const PictureRequest& request) { return render_picture(request, *renderer_, context); };
    if (order.plate) {
      auto drawn = plates_.draft(order.plate, *order.lens, values, draw);
      if (!drawn) return tl::unexpected(drawn.error());
      return std::move(drawn->image);
    }
    const auto request = picture_request(values, *order.lens);
    if (!request) return tl::unexpected(request.error());
    auto flare = draw(*request);
    if (!flare) return tl::unexpected(flare.error());
    return std::move(flare->image);
  }

  DisplayAnswer shown(const CacheOrder& order, const Image& image, const PictureOrder& picture) {
    const bool has_plate = picture.plate != nullptr;
    DisplayAnswer answer;
    answer.picture.revision = order.revision;
    answer.picture.has_plate = has_plate;
    if (!has_plate) answer.picture.pixel_area = kPlayedLevel.divisor * kPlayedLevel.divisor;
    answer.width = image.width;
    answer.height = image.height;
    answer.stops = order.stops;
    answer.picture.space = space_of_picture(picture);
    answer.rgba = painter_
                      .codes(image, answer.picture.space, order.stops - std::log2(answer.picture.pixel_area),
                             order.transform, order.colour)
                      .rgba;
    return answer;
  }

  std::shared_ptr<FrameCache> cache_;
  std::optional<Renderer> renderer_;
  PlatePictures plates_;
  ViewPainter painter_;
};

}  // namespace

void FrameCache::begin(std::uint64_t revision) {
  const std::lock_guard lock(mutex_);
  if (revision_ == revision) return;
  revision_ = revision;
  bytes_ = 0;
  frames_.clear();
}

bool FrameCache::add(std::uint64_t revision, int frame, std::shared_ptr<const DisplayAnswer> shown) {
  const std::lock_guard lock(mutex_);
  const std::size_t bytes = shown->rgba.size() * sizeof(std::uint32_t);
  if (revision != revision_ || bytes_ + bytes > kMostBytes) return false;
  bytes_ += bytes;
  frames_[frame] = std::move(shown);
  return true;
}

std::shared_ptr<const DisplayAnswer> FrameCache::find(int frame) const {
  const std::lock_guard lock(mutex_);
  const auto found = frames_.find(frame);
  return found != frames_.end() ? found->second : nullptr;
}

std::size_t FrameCache::count() const {
  const std::lock_guard lock(mutex_);
  return frames_.size();
}

CacheJob::Work cache_work(std::shared_ptr<FrameCache> cache) {
  return [worker = std::make_shared<CacheWorker>(std::move(cache))](
             const CacheOrder& order, CacheJob::Control& control) { worker->work(order, control); };
}

}  // namespace contrejour::studio
