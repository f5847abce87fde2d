// SPDX-License-Identifier: Apache-2.0
#include "vulkan/grid_frame.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace contrejour::inline internal::vulkan {
namespace {

constexpr std::int32_t kTile = 8;  // the workgroups of large_cells.comp and large_primitives.comp
// The sums hold 63 bits: an estimate of the light of all grids in one pixel takes this many, and the rest is for
// grazing rays, which may be brighter than estimated, and for single values of tiny cells.
constexpr double kFixedPoint = 0x1p50;

// An estimate of the light that all grids bring to a pixel at most.
double most_light(std::span<const DeviceGrid> grids) {
  double sum = 0.0;
  for (const DeviceGrid& grid : grids) {
    const double area = static_cast<double>(ray_count(grid)) * std::abs(grid.step_mm.x * grid.step_mm.y);
    float gain = 0.0F;
    for (const float channel : grid.gain) gain = std::max(gain, std::abs(channel));
    double light = area * grid.irradiance * gain;
    for (const PacketStep& step : grid.path.steps())
      if (step.event == PathEvent::Reflect) light *= largest_reflectance(grid.path.tables() + step.reflectance);
    sum += light;
  }
  return sum;
}

// The blocks of 1, 2 x 2, 4 x 4 ... cells of a grid, one level after the other in memory.
class BlockLevels {
 public:
  BlockLevels(std::uint32_t cells, std::uint32_t first) : cells_(cells), first_(first) {}

  [[nodiscard]] std::uint32_t side(int level) const { return cells_ >> static_cast<unsigned>(level); }
  [[nodiscard]] std::uint32_t at(int level) const {
    std::uint32_t at = first_;
    for (int k = 0; k < level; ++k) at += side(k) * side(k);
    return at;
  }
  [[nodiscard]] std::uint32_t count() const { return at(16) - first_; }

 private:
  std::uint32_t cells_, first_;
};

}  // namespace

double largest_reflectance(const float* table) {
  constexpr int kFirst = ReflectanceTables::kIntervals / 4;
  return *std::max_element(table + kFirst, table + ReflectanceTables::kIntervals + 1);
}

std::uint64_t ray_count(const DeviceGrid& grid) {
  return static_cast<std::uint64_t>(grid.side) * static_cast<std::uint64_t>(grid.side);
}

GridFrame::GridFrame(DeviceContext& device, const DeviceInfo& info, const GridJob& job, const BatchLimits& limits,
                     GridKept& kept, StarburstStage& starbursts)
    : device_(device), info_(info), job_(job), limits_(limits), kept_(kept), starbursts_(starbursts) {
  const double most = most_light(job.grids);
  if (most > 0.0) fixed_point_ = kFixedPoint / most;
  const std::uint64_t range = info.storage_range_bytes;
  kept_.tile_entries = std::min(kept_.tile_entries, range / sizeof(std::uint32_t));
  limits_.rays = std::min(limits_.rays, range / std::max(kRayBytes, kCrossingBytes));
  limits_.large_polygons =
      static_cast<std::uint32_t>(std::min<std::uint64_t>(limits_.large_polygons, range / kLargeBytes));
  limits_.large_corners =
      static_cast<std::uint32_t>(std::min<std::uint64_t>(limits_.large_corners, range / kCornerBytes));
}

int GridFrame::rows_a_band() const {
  const std::uint64_t row_bytes = kSumBytes * static_cast<std::uint64_t>(job_.frame.width);
  const int fitting = static_cast<int>(std::clamp<std::uint64_t>(info_.storage_range_bytes / row_bytes, 1,
                                                                 static_cast<std::uint64_t>(job_.frame.height)));
  return kept_.most_rows > 0 ? std::min(fitting, kept_.most_rows) : fitting;
}

bool GridFrame::keeps_bands() const { return job_.use == PictureUse::Kept && rows_a_band() < job_.frame.height; }

std::uint32_t GridFrame::style_flags() const {
  std::uint32_t flags = job_.iris.is_circle() ? kCircle : 0U;
  if (const auto* const tiled = std::get_if<TiledOptions>(&job_.style))
    flags |= static_cast<std::uint32_t>(tiled->interpolation) << kMethodShift;
  else if (std::get<BundleOptions>(job_.style).smooth_shading)
    flags |= kSmooth;
  return flags;
}

// Uploads the grids for a band of the frame, and sets the parameters of their dispatches.
void GridFrame::prepare(const Frame& band) {
  PathData data;
  grids_.assign(job_.grids.size(), {});
  blocks_at_.assign(job_.grids.size(), 0);
  const auto* const tiled = std::get_if<TiledOptions>(&job_.style);
  const std::vector<float> bounds = bound_numbers(job_.iris);
  for (std::size_t k = 0; k < job_.grids.size(); ++k) {
    const DeviceGrid& grid = job_.grids[k];
    Parameters& p = grids_[k];
    data.add(grid, pixel_map(band, grid.shift_mm), p);
    p.side = static_cast<std::uint32_t>(grid.side);
    p.bound_count = static_cast<std::uint32_t>(bounds.size() / 8);
    const bool obscured = std::ranges::any_of(grid.path.steps(), &PacketStep::blocks_within);
    p.flags = style_flags() | (obscured ? kObscured : 0U);
    if (tiled != nullptr) p.merge_threshold = static_cast<float>(tiled->merge_threshold * 0.5 * band.full_width);
    p.width = band.width;
    p.height = band.height;
    p.triangle_weight = static_cast<float>(0.5 * std::abs(grid.step_mm.x * grid.step_mm.y) * grid.irradiance);
    for (std::size_t c = 0; c < 3; ++c) p.gain[c] = static_cast<float>(grid.gain[c] * fixed_point_);
    p.large_capacity = limits_.large_polygons;
    p.corner_capacity = limits_.large_corners;
  }
  device_.upload(Slot::Floats, data.floats());
  device_.upload(Slot::Doubles, data.doubles());
  device_.upload(Slot::Integers, data.integers());
  device_.upload(Slot::Tables, data.tables());
  device_.upload(Slot::Bounds, bounds);
  work_.uploaded_bytes += 4 * (data.floats().size() + data.integers().size() + data.tables().size() + bounds.size()) +
                          8 * data.doubles().size();
}

void GridFrame::trace(std::size_t first, std::size_t end) {
  std::uint64_t ray = 0;
  for (std::size_t k = first; k < end; ++k) {
    grids_[k].first_ray = static_cast<std::uint32_t>(ray);
    const bool in_double = job_.grids[k].precision == PacketPrecision::Double;
    device_.dispatch({in_double ? Shader::TraceDouble : Shader::TraceFloat, job_.grids[k].path.geometry()}, grids_[k],
                     groups_of(ray_count(job_.grids[k]), info_));
    ray += ray_count(job_.grids[k]);
  }
  work_.rays += ray;
}

void GridFrame::draw_large(Shader shader, std::size_t any) {
  device_.barrier();
  device_.end_stage("cells");
  fill_lists(device_, info_, lists_);
  device_.end_stage("tile lists");
  device_.dispatch_indirect(shader, grids_[any], kIndirectTiles);
}

void GridFrame::share_vertices(std::size_t first, std::size_t end) {
  for (std::size_t k = first; k < end; ++k)
    device_.dispatch(Shader::Vertices, grids_[k], groups_of(ray_count(job_.grids[k]), info_));
  device_.barrier();
  device_.end_stage("vertices");
}

void GridFrame::draw_cells(std::size_t first, std::size_t end) {
  share_vertices(first, end);
  for (std::size_t k = first; k < end; ++k) {
    const std::uint64_t cells = grids_[k].side - 1;
    device_.dispatch(Shader::Cells, grids_[k], groups_of(cells * cells, info_));
  }
  draw_large(Shader::LargeCells, first);
}

// Finds level by level which blocks of cells are whole.
void GridFrame::merge(std::size_t first, std::size_t end) {
  const int steps = std::get<TiledOptions>(job_.style).merge_steps;
  for (int level = 0; level <= steps; ++level) {
    for (std::size_t k = first; k < end; ++k) {
      const BlockLevels levels(grids_[k].side - 1, blocks_at_[k]);
      if (levels.side(level) == 0) continue;
      Parameters p = grids_[k];
      p.level = static_cast<std::uint32_t>(level);
      p.level_side = levels.side(level);
      p.blocks_at = levels.at(level);
      p.finer_side = level > 0 ? levels.side(level - 1) : 0;
      p.finer_at = level > 0 ? levels.at(level - 1) : 0;
      device_.dispatch(Shader::Blocks, p, groups_of(std::uint64_t{p.level_side} * p.level_side, info_));
    }
    device_.barrier();
  }
}

void GridFrame::draw_primitives(std::size_t first, std::size_t end) {
  std::uint32_t blocks = 0;
  for (std::size_t k = first; k < end; ++k) {
    device_.dispatch(Shader::Widen, grids_[k], {1, 1});
    blocks_at_[k] = blocks;
    blocks += BlockLevels(grids_[k].side - 1, 0).count();
  }
  device_.barrier();
  share_vertices(first, end);
  merge(first, end);
  const int steps = std::get<TiledOptions>(job_.style).merge_steps;
  for (std::size_t k = first; k < end; ++k) {
    const BlockLevels levels(grids_[k].side - 1, blocks_at_[k]);
    for (int level = 0; level <= steps && levels.side(level) > 0; ++level) {
      Parameters p = grids_[k];
      p.level = static_cast<std::uint32_t>(level);
      p.level_side = levels.side(level);
      p.blocks_at = levels.at(level);
      const bool is_last = level == steps || levels.side(level + 1) == 0;
      p.flags |= is_last ? kLastLevel : 0U;
      p.finer_side = is_last ? 0 : levels.side(level + 1);
      p.finer_at = is_last ? 0 : levels.at(level + 1);
      device_.dispatch(Shader::Primitives, p, groups_of(std::uint64_t{p.level_side} * p.level_side, info_));
    }
  }
  draw_large(Shader::LargePrimitives, first);
}

void GridFrame::draw_batch(std::size_t first, std::size_t end) {
  device_.clear(Slot::Counters, 0, sizeof(std::uint32_t) * kOverflows);  // those of a batch come first
  clear_lists(device_, lists_);
  device_.barrier();
  trace(first, end);
  device_.barrier();
  device_.end_stage("rays");
  if (std::holds_alternative<BundleOptions>(job_.style))
    draw_cells(first, end);
  else
    draw_primitives(first, end);
  device_.barrier();
  device_.end_stage("tiles");
}

void GridFrame::resolve(const Band& band, Image& image) {
  const auto values = 3 * static_cast<std::uint64_t>(band.frame.width) * static_cast<std::uint64_t>(band.frame.height);
  Parameters p;
  p.width = band.frame.width;
  p.height = band.frame.height;
  p.gain[0] = static_cast<float>(1.0 / fixed_point_);
  device_.dispatch(Shader::Resolve, p, groups_of(values, info_));
  device_.barrier();
  starbursts_.draw(p.width, p.height, band.first_row);
  if (job_.use == PictureUse::Read) device_.fetch(Slot::Picture, sizeof(float) * values);
  if (keeps_bands())
    device_.keep(
        Slot::Picture, sizeof(float) * values,
        kPixelBytes * static_cast<std::uint64_t>(band.frame.width) * static_cast<std::uint64_t>(band.first_row));
  device_.fetch(Slot::Counters, sizeof(std::uint32_t) * kCounters, sizeof(float) * values);
  device_.end_stage("fetch");
  device_.finish();
  work_.add_stages(device_.stages_ms());
  if (job_.use == PictureUse::Read)
    std::copy_n(device_.read<float>(), values, image.pixels.data() + image.index(0, band.first_row));
  std::copy_n(device_.read<std::uint32_t>(sizeof(float) * values), std::size_t{kCounters}, counters_.begin());
}

bool GridFrame::draw_band(const Band& band, std::uint64_t batch_rays, Image& image, const Context& context) {
  prepare(band.frame);
  const auto pixels = static_cast<std::uint64_t>(band.frame.width) * static_cast<std::uint64_t>(band.frame.height);
  device_.need(Slot::Sums, kSumBytes * pixels);
  device_.need(Slot::Picture, kPixelBytes * pixels);
  device_.need_fetched(kPixelBytes * pixels + sizeof(std::uint32_t) * kCounters);
  device_.need(Slot::Counters, sizeof(std::uint32_t) * kCounters);
  lists_ = tile_lists_of(band.frame.width, band.frame.height, kTile);
  lists_.flags = std::holds_alternative<TiledOptions>(job_.style) ? kListPrimitives : 0U;
  lists_.polygon_capacity = limits_.large_polygons;
  lists_.entry_capacity = static_cast<std::uint32_t>(kept_.tile_entries);
  need_buffers(device_, lists_);
  device_.need(Slot::Large, kLargeBytes * limits_.large_polygons);
  device_.need(Slot::LargeCorners, kCornerBytes * limits_.large_corners);
  std::uint64_t most_rays = batch_rays;
  for (const DeviceGrid& grid : job_.grids) most_rays = std::max(most_rays, ray_count(grid));
  device_.need(Slot::Rays, kRayBytes * most_rays);
  device_.need(Slot::Crossings, kCrossingBytes * most_rays);
  device_.need(Slot::Vertices, kVertexBytes * most_rays);
  if (std::holds_alternative<TiledOptions>(job_.style)) device_.need(Slot::Blocks, 2 * sizeof(float) * most_rays);

  device_.begin();
  device_.clear(Slot::Sums, 0, kSumBytes * pixels);
  device_.clear(Slot::Counters, 0, sizeof(std::uint32_t) * kCounters);
  device_.barrier();
  std::uint64_t submitted = 0;
  for (std::size_t first = 0, end = 0; first < job_.grids.size(); first = end) {
    std::uint64_t rays = 0;
    for (; end < job_.grids.size() && (end == first || rays + ray_count(job_.grids[end]) <= batch_rays); ++end)
      rays += ray_count(job_.grids[end]);
    draw_batch(first, end);
    submitted += rays;
    if (submitted < limits_.rays_a_submission || end == job_.grids.size()) continue;
    device_.finish();
    if (context.cancelled()) return true;
    if (context.progress) context.progress(static_cast<double>(end) / static_cast<double>(job_.grids.size()));
    device_.begin();
    submitted = 0;
  }
  resolve(band, image);
  return counters_[kOverflows] == 0;
}

void GridFrame::make_room(std::uint64_t& batch_rays) {
  const std::uint64_t needed = counters_[kMostTileEntries], most = info_.storage_range_bytes / sizeof(std::uint32_t);
  const bool only_lists = counters_[kOverflows] == kListsOverflow;
  if (only_lists && kept_.tile_entries < most) {
    kept_.tile_entries = std::min(needed + needed / 4, most);
    return;
  }
  if (batch_rays == 1) throw vk::OutOfDeviceMemoryError("the polygons of one grid do not fit into the device's memory");
  batch_rays = std::max<std::uint64_t>(batch_rays / 4, 1);
}

DeviceWork GridFrame::draw(Image& image, const Context& context) {
  const Frame& frame = job_.frame;
  const int rows = rows_a_band();
  if (keeps_bands())
    device_.need(device_.kept_rows(),
                 kPixelBytes * static_cast<std::uint64_t>(frame.width) * static_cast<std::uint64_t>(frame.height));
  std::uint64_t batch_rays = limits_.rays;
  for (int row = 0; row < frame.height && !context.cancelled();) {
    Band band{frame, row};
    band.frame.origin_y += row;
    band.frame.height = std::min(rows, frame.height - row);
    if (draw_band(band, batch_rays, image, context)) {
      work_.primitives += counters_[kPrimitiveCount];
      row += band.frame.height;
      continue;
    }
    make_room(batch_rays);
  }
  return work_;
}

}  // namespace contrejour::inline internal::vulkan
