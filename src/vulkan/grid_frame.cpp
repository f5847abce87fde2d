// SPDX-License-Identifier: Apache-2.0
#include "vulkan/grid_frame.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include "vulkan/stop_layout.h"

namespace contrejour::inline internal::vulkan {
namespace {

// The pixels of a polygon's bounds from which on tiles draw it. On GPUs an invocation with more to draw than others
// would keep them waiting; on processors, where lists cost more than that, only the largest are worth it.
constexpr std::int32_t kLarge = 64, kLargeOnProcessor = 4096;
constexpr std::int32_t kTile = 8;  // the workgroups of large_cells.comp and large_primitives.comp
// The sums hold 63 bits: an estimate of the light of all grids in one pixel takes this many, and the rest is for
// grazing rays, which may be brighter than estimated, and for single values of tiny cells.
constexpr double kFixedPoint = 0x1p50;
// A picture as the iris is looked up pixel by pixel, and clips no polygons: a straight bound that is far away.
const std::vector<float> kNoBound{1.0F, 0.0F, 1e30F, 1.0F, 0.0F, 0.0F, 0.0F, 0.0F};

// An estimate of the light that all grids bring to a pixel at most, without their gains.
double most_light(std::span<const DeviceGrid> grids) {
  double sum = 0.0;
  for (const DeviceGrid& grid : grids) {
    const double area = static_cast<double>(ray_count(grid)) * std::abs(grid.step_mm.x * grid.step_mm.y);
    double light = area * grid.irradiance;
    for (const PacketStep& step : grid.path.steps())
      if (step.event == PathEvent::Reflect) light *= largest_reflectance(grid.path.tables() + step.reflectance);
    sum += light;
  }
  return sum;
}

bool is_obscured(const DeviceGrid& grid) { return std::ranges::any_of(grid.path.steps(), &PacketStep::blocks_within); }

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

// A grid's path lies in a buffer from its place on, as far as a uniform buffer reaches.
void upload_paths(DeviceContext& device, const PathData& data) {
  device.need(Slot::Floats, data.floats().size() * sizeof(float) + kPathRange);
  device.need(Slot::Doubles, data.doubles().size() * sizeof(double) + kPathRange);
  device.need(Slot::Integers, data.integers().size() * sizeof(std::int32_t) + kPathRange);
  device.write_first(Slot::Floats, data.floats());
  device.write_first(Slot::Doubles, data.doubles());
  device.write_first(Slot::Integers, data.integers());
  device.upload(Slot::Tables, data.table_pairs());
}

void dispatch_trace(DeviceContext& device, const DeviceInfo& info, const DeviceGrid& grid, const PathPlace& place,
                    const Parameters& parameters, bool through_picture) {
  const bool in_double = grid.precision == PacketPrecision::Double;
  const auto bytes = [](std::uint32_t numbers, std::size_t size) { return numbers * static_cast<std::uint32_t>(size); };
  device.set_path({in_double ? 0 : bytes(place.reals_at, sizeof(float)),
                   in_double ? bytes(place.reals_at, sizeof(double)) : 0,
                   bytes(place.integers_at, sizeof(std::int32_t))});
  Program program({in_double ? Shader::TraceDouble : Shader::TraceFloat, grid.path.geometry()});
  if (through_picture) program.shader = in_double ? Shader::TracePictureDouble : Shader::TracePictureFloat;
  program.has_picture = through_picture;
  device.dispatch(program, parameters, groups_of(ray_count(grid), info));
}

GridFrame::GridFrame(DeviceContext& device, const DeviceInfo& info, const GridJob& job, const BatchLimits& limits,
                     GridKept& kept, StopTables& tables, StarburstStage& starbursts)
    : device_(device), info_(info), job_(job), limits_(limits), kept_(kept), tables_(tables), starbursts_(starbursts) {
  for (const DeviceGrid& grid : job.grids) grids_in_order_.push_back(&grid);
  std::ranges::stable_sort(grids_in_order_, {}, [](const DeviceGrid* grid) {
    return std::tuple(grid->gain, grid->side, grid->path.stop_crossings(), is_obscured(*grid));
  });
  const double most = most_light(job.grids);
  if (most > 0.0) fixed_point_ = kFixedPoint / most;
  kept_.tile_entries = std::min(kept_.tile_entries, device.most_of(Slot::TileLists, sizeof(std::uint32_t)));
  limits_.rays = std::min({limits_.rays, device.most_of(Slot::Crossings, kCrossingBytes),
                           device.most_of(Slot::CutCells, 2 * kCutRecordBytes)});
  const auto within = [&](std::uint32_t limit, Slot slot, std::uint64_t bytes) {
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(limit, device.most_of(slot, bytes)));
  };
  limits_.large_polygons = within(limits_.large_polygons, Slot::Large, kLargeBytes);
  limits_.large_corners = within(limits_.large_corners, Slot::LargeCorners, kCornerBytes);
}

Program GridFrame::choose(Program clean, Program dimmed) const {
  if (!is_dimmed()) return clean;
  dimmed.has_picture = job_.iris.is_picture();
  return dimmed;
}

// The turns of loops that a pixel of a polygon takes at most: for the polygon's corners, for the iris's bounds at each
// crossing of the stop, and for what is seen in parts.
std::uint32_t GridFrame::turns_a_pixel() const {
  constexpr std::uint32_t kCorners = 50, kCrossings = 3, kTones = 64, kSamples = 16, kSquares = 64;
  std::uint32_t turns = kCorners + kCrossings * static_cast<std::uint32_t>(job_.iris.bounds().size());
  if (job_.iris.has_half_tones()) turns += kCrossings * kTones;
  if (job_.dirt && (is_tiled() || !job_.dirt->has_outlines))
    turns += kCrossings * (kSamples + kSquares * (job_.dirt->most_about_cell() + 1));
  return turns;
}

// Drivers may bound the turns of an invocation's loops (lavapipe: 65535 in all).
constexpr std::uint32_t kMostTurns = 60000;

std::uint32_t GridFrame::list_part() const {
  constexpr std::uint32_t kLeast = 8;
  if (!is_dimmed()) return TileLists::kMostOfTask;
  return std::clamp(kMostTurns / turns_a_pixel(), kLeast, TileLists::kMostOfTask);
}

std::int32_t GridFrame::dimmed_pixels() const {
  return std::clamp(static_cast<std::int32_t>(kMostTurns / turns_a_pixel()), 4, kLarge);
}

int GridFrame::rows_a_band() const {
  const std::uint64_t row_bytes = std::max(kSumBytes, kPixelBytes) * static_cast<std::uint64_t>(job_.frame.width);
  const int fitting = static_cast<int>(std::clamp<std::uint64_t>(info_.storage_range_bytes / row_bytes, 1,
                                                                 static_cast<std::uint64_t>(job_.frame.height)));
  return kept_.most_rows > 0 ? std::min(fitting, kept_.most_rows) : fitting;
}

bool GridFrame::keeps_bands() const { return job_.use == PictureUse::Kept && rows_a_band() < job_.frame.height; }

std::uint32_t GridFrame::style_flags() const {
  std::uint32_t flags = job_.iris.is_circle() ? kCircle : 0U;
  if (const auto* const bundle = std::get_if<BundleOptions>(&job_.style); bundle != nullptr && bundle->smooth_shading)
    flags |= kSmooth;
  return flags;
}

// Uploads the grids for a band of the frame, and sets the parameters of their dispatches.
void GridFrame::prepare(const Frame& band, std::uint64_t batch_rays) {
  PathData data;
  grids_.assign(grids_in_order_.size(), {});
  places_.assign(grids_in_order_.size(), {});
  const auto* const tiled = std::get_if<TiledOptions>(&job_.style);
  const std::vector<float> bounds = job_.iris.is_picture() ? kNoBound : bound_numbers(job_.iris);
  const std::int32_t fitting = is_dimmed() ? dimmed_pixels() : info_.kind == "processor" ? kLargeOnProcessor : kLarge;
  const std::int32_t large_pixels = kept_.large_pixels > 0 ? kept_.large_pixels : fitting;
  std::size_t end = 0;  // of the batch
  std::uint64_t ray = 0;  // of the batch
  for (std::size_t k = 0; k < grids_in_order_.size(); ++k) {
    const DeviceGrid& grid = *grids_in_order_[k];
    Parameters& p = grids_[k];
    places_[k] = data.add(grid, pixel_map(band, grid.shift_mm), p);
    if (k == end) {
      end = end_of_batch(k, batch_rays);
      ray = 0;
    }
    p.first_ray = static_cast<std::uint32_t>(ray);
    ray += ray_count(grid);
    p.side = static_cast<std::uint32_t>(grid.side);
    p.bound_count = static_cast<std::uint32_t>(bounds.size() / 8);
    p.flags = style_flags() | (is_obscured(grid) ? kObscured : 0U) | dirt_flags(job_.dirt.get()) |
              (job_.iris.has_half_tones() ? kHalfTones : 0U) |
              (job_.dirt && !job_.dirt->has_outlines ? kDirtBySquares : 0U);
    if (tiled != nullptr) p.merge_threshold = static_cast<float>(tiled->merge_threshold * 0.5 * band.full_width);
    p.width = band.width;
    p.height = band.height;
    p.triangle_weight =
        static_cast<float>(0.5 * std::abs(grid.step_mm.x * grid.step_mm.y) * grid.irradiance * fixed_point_);
    p.large_capacity = limits_.large_polygons;
    p.primitive_capacity = primitive_capacity_;
    p.large_pixels = large_pixels;
    p.corner_capacity = limits_.large_corners;
    p.first_grid = static_cast<std::uint32_t>(k);
    p.picture = picture_number(job_.patterns.get());
  }
  upload_paths(device_, data);
  device_.upload(Slot::Bounds, bounds);
  if (is_dimmed()) upload_stops();
  work_.bytes += 4 * (data.floats().size() + data.integers().size() + data.table_pairs().size() + bounds.size()) +
                 8 * data.doubles().size();
}

// Uploads what dims the grids' light at the stop and on the front, grid by grid.
void GridFrame::upload_stops() {
  std::vector<GridRecord> records;
  records.reserve(grids_in_order_.size());
  for (std::size_t k = 0; k < grids_in_order_.size(); ++k) {
    const DeviceGrid& grid = *grids_in_order_[k];
    const PacketStart& start = grid.path.start();
    const auto narrow = [](double number) { return static_cast<float>(number); };
    const bool has_pattern = grid.pattern != DevicePatterns::kNone;
    records.push_back({.pattern = has_pattern ? grid.pattern + 1 : 0,
                       .outer_radius = has_pattern ? job_.patterns->patterns[grid.pattern].outer_radius : 1.0F,
                       .first_ray = grids_[k].first_ray,
                       .side = static_cast<std::uint32_t>(grid.side),
                       .start_mm = {narrow(start.origin_mm.x), narrow(start.origin_mm.y)},
                       .step_mm = {narrow(grid.step_mm.x), narrow(grid.step_mm.y)},
                       .along = {narrow(start.direction.x), narrow(start.direction.y), narrow(start.direction.z)},
                       .per_distance_mm = start.diverges ? narrow(start.per_distance_mm) : 0.0F,
                       .front_gap_mm = narrow(grid.front_gap_mm)});
  }
  device_.upload(Slot::Items, records);
  work_.bytes += sizeof(GridRecord) * records.size() + tables_.upload(device_, info_, job_.patterns, job_.dirt);
}

// Grids with a stop pattern are traced through a circle as large as the pattern.
void GridFrame::trace(std::size_t first, std::size_t end) {
  for (std::size_t k = first; k < end; ++k) {
    const DeviceGrid& grid = *grids_in_order_[k];
    Parameters p = grids_[k];
    if (grid.pattern != DevicePatterns::kNone) p.flags |= kCircle;
    dispatch_trace(device_, info_, grid, places_[k], p, is_tiled() && job_.iris.is_picture());
    work_.rays += ray_count(grid);
  }
}

// The end of the batch of grids of the same gains that begins with one.
std::size_t GridFrame::end_of_batch(std::size_t first, std::uint64_t batch_rays) const {
  std::size_t end = first;
  std::uint64_t rays = 0;
  const auto& gain = grids_in_order_[first]->gain;
  for (; end < grids_in_order_.size() && grids_in_order_[end]->gain == gain; ++end) {
    const std::uint64_t more = ray_count(*grids_in_order_[end]);
    if (end > first && rays + more > batch_rays) break;
    rays += more;
  }
  return end;
}

// Draws what earlier shaders have listed: what is open, if that was listed, what is cut, and what is large.
void GridFrame::draw_listed(std::optional<Program> open, Program cut, Program large, std::size_t any) {
  TileLists sizes = lists_;
  sizes.level = 3;
  device_.barrier();
  device_.dispatch(Shader::ListSizes, sizes, {1, 1});
  device_.barrier();
  device_.end_stage("cells");
  if (open) device_.dispatch_indirect(*open, grids_[any], kIndirectOpen);
  device_.dispatch_indirect(cut, grids_[any], kIndirectCut);
  device_.barrier();
  device_.end_stage("cut cells");
  fill_lists(device_, info_, lists_);
  device_.end_stage("tile lists");
  device_.dispatch_indirect(large, grids_[any], kIndirectTiles);
}

// A dispatch serves all grids that follow each other and have the same parameters, since each has its cost: on lavapipe
// that of some dozens of rays.
std::vector<Parameters> GridFrame::runs_of(std::size_t first, std::size_t end) const {
  std::vector<Parameters> runs;
  for (std::size_t k = first; k < end; ++k) {
    const Parameters& grid = grids_[k];
    const auto has_same = [&](const Parameters& run) {
      return run.side == grid.side && run.crossing_count == grid.crossing_count && run.flags == grid.flags;
    };
    if (runs.empty() || !has_same(runs.back()))
      runs.push_back(grid);
    else
      ++runs.back().grid_count;
  }
  return runs;
}

void GridFrame::dispatch_runs(Program shader, std::span<const Parameters> runs, std::uint32_t less) {
  for (const Parameters& run : runs) {
    const std::uint64_t side = run.side - less;
    device_.dispatch(shader, run, groups_of(run.grid_count * side * side, info_));
  }
}

void GridFrame::draw_cells(std::size_t first, std::size_t end) {
  const std::vector<Parameters> runs = runs_of(first, end);
  dispatch_runs(Shader::Vertices, runs, 0);
  device_.barrier();
  device_.end_stage("vertices");
  dispatch_runs(choose(Shader::Cells, Shader::CellsDimmed), runs, 1);
  draw_listed({}, choose(Shader::CutCells, Shader::CutCellsDimmed),
              choose(Shader::LargeCells, Shader::LargeCellsDimmed), first);
}

// Finds level by level which blocks of cells are whole.
void GridFrame::merge(std::span<const Parameters> runs) {
  const int steps = std::get<TiledOptions>(job_.style).merge_steps;
  for (int level = 0; level <= steps; ++level) {
    for (Parameters p : runs) {
      const BlockLevels levels(p.side - 1, p.blocks_at);
      if (levels.side(level) == 0) continue;
      p.level = static_cast<std::uint32_t>(level);
      p.level_side = levels.side(level);
      p.blocks_at = levels.at(level);
      p.finer_side = level > 0 ? levels.side(level - 1) : 0;
      p.finer_at = level > 0 ? levels.at(level - 1) : 0;
      device_.dispatch(level == 0 ? choose(Shader::Blocks, Shader::BlocksDimmed) : Program(Shader::MergedBlocks), p,
                       groups_of(std::uint64_t{p.grid_count} * p.level_side * p.level_side, info_));
    }
    device_.barrier();
  }
}

void GridFrame::list_primitives(std::span<const Parameters> runs) {
  const int steps = std::get<TiledOptions>(job_.style).merge_steps;
  for (const Parameters& run : runs) {
    const BlockLevels levels(run.side - 1, run.blocks_at);
    for (int level = 0; level <= steps && levels.side(level) > 0; ++level) {
      Parameters p = run;
      p.level = static_cast<std::uint32_t>(level);
      p.level_side = levels.side(level);
      p.blocks_at = levels.at(level);
      const bool is_last = level == steps || levels.side(level + 1) == 0;
      p.flags |= is_last ? kLastLevel : 0U;
      p.finer_side = is_last ? 0 : levels.side(level + 1);
      p.finer_at = is_last ? 0 : levels.at(level + 1);
      device_.dispatch(choose(Shader::Primitives, Shader::PrimitivesDimmed), p,
                       groups_of(std::uint64_t{p.grid_count} * p.level_side * p.level_side, info_));
    }
  }
}

void GridFrame::draw_primitives(std::size_t first, std::size_t end) {
  std::vector<Parameters> runs = runs_of(first, end);
  std::uint32_t blocks = 0;
  for (Parameters& run : runs) {
    run.blocks_at = blocks;
    run.block_stride = BlockLevels(run.side - 1, 0).count();
    blocks += run.grid_count * run.block_stride;
    device_.dispatch(Shader::Widen, run, groups_of(64 * std::uint64_t{run.grid_count}, info_));
  }
  device_.barrier();
  dispatch_runs(Shader::Vertices, runs, 0);
  device_.barrier();
  device_.end_stage("vertices");
  merge(runs);
  device_.end_stage("blocks");
  list_primitives(runs);
  const auto method = std::get<TiledOptions>(job_.style).interpolation;
  draw_listed(Program(Shader::OpenPrimitives, method),
              choose({Shader::CutPrimitives, method}, {Shader::CutPrimitivesDimmed, method}),
              choose({Shader::LargePrimitives, method}, {Shader::LargePrimitivesDimmed, method}), first);
}

void GridFrame::draw_batch(std::size_t first, std::size_t end) {
  device_.clear(Slot::Counters, 0, sizeof(std::uint32_t) * kOverflows);  // those of a batch come first
  device_.clear(Slot::Counters, sizeof(std::uint32_t) * kCutCells, 2 * sizeof(std::uint32_t));
  clear_lists(device_, lists_);
  device_.barrier();
  trace(first, end);
  device_.barrier();
  device_.end_stage("rays");
  if (is_tiled())
    draw_primitives(first, end);
  else
    draw_cells(first, end);
  device_.barrier();
  device_.end_stage("tiles");
}

// Adds the light of grids, which have the same gains, to the picture.
void GridFrame::resolve(const Frame& band, const DeviceGrid& any, bool is_first) {
  Parameters p;
  p.width = band.width;
  p.height = band.height;
  p.flags = is_first ? kFirst : 0U;
  for (std::size_t c = 0; c < 3; ++c) p.gain[c] = static_cast<float>(any.gain[c] / fixed_point_);
  device_.dispatch(Shader::Resolve, p,
                   groups_of(static_cast<std::uint64_t>(p.width) * static_cast<std::uint64_t>(p.height), info_));
  device_.barrier();
  device_.end_stage("sums");
}

void GridFrame::read(const Band& band, Image& image) {
  const auto values = 3 * static_cast<std::uint64_t>(band.frame.width) * static_cast<std::uint64_t>(band.frame.height);
  starbursts_.draw(band.frame.width, band.frame.height, band.first_row);
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
  const auto pixels = static_cast<std::uint64_t>(band.frame.width) * static_cast<std::uint64_t>(band.frame.height);
  device_.need(Slot::Sums, kSumBytes * pixels);
  device_.need(Slot::Picture, kPixelBytes * pixels);
  device_.need_fetched(kPixelBytes * pixels + sizeof(std::uint32_t) * kCounters);
  device_.need(Slot::Counters, sizeof(std::uint32_t) * kCounters);
  lists_ = tile_lists_of(band.frame.width, band.frame.height, kTile);
  lists_.flags = is_tiled() ? kListPrimitives : 0U;
  lists_.polygon_capacity = limits_.large_polygons;
  lists_.entry_capacity = static_cast<std::uint32_t>(kept_.tile_entries);
  lists_.list_part = list_part();
  need_buffers(device_, lists_);
  device_.need(Slot::Large, kLargeBytes * limits_.large_polygons);
  device_.need(Slot::LargeCorners, kCornerBytes * limits_.large_corners);
  std::uint64_t most_rays = batch_rays;
  for (const DeviceGrid& grid : job_.grids) most_rays = std::max(most_rays, ray_count(grid));
  device_.need(Slot::Rays, kRayBytes * most_rays);
  device_.need(Slot::Crossings, kCrossingBytes * most_rays);
  device_.need(Slot::Vertices, kVertexBytes * most_rays);
  primitive_capacity_ = static_cast<std::uint32_t>(is_tiled() ? 2 * most_rays : most_rays);
  device_.need(Slot::CutCells, kCutRecordBytes * primitive_capacity_);
  if (is_tiled()) device_.need(Slot::Blocks, 2 * sizeof(float) * most_rays);
  prepare(band.frame, batch_rays);

  device_.begin();
  device_.clear(Slot::Sums, 0, kSumBytes * pixels);
  device_.clear(Slot::Counters, 0, sizeof(std::uint32_t) * kCounters);
  device_.barrier();
  std::uint64_t submitted = 0;
  bool is_dark = true;  // nothing is in the picture yet
  for (std::size_t first = 0, end = 0; first < grids_in_order_.size(); first = end) {
    const auto& gain = grids_in_order_[first]->gain;
    end = end_of_batch(first, batch_rays);
    draw_batch(first, end);
    if (end == grids_in_order_.size() || grids_in_order_[end]->gain != gain) {
      resolve(band.frame, *grids_in_order_[first], is_dark);
      is_dark = false;
    }
    for (std::size_t k = first; k < end; ++k) submitted += ray_count(*grids_in_order_[k]);
    if (submitted < limits_.rays_a_submission || end == grids_in_order_.size()) continue;
    device_.finish();
    if (context.cancelled()) return true;
    if (context.progress) context.progress(static_cast<double>(end) / static_cast<double>(grids_in_order_.size()));
    device_.begin();
    submitted = 0;
  }
  read(band, image);
  return counters_[kOverflows] == 0;
}

void GridFrame::make_room(std::uint64_t& batch_rays) {
  if ((counters_[kOverflows] & kTurnsOverflow) != 0)
    throw std::runtime_error("its driver ended a loop over polygons or their parts early");
  const std::uint64_t needed = counters_[kMostTileEntries];
  const std::uint64_t most = device_.most_of(Slot::TileLists, sizeof(std::uint32_t));
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
