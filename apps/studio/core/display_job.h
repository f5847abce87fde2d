// SPDX-License-Identifier: Apache-2.0
// From a scene-linear picture to what the window shows: exposure, view transform, 8 bits. `Preview` is that of the
// command line's --preview. Thread-safety: as of LatestJob; displayed() is pure.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "contrejour/image.h"
#include "studio/core/compare.h"
#include "studio/core/latest_job.h"
#include "studio/core/picture_job.h"

namespace contrejour::studio {

enum class ViewTransform {
  Preview,      // sRGB with highlights rolled off
  Clipped,      // sRGB
  FalseColour,  // stops of luminance above and below mid grey
};

struct DisplayOrder {
  PictureAnswer picture;
  std::shared_ptr<const Image> snapshot = nullptr;  // the picture is compared with it; null: it is not
  CompareView compare = {};
  ViewTransform transform = ViewTransform::Preview;
  // The exposure of the last refined picture, or 0 stops where there is a plate, as of the command line's previews;
  // else `stops`.
  bool automatic = true;
  double stops = 0;
};

struct DisplayAnswer {
  PictureAnswer picture;
  int width = 0, height = 0;
  std::vector<std::uint32_t> rgba;  // bytes R, G, B, A in memory
  double stops = 0;  // the exposure shown
};

using DisplayJob = LatestJob<DisplayOrder, DisplayAnswer>;
[[nodiscard]] DisplayJob::Work display_work();

// image values times 2^stops. One row after another; as many as the image has.
[[nodiscard]] std::vector<std::uint32_t> displayed(const Image& rgb, double stops, ViewTransform transform);

}  // namespace contrejour::studio
