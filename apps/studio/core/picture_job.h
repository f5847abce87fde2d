// SPDX-License-Identifier: Apache-2.0
// Pictures of the flare for the viewport: for each request first a draft, and after 150 ms of rest the picture itself,
// which is that of `contrejour render`, bit for bit, or with a plate that of `contrejour apply`. The next request stops
// the picture, but never a draft: a light that is dragged would else have none. Drafts are coarser (size, error) the
// longer they take, so that they keep up; of many lights they draw those anew that move (still_lights.h).
// Thread-safety: as of LatestJob.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "contrejour/expert/ghost_id.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/expert/plate.h"
#include "contrejour/image.h"
#include "contrejour/lens.h"
#include "studio/core/latest_job.h"
#include "studio/core/star_layers.h"

namespace contrejour::studio {

inline constexpr std::chrono::milliseconds kRestBeforeRefining{150};

struct PictureOrder {
  std::uint64_t revision = 0;
  params::Values values;
  std::shared_ptr<const LensState> lens;
  std::vector<StarLight> stars = {};  // of all lights, in their order; empty: drafts render starbursts themselves
  std::shared_ptr<const Plate> plate = nullptr;  // the flare is added to it; null: to black
  std::vector<Ghost> brightest = {};  // brightest first: drafts that are late draw the first of these only
};

enum class PictureKind { Draft, Refined };

struct PictureAnswer {
  std::uint64_t revision = 0;
  PictureKind kind = PictureKind::Draft;
  std::shared_ptr<const Image> image;  // null where there is an error
  bool has_plate = false;
  ColourSpace space = ColourSpace::Rec709;
  double pixel_area = 1.0;  // of the whole picture's, in which a pixel's value is that much less
  double time_ms = 0;
  int ghosts = 0;
  std::string error;
};

// How coarse a draft is. Levels rise until drafts take no longer than kDraftTime_ms.
struct DraftLevel {
  int divisor = 1;  // of width and height
  const char* error = "0.01";
  std::size_t ghosts = 0;  // the brightest that are drawn; 0: all
};
inline constexpr double kDraftTime_ms = 33.0;
[[nodiscard]] const std::vector<DraftLevel>& draft_levels();

// The values that a draft of this level is rendered with.
[[nodiscard]] params::Values draft_values(const PictureOrder& request, const DraftLevel& level);

// The space of the picture that an order asks for.
[[nodiscard]] ColourSpace space_of_picture(const PictureOrder& order);

using PictureJob = LatestJob<PictureOrder, PictureAnswer>;
[[nodiscard]] PictureJob::Work picture_work();

}  // namespace contrejour::studio
