// SPDX-License-Identifier: Apache-2.0
// Snapshots of the picture with the document that made it, and how the picture at hand differs from one of them.
// Thread-safety: plain values, pure functions; the job as LatestJob.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contrejour/expert/metrics.h"
#include "contrejour/image.h"
#include "studio/core/document.h"
#include "studio/core/latest_job.h"
#include "studio/core/thumbnail.h"

namespace contrejour::studio {

struct Snapshot {
  std::string name;
  std::shared_ptr<const Document> document;
  std::shared_ptr<const Image> image;  // the refined picture
  std::shared_ptr<const Thumbnail> thumbnail;  // as it was shown; never null
};

enum class CompareMode {
  Off,
  Wipe,  // the snapshot to the left of the edge, the picture to its right
  Difference,  // the absolute difference, times a gain
};

struct CompareView {
  CompareMode mode = CompareMode::Off;
  std::size_t snapshot = 0;
  double edge = 0.5;  // of a wipe, in parts of the width
  double gain_stops = 3;  // of a difference
  friend bool operator==(const CompareView&, const CompareView&) = default;
};

// A picture whose pixels are sums over areas of `pixel_area` pixels, as it is to be shown beside a snapshot; pixels are
// then means. A snapshot of another size is shown in the picture's pixels.
[[nodiscard]] Image compared_image(const Image& picture, double pixel_area, const Image& snapshot,
                                   const CompareView& view);

struct CompareOrder {
  std::shared_ptr<const Image> snapshot, picture;
};

struct CompareAnswer {
  std::optional<Comparison> figures;  // none: pictures of different sizes
};

using CompareJob = LatestJob<CompareOrder, CompareAnswer>;
[[nodiscard]] CompareJob::Work compare_work();

}  // namespace contrejour::studio
