// SPDX-License-Identifier: Apache-2.0
#include "studio/core/display_job.h"

#include <cmath>
#include <utility>

#include "contrejour/expert/preview_exposure.h"

namespace contrejour::studio {
namespace {

class DisplayWorker {
 public:
  DisplayAnswer shown(const DisplayOrder& order) {
    DisplayAnswer answer;
    answer.picture = order.picture;
    if (!order.picture.image) return answer;
    const Image& image = *order.picture.image;
    if (order.picture.kind == PictureKind::Refined || order.picture.has_plate || !has_exposure_) update_exposure(order);
    answer.stops = order.automatic ? automatic_stops_ : order.stops;
    answer.width = image.width;
    answer.height = image.height;
    auto codes = order.snapshot && order.compare.mode != CompareMode::Off
                     ? painter_.codes(compared_image(image, order.picture.pixel_area, *order.snapshot, order.compare),
                                      order.picture.space, answer.stops, order.transform, order.colour)
                     : painter_.codes(image, order.picture.space, answer.stops - std::log2(order.picture.pixel_area),
                                      order.transform, order.colour);
    answer.rgba = std::move(codes.rgba);
    answer.error = std::move(codes.error);
    return answer;
  }

 private:
  // Drafts keep the exposure of the last picture, so that it does not flicker while a light is dragged.
  void update_exposure(const DisplayOrder& order) {
    automatic_stops_ = order.picture.has_plate
                           ? 0.0
                           : params::automatic_exposure(*order.picture.image) + std::log2(order.picture.pixel_area);
    has_exposure_ = true;
  }

  ViewPainter painter_;
  bool has_exposure_ = false;
  double automatic_stops_ = 0;
};

}  // namespace

DisplayJob::Work display_work() {
  return [worker = std::make_shared<DisplayWorker>()](const DisplayOrder& order, DisplayJob::Control& control) {
    control.publish(worker->shown(order));
  };
}

}  // namespace contrejour::studio
