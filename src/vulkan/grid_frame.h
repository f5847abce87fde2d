// SPDX-License-Identifier: Apache-2.0
// Draws a job's grids on a device: in batches that fit into its buffers, and in bands of rows where the picture does
// not. Failures are exceptions, as DeviceContext's. Thread-safety: one thread at a time.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "vulkan/counters.h"
#include "vulkan/device_context.h"
#include "vulkan/layout.h"
#include "vulkan/starburst_stage.h"
#include "vulkan/stop_tables.h"
#include "vulkan/tile_lists.h"

namespace contrejour::inline internal::vulkan {

// Limits of a batch; smaller ones give the same picture.
struct BatchLimits {
  std::uint64_t rays = std::uint64_t{1} << 20U;
  std::uint32_t large_polygons = 1U << 19U;  // all cells of the largest grid, two triangles each
  std::uint32_t large_corners = 1U << 22U;
  std::uint64_t rays_a_submission = std::uint64_t{1} << 24U;
};

// The sizes of buffers that grow, from frame to frame.
struct GridKept {
  int most_rows = 0, large_pixels = 0;  // those of DeviceOptions
  std::uint64_t tile_entries = std::uint64_t{1} << 21U;
};

class GridFrame {
 public:
  // All must outlive the frame.
  GridFrame(DeviceContext& device, const DeviceInfo& info, const GridJob& job, const BatchLimits& limits,
            GridKept& kept, StopTables& tables, StarburstStage& starbursts);

  // Replaces the image's values, if the job reads them. Returns early when the context is cancelled.
  DeviceWork draw(Image& image, const Context& context);
  // Whether a picture that is kept is in DeviceContext::kept_rows(), or else in Slot::Picture.
  [[nodiscard]] bool keeps_bands() const;

 private:
  struct Band {
    Frame frame;
    int first_row = 0;
  };

  [[nodiscard]] int rows_a_band() const;
  void prepare(const Frame& band, std::uint64_t batch_rays);
  void upload_stops();
  [[nodiscard]] bool is_tiled() const { return std::holds_alternative<TiledOptions>(job_.style); }
  // Whether the job has stop patterns, dirt or a picture as the iris.
  [[nodiscard]] bool is_dimmed() const { return job_.patterns || job_.dirt; }
  // The program for such jobs, or for others.
  [[nodiscard]] Program choose(Program clean, Program dimmed) const;
  [[nodiscard]] std::uint32_t turns_a_pixel() const;
  [[nodiscard]] std::uint32_t list_part() const;  // polygons of a task
  [[nodiscard]] std::int32_t dimmed_pixels() const;  // Parameters::large_pixels of such jobs
  [[nodiscard]] std::size_t end_of_batch(std::size_t first, std::uint64_t batch_rays) const;
  // Returns false if a buffer did not suffice.
  [[nodiscard]] bool draw_band(const Band& band, std::uint64_t batch_rays, Image& image, const Context& context);
  void draw_batch(std::size_t first, std::size_t end);
  // After a buffer did not suffice: makes it larger, or batches smaller.
  void make_room(std::uint64_t& batch_rays);
  void trace(std::size_t first, std::size_t end);
  void draw_cells(std::size_t first, std::size_t end);
  void draw_primitives(std::size_t first, std::size_t end);
  // The parameters of the grids' dispatches, one for each run of grids.
  [[nodiscard]] std::vector<Parameters> runs_of(std::size_t first, std::size_t end) const;
  // An invocation a ray, or a cell with `less` of 1.
  void dispatch_runs(Program shader, std::span<const Parameters> runs, std::uint32_t less);
  void merge(std::span<const Parameters> runs);
  void list_primitives(std::span<const Parameters> runs);
  void draw_listed(std::optional<Program> open, Program cut, Program large, std::size_t any);
  [[nodiscard]] std::uint32_t style_flags() const;
  void resolve(const Frame& band, const DeviceGrid& any, bool is_first);
  void read(const Band& band, Image& image);

  DeviceContext& device_;
  const DeviceInfo& info_;
  const GridJob& job_;
  BatchLimits limits_;
  GridKept& kept_;
  StopTables& tables_;
  StarburstStage& starbursts_;
  TileLists lists_;  // of the present band
  std::uint32_t primitive_capacity_ = 0;  // of `tiled`: what the buffer of primitives holds
  double fixed_point_ = 1.0;  // units of the sums for a pixel value of 1
  std::vector<const DeviceGrid*> grids_in_order_;  // those of the same gains one after the other
  std::vector<Parameters> grids_;  // of the present band, by grid in this order
  std::vector<PathPlace> places_;  // likewise
  std::array<std::uint32_t, kCounters> counters_{};  // of the last band
  DeviceWork work_;
};

// The paths of grids, and the trace of one of them. through_picture: a picture as the iris blocks its rays.
void upload_paths(DeviceContext& device, const PathData& data);
void dispatch_trace(DeviceContext& device, const DeviceInfo& info, const DeviceGrid& grid, const PathPlace& place,
                    const Parameters& parameters, bool through_picture = false);
[[nodiscard]] std::uint64_t ray_count(const DeviceGrid& grid);
// The largest value of a table at angles of incidence up to 75 degrees.
[[nodiscard]] double largest_reflectance(const float* table);

}  // namespace contrejour::inline internal::vulkan
