// SPDX-License-Identifier: Apache-2.0
// Frames of a shot as files, written in the background: those of `contrejour render --session FILE --frames RANGE`, or
// with a plate of `apply`, bit for bit; frames that a sequence of plates has not are left out, as by `--missing skip`.
// Thread-safety: as of LatestJob; export_frame() is pure, but for its file.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/source_renderer.h"
#include "studio/core/document.h"
#include "studio/core/latest_job.h"
#include "studio/core/plate_job.h"

namespace contrejour::studio {

struct FramesOrder {
  Document document;
  std::shared_ptr<const Plate> plate;  // a still; that of a sequence is read for each frame
  std::string pattern;  // "flare.####.exr"; empty: nothing is to be written any more
  int first = 1, last = 1;
};

struct FramesAnswer {
  int done = 0, count = 0;
  std::vector<int> missing;  // of the plate's frames: these are left out
  std::string error;
  bool is_over = false;
};

using FramesJob = LatestJob<FramesOrder, FramesAnswer>;
[[nodiscard]] FramesJob::Work frames_work();

// Errors: InvalidArgument for a pattern without a place for the number, with another extension than .exr and .png (with
// a plate, those of is_plate_name), or for a frame whose plate has another size than the first one's; those of
// rendering and of writing.
[[nodiscard]] Result<void> check_pattern(const std::string& pattern, bool has_plate);
[[nodiscard]] Result<void> export_frame(const FramesOrder& order, int frame, Renderer& renderer,
                                        const Context& context);

}  // namespace contrejour::studio
