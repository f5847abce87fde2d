// SPDX-License-Identifier: Apache-2.0
// From a scene-linear picture to what the window shows: exposure, view transform, 8 bits. Thread-safety: as of
// LatestJob.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "contrejour/image.h"
#include "studio/core/compare.h"
#include "studio/core/latest_job.h"
#include "studio/core/picture_job.h"
#include "studio/core/view_codes.h"

namespace contrejour::studio {

struct DisplayOrder {
  PictureAnswer picture;
  std::shared_ptr<const Image> snapshot = nullptr;  // the picture is compared with it; null: it is not
  CompareView compare = {};
  ViewTransform transform = ViewTransform::Preview;
  ColourViewName colour = {};  // of ViewTransform::Colour
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
  std::string error;  // why the view cannot be shown: it is a preview then
};

using DisplayJob = LatestJob<DisplayOrder, DisplayAnswer>;
[[nodiscard]] DisplayJob::Work display_work();

}  // namespace contrejour::studio
