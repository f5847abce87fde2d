// SPDX-License-Identifier: Apache-2.0
// Draws an AdaptiveJob in one submission: the device finds pupils, distributes the error, and decides how many rays and
// polygons there are; the host learns only whether the buffers sufficed. Failures are exceptions, as DeviceContext's.
// Thread-safety: one thread at a time.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "vulkan/adaptive_layout.h"
#include "vulkan/counters.h"
#include "vulkan/device_context.h"
#include "vulkan/layout.h"
#include "vulkan/starburst_stage.h"
#include "vulkan/stop_tables.h"
#include "vulkan/tile_lists.h"

namespace contrejour::inline internal::vulkan {

// Sizes of buffers that grow to the largest frame; smaller ones cost another try.
struct AdaptiveCapacity {
  std::uint64_t rays = std::uint64_t{1} << 19U;
  std::uint64_t polygons = std::uint64_t{1} << 18U;
  std::uint64_t corners = std::uint64_t{1} << 20U;
  std::uint64_t cut_cells = std::uint64_t{1} << 18U;
  std::uint64_t tile_entries = std::uint64_t{1} << 21U;
};

// The numbers that the search for pupils reads, besides the paths. Frames with equal numbers have the same pupils.
struct SearchInput {
  std::vector<std::uint32_t> words;
  std::shared_ptr<const DevicePatterns> patterns;  // whose radii bound the light at the stop
  bool operator==(const SearchInput&) const = default;
};

// The data that stay on the device from frame to frame, and the sizes of its buffers.
struct AdaptiveKept {
  int most_rows = 0;  // DeviceOptions::most_rows
  AdaptiveCapacity capacity;
  std::shared_ptr<const DevicePaths> paths;  // that are uploaded; null: none
  std::vector<PathPlace> places;  // by path
  SearchInput searched;  // whose pupils are in Slot::Found; empty: none
};

// A frame whose rays do not fit into the device's buffers: fewer groups of it may.
struct TooManyRays : vk::OutOfDeviceMemoryError {
  TooManyRays() : vk::OutOfDeviceMemoryError("the rays of a frame do not fit into the device's buffers") {}
};

class AdaptiveFrame {
 public:
  // All must outlive the frame.
  AdaptiveFrame(DeviceContext& device, const DeviceInfo& info, const AdaptiveJob& job, AdaptiveKept& kept,
                StopTables& tables, StarburstStage& starbursts);

  // Replaces the image's values, if the job reads them. Returns early when the context is cancelled.
  DeviceWork draw(Image& image, const Context& context);
  // Afterwards: whether a picture that is kept is in DeviceContext::kept_rows(), or else in Slot::Picture.
  [[nodiscard]] bool keeps_bands() const { return job_.use == PictureUse::Kept && in_bands_; }

 private:
  // How many of something a buffer can hold, the bytes of each, and how many the last try counted.
  struct Need {
    Slot slot;
    std::uint64_t* capacity;
    std::uint64_t bytes, counted;
  };
  [[nodiscard]] std::array<Need, 5> needs() const;
  [[nodiscard]] int rows_a_band() const;
  void upload_paths();
  void upload_items(const Frame& band);
  [[nodiscard]] SearchInput search_input() const;
  void need_buffers();
  void clear_search();
  void clear_lists();
  void search();
  void search_pupils();
  void list_polygons();
  void fill_tiles();
  [[nodiscard]] std::uint64_t sums_bytes() const;
  [[nodiscard]] std::uint32_t flags() const;
  // Parameters of dispatches.
  [[nodiscard]] std::int32_t small_px() const;
  [[nodiscard]] std::uint32_t usual_cells() const;
  [[nodiscard]] std::uint32_t list_part() const;  // polygons of a task
  [[nodiscard]] bool has_picture() const { return job_.patterns && job_.patterns->picture != DevicePatterns::kNone; }
  [[nodiscard]] bool has_occluders() const { return job_.dirt || has_picture(); }
  [[nodiscard]] Shader choose(Shader clean, Shader occluded) const { return has_occluders() ? occluded : clean; }
  [[nodiscard]] Program for_iris(Program program) const {
    program.has_picture = has_picture();
    program.has_patterns = has_patterns_;
    return program;
  }
  // Sets what is drawn: the whole frame, or some of its rows.
  void prepare(const Frame& rows);
  // Submissions: return false if a buffer did not suffice. Rows are drawn into the image, from its first row on.
  [[nodiscard]] bool try_search();
  [[nodiscard]] bool try_rows(int first_row, bool with_search, Image& image);
  [[nodiscard]] bool finish_try();
  // Afterwards. Returns false if the device's limits do not allow buffers that suffice.
  [[nodiscard]] bool grow();
  // Repeats a submission with larger buffers. Returns false if the device's limits do not allow those.
  template <class Try>
  [[nodiscard]] bool grow_until(const Try& succeeds);
  void draw_in_bands(Image& image, const Context& context);
  void dispatch(Program program, GroupCount groups) { device_.dispatch(for_iris(program), parameters_, groups); }
  void dispatch_indirect(Program program, std::uint64_t byte) {
    device_.dispatch_indirect(for_iris(program), parameters_, byte);
  }
  void dispatch_at(std::uint32_t level, Program program, GroupCount groups);
  [[nodiscard]] GroupCount rows_of(std::uint64_t groups) const;

  DeviceContext& device_;
  const DeviceInfo& info_;
  const AdaptiveJob& job_;
  AdaptiveKept& kept_;
  StopTables& tables_;
  AdaptiveCapacity& capacity_;
  StarburstStage& starbursts_;
  PathGeometry geometry_ = PathGeometry::General;
  bool has_patterns_ = true;  // items have stop patterns
  AdaptiveParameters parameters_;
  TileLists lists_;
  bool in_bands_ = false;
  SearchInput search_input_;
  bool has_pupils_ = false;  // in Slot::Found, from an earlier frame or submission
  std::array<std::uint32_t, kCounters> counters_{};  // of the last try
  DeviceWork work_;
};

}  // namespace contrejour::inline internal::vulkan
