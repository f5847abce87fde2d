// SPDX-License-Identifier: Apache-2.0
// Frames of a shot as they are shown, rendered in the background at the quality of a draft, so that a shot plays.
// Thread-safety: find(), count() and clear() from any thread; the job as LatestJob.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "studio/core/display_job.h"
#include "studio/core/document.h"
#include "studio/core/latest_job.h"
#include "studio/core/plate_job.h"

namespace contrejour::studio {

class FrameCache {
 public:
  // Frames of other documents are forgotten.
  void begin(std::uint64_t revision);
  // Nothing is kept beyond the limit; false then.
  bool add(std::uint64_t revision, int frame, std::shared_ptr<const DisplayAnswer> shown);
  [[nodiscard]] std::shared_ptr<const DisplayAnswer> find(int frame) const;
  [[nodiscard]] bool has(int frame) const { return find(frame) != nullptr; }
  [[nodiscard]] std::size_t count() const;

 private:
  static constexpr std::size_t kMostBytes = std::size_t{256} << 20U;

  mutable std::mutex mutex_;
  std::uint64_t revision_ = 0;
  std::size_t bytes_ = 0;
  std::map<int, std::shared_ptr<const DisplayAnswer>> frames_;
};

struct CacheOrder {
  std::uint64_t revision = 0;
  std::shared_ptr<const Document> document;
  std::shared_ptr<const Plate> plate;  // a still; that of a sequence is read for each frame
  int first = 1, last = 0;  // none: nothing is rendered any more
  int now = 1;  // the frames from here on come first
  double stops = 0;
  ViewTransform transform = ViewTransform::Preview;
  ColourViewName colour = {};
};

// Published after each frame: how many are there.
using CacheJob = LatestJob<CacheOrder, std::size_t>;
[[nodiscard]] CacheJob::Work cache_work(std::shared_ptr<FrameCache> cache);

}  // namespace contrejour::studio
