// SPDX-License-Identifier: Apache-2.0
#include "vulkan/adaptive_frame.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "base/tasks.h"

namespace contrejour::inline internal::vulkan {
namespace {

// The part of the squared error that the rays' spacing may spend; the rest is for what the measures of coarse cells do
// not see. It was chosen, not derived: the papers' lenses come out at 63 dB and better with it (docs/gpu.md).
constexpr double kBudgetShare = 0.125;
// Images of few pixels have more cells a side, by this factor, which was chosen: coarse cells put their light into the
// wrong pixels, which the measured errors do not show.
constexpr double kCellsOfSpots = 1.25;
// The part that cells may spend which are merged as one plane serves them, if all items lie on each other.
constexpr double kMergeShare = 0.25;
// The counters are fetched before the pixels.
constexpr std::uint64_t kCountersBytes = sizeof(std::uint32_t) * kCounters;
constexpr std::int32_t kRasterTile = 16;  // TILE_SIDE of adaptive/raster.comp

// In parallel, since a picture's memory is first touched here.
void copy_rows(const float* from, int rows, Image& image, int first_row) {
  const auto row_length = 3 * static_cast<std::size_t>(image.width);
  parallel_for(static_cast<std::size_t>(rows), {}, [&](std::size_t row) {
    std::copy_n(from + row * row_length, row_length,
                image.pixels.data() + image.index(0, first_row + static_cast<int>(row)));
  });
}

std::uint32_t narrow(std::uint64_t value) { return static_cast<std::uint32_t>(value); }

// The surfaces that a tracer of all paths must handle.
PathGeometry geometry_of(const DevicePaths& paths) {
  PathGeometry most = PathGeometry::Spheres;
  for (const PacketPath& path : paths.paths) most = std::max(most, path.geometry());
  return most;
}

}  // namespace

AdaptiveFrame::AdaptiveFrame(DeviceContext& device, const DeviceInfo& info, const AdaptiveJob& job, AdaptiveKept& kept,
                             StopTables& tables, StarburstStage& starbursts)
    : device_(device), info_(info), job_(job), kept_(kept), tables_(tables), capacity_(kept.capacity),
      starbursts_(starbursts) {
  for (const Need& need : needs()) *need.capacity = std::min(*need.capacity, device_.most_of(need.slot, need.bytes));
}

std::array<AdaptiveFrame::Need, 5> AdaptiveFrame::needs() const {
  return {{
      {Slot::Crossings, &capacity_.rays, std::max(kRayBytes, kCrossingBytes),
       std::uint64_t{kRaysABlock} * counters_[kRayBlocks]},
      {Slot::Large, &capacity_.polygons, kLargeBytes, counters_[kPolygonsListed]},
      {Slot::LargeCorners, &capacity_.corners, kCornerBytes, counters_[kCornersListed]},
      {Slot::CutCells, &capacity_.cut_cells, kCutBytes, counters_[kCutCells]},
      {Slot::TileLists, &capacity_.tile_entries, sizeof(std::uint32_t), counters_[kMostTileEntries]},
  }};
}

int AdaptiveFrame::rows_a_band() const {
  const std::uint64_t row_bytes = kPixelBytes * static_cast<std::uint64_t>(job_.frame.width);
  const int fitting = static_cast<int>(std::clamp<std::uint64_t>(info_.storage_range_bytes / row_bytes, 1,
                                                                 static_cast<std::uint64_t>(job_.frame.height)));
  return kept_.most_rows > 0 ? std::min(fitting, kept_.most_rows) : fitting;
}

GroupCount AdaptiveFrame::rows_of(std::uint64_t groups) const { return groups_of(groups * kRaysABlock, info_); }

void AdaptiveFrame::upload_paths() {
  if (kept_.paths == job_.paths) return;
  PathData data;
  kept_.paths = nullptr;  // until all is there
  kept_.searched = {};
  kept_.places.clear();
  for (const PacketPath& path : job_.paths->paths) kept_.places.push_back(data.add(path, PacketPrecision::Float));
  device_.upload(Slot::Floats, data.floats());
  device_.upload(Slot::Integers, data.integers());
  const std::vector<float> tables = data.table_pairs();
  device_.upload(Slot::Tables, tables);
  work_.bytes += 4 * (data.floats().size() + data.integers().size() + tables.size());
  kept_.paths = job_.paths;
}

void AdaptiveFrame::upload_items(const Frame& band) {
  std::vector<float> starts;
  for (const DeviceStart& start : job_.starts) {
    const std::vector<float> numbers = start_numbers(start.start, start.meridian, pixel_map(band, {}));
    starts.insert(starts.end(), numbers.begin(), numbers.end());
    starts.resize((starts.size() + 3) / 4 * 4);  // whole texels
  }
  std::vector<ItemRecord> items;
  items.reserve(job_.items.size());
  for (const DeviceItem& item : job_.items) {
    const PacketPath& path = job_.paths->paths[item.path];
    const PathPlace place = kept_.places[item.path];
    const Vec2 origin = pixel_map(band, item.shift_mm).origin;
    items.push_back({.reals_at = place.reals_at,
                     .integers_at = place.integers_at,
                     .step_count = narrow(path.steps().size()),
                     .crossing_count = static_cast<std::uint32_t>(path.stop_crossings()),
                     .irradiance = static_cast<float>(item.irradiance),
                     .gain = item.gain,
                     .window_mm = {static_cast<float>(item.window_mm.x), static_cast<float>(item.window_mm.y)},
                     .start = item.start,
                     .pixel_origin = {static_cast<float>(origin.x), static_cast<float>(origin.y)},
                     .pattern = item.pattern == DevicePatterns::kNone ? 0 : item.pattern + 1,
                     .gain_by_x = item.gain_by_x,
                     .gain_by_y = item.gain_by_y,
                     .middle_mm = {static_cast<float>(item.middle_mm.x), static_cast<float>(item.middle_mm.y)}});
  }
  std::vector<GroupRecord> groups;
  groups.reserve(job_.groups.size());
  for (const DeviceGroup& group : job_.groups) {
    for (std::uint32_t k = 0; k < group.count; ++k) items[group.first + k].group = narrow(groups.size());
    groups.push_back({group.first, group.count, group.middle, 0});
  }
  const std::vector<float> bounds = bound_numbers(job_.iris);
  device_.upload(Slot::Starts, starts);
  device_.upload(Slot::Bounds, bounds);
  std::vector<std::uint32_t> words;
  words.reserve(kItemWords * items.size() + kGroupWords * groups.size());
  for (const ItemRecord& item : items) std::ranges::copy(std::bit_cast<ItemWords>(item), std::back_inserter(words));
  for (const GroupRecord& group : groups)
    std::ranges::copy(std::bit_cast<GroupWords>(group), std::back_inserter(words));
  device_.upload(Slot::Items, words);
  work_.bytes += 4 * (starts.size() + bounds.size() + words.size());
  parameters_.bound_count = narrow(bounds.size() / 8);
}

// Lights that stand still keep their pupils, whatever their brightness and the frame.
SearchInput AdaptiveFrame::search_input() const {
  const auto bits_of = [](double number) { return std::bit_cast<std::uint32_t>(static_cast<float>(number)); };
  std::vector<std::uint32_t> words{parameters_.window_blocks, parameters_.flags & kSymmetric};
  for (const DeviceGroup& group : job_.groups) words.insert(words.end(), {group.first, group.count, group.middle});
  for (const DeviceItem& item : job_.items)
    words.insert(words.end(),
                 {item.path, item.start, item.pattern, bits_of(item.window_mm.x), bits_of(item.window_mm.y)});
  for (const DeviceStart& start : job_.starts)
    std::ranges::transform(start_numbers(start.start, start.meridian, {}), std::back_inserter(words), bits_of);
  return {std::move(words), job_.patterns};
}

// Drivers may bound the turns of an invocation's loops (lavapipe: 65535 in all), and each polygon of a list may take
// several for every point, and for every stroke about a point, in each part of a pixel.
std::uint32_t AdaptiveFrame::list_part() const {
  constexpr std::uint32_t kTurns = 60000, kTurnsAPolygon = 120, kTurnsAStroke = 51, kLeast = 32;
  if (!has_occluders()) return TileLists::kMostOfTask;
  const std::uint32_t strokes = job_.dirt ? job_.dirt->most_about_cell() + 1 : 0;
  return std::clamp(kTurns / (kTurnsAPolygon + kTurnsAStroke * strokes), kLeast, TileLists::kMostOfTask);
}

// The histogram, then the sums of the tiles that are drawn in parts.
std::uint64_t AdaptiveFrame::sums_bytes() const {
  return kHistogramBytes + lists_.most_split_tiles() * kRasterTile * kRasterTile * 3 * kSumBytes;
}

void AdaptiveFrame::need_buffers() {
  const std::uint64_t groups = job_.groups.size(), items = job_.items.size();
  const auto pixels = static_cast<std::uint64_t>(parameters_.width) * static_cast<std::uint64_t>(parameters_.height);
  device_.need(Slot::Found, kFoundBytes * kSearchLevelsKept * groups);
  device_.need(Slot::States, kStateBytes * (items + 1));
  device_.need(Slot::Counters, sizeof(std::uint32_t) * kCounters);
  device_.need(Slot::Rays, kRayBytes * capacity_.rays);
  device_.need(Slot::Crossings, kCrossingBytes * capacity_.rays);
  device_.need(Slot::Vertices, kVertexBytes * capacity_.rays);
  device_.need(Slot::Blocks, sizeof(float) * kMergedOfRays * (capacity_.rays / kRaysABlock + 1));
  device_.need(Slot::Large, kLargeBytes * capacity_.polygons);
  device_.need(Slot::LargeCorners, kCornerBytes * capacity_.corners);
  device_.need(Slot::CutCells, kCutBytes * capacity_.cut_cells);
  lists_ = tile_lists_of(parameters_.width, parameters_.height, kRasterTile);
  lists_.list_part = list_part();
  lists_.polygon_capacity = narrow(capacity_.polygons);
  lists_.entry_capacity = narrow(capacity_.tile_entries);
  vulkan::need_buffers(device_, lists_);
  device_.need(Slot::Sums, sums_bytes());
  device_.need(Slot::Picture, kPixelBytes * pixels);
  device_.need_fetched(kCountersBytes + kPixelBytes * pixels);
  parameters_.ray_capacity = narrow(capacity_.rays);
  parameters_.large_capacity = narrow(capacity_.polygons);
  parameters_.corner_capacity = narrow(capacity_.corners);
  parameters_.cut_capacity = narrow(capacity_.cut_cells);
}

// Clears the buffers that the search and the measures count into.
void AdaptiveFrame::clear_search() {
  if (!has_pupils_) device_.clear(Slot::Found, 0, kFoundBytes * kSearchLevelsKept * job_.groups.size());
  device_.clear(Slot::Sums, 0, kHistogramBytes);
  device_.clear(Slot::Counters, sizeof(std::uint32_t) * kRayBlocks, sizeof(std::uint32_t) * (kCounters - kRayBlocks));
}

// Clears the buffers that the polygons and the lists of tiles count into.
void AdaptiveFrame::clear_lists() {
  device_.clear(Slot::Sums, kHistogramBytes, sums_bytes() - kHistogramBytes);
  device_.clear(Slot::Counters, 0, sizeof(std::uint32_t) * kRayBlocks);
  vulkan::clear_lists(device_, lists_);
}

void AdaptiveFrame::dispatch_at(std::uint32_t level, Program program, GroupCount groups) {
  AdaptiveParameters p = parameters_;
  p.level = level;
  device_.dispatch(for_iris(program), p, groups);
}

void AdaptiveFrame::search_pupils() {
  const std::uint64_t groups = job_.groups.size();
  for (const std::uint32_t level : kSearchLevels) {
    dispatch_at(level, {Shader::AdaptiveSearch, geometry_},
                rows_of(groups * search_blocks(level, parameters_.window_blocks, job_.has_axial_symmetry)));
    device_.barrier();
  }
  device_.end_stage("pupils");
}

// Finds the pupils, if they are not known, and distributes the error.
void AdaptiveFrame::search() {
  if (!has_pupils_) search_pupils();
  dispatch({choose(Shader::AdaptiveMeasure, Shader::AdaptiveMeasureOccluded), geometry_}, rows_of(job_.groups.size()));
  device_.barrier();
  device_.end_stage("measures");
  dispatch(Shader::AdaptiveBudget, {1, 1});
  device_.barrier();
  device_.end_stage("budget");
}

void AdaptiveFrame::list_polygons() {
  dispatch_indirect({Shader::AdaptiveTrace, geometry_}, kIndirectRays);
  device_.barrier();
  device_.end_stage("rays");
  dispatch_indirect(Shader::AdaptiveVertices, kIndirectRays);
  device_.barrier();
  if (!has_occluders()) {  // which cells.comp looks for in every cell
    dispatch_indirect(Shader::AdaptiveMerge, kIndirectMerged);
    device_.barrier();
  }
  dispatch_indirect(choose(Shader::AdaptiveCells, Shader::AdaptiveCellsOccluded), kIndirectRays);
  device_.barrier();
  device_.end_stage("cells");
  dispatch(Shader::AdaptiveCutSize, {1, 1});
  device_.barrier();
  dispatch_indirect(choose(Shader::AdaptiveCut, Shader::AdaptiveCutOccluded), kIndirectCut);
  device_.barrier();
  device_.end_stage("cut cells");
}

void AdaptiveFrame::fill_tiles() {
  fill_lists(device_, info_, lists_);
  device_.end_stage("tile lists");
  const Shader unoccluded = job_.patterns ? Shader::AdaptiveRasterPatterned : Shader::AdaptiveRaster;
  dispatch_indirect(choose(unoccluded, Shader::AdaptiveRasterOccluded), kIndirectTiles);
  device_.barrier();
  dispatch_indirect(Shader::AdaptiveJoinParts, kIndirectTiles);
  device_.barrier();
  device_.end_stage("tiles");
}

bool AdaptiveFrame::finish_try() {
  device_.fetch(Slot::Counters, sizeof(std::uint32_t) * kCounters);
  device_.end_stage("fetch");
  device_.finish();
  if (!has_pupils_) kept_.searched = search_input_;
  has_pupils_ = true;
  std::copy_n(device_.read<std::uint32_t>(), std::size_t{kCounters}, counters_.begin());
  work_.add_stages(device_.stages_ms());
  return counters_[kOverflows] == 0;
}

bool AdaptiveFrame::try_search() {
  need_buffers();
  device_.begin();
  clear_search();
  clear_lists();
  device_.barrier();
  device_.end_stage("clear");
  search();
  return finish_try();
}

bool AdaptiveFrame::try_rows(int first_row, bool with_search, Image& image) {
  need_buffers();
  device_.begin();
  if (with_search) clear_search();
  clear_lists();
  device_.barrier();
  device_.end_stage("clear");
  if (with_search) search();
  list_polygons();
  fill_tiles();
  starbursts_.draw(parameters_.width, parameters_.height, first_row);
  const std::uint64_t bytes =
      kPixelBytes * static_cast<std::uint64_t>(parameters_.width) * static_cast<std::uint64_t>(parameters_.height);
  if (job_.use == PictureUse::Read) device_.fetch(Slot::Picture, bytes, kCountersBytes);
  if (keeps_bands())
    device_.keep(Slot::Picture, bytes,
                 kPixelBytes * static_cast<std::uint64_t>(parameters_.width) * static_cast<std::uint64_t>(first_row));
  if (!finish_try()) return false;
  if (job_.use == PictureUse::Read)
    copy_rows(device_.read<float>(kCountersBytes), parameters_.height, image, first_row);
  work_.primitives += counters_[kPolygonsListed];
  return true;
}

// Buffers that were too small become as large as was counted and a quarter more. Stages after the first overflow were
// not counted in full, so that another try may be needed.
bool AdaptiveFrame::grow() {
  if ((counters_[kOverflows] & kTurnsOverflow) != 0)
    throw std::runtime_error("its driver ended a loop over the polygons of a tile early");
  bool fits = true;
  for (const Need& need : needs()) {
    const std::uint64_t most = device_.most_of(need.slot, need.bytes);
    if (need.counted > *need.capacity) *need.capacity = std::min(need.counted + need.counted / 4, most);
    fits = fits && need.counted <= most;
  }
  return fits;
}

void AdaptiveFrame::prepare(const Frame& rows) {
  parameters_.width = rows.width;
  parameters_.height = rows.height;
  upload_items(rows);
}

template <class Try>
bool AdaptiveFrame::grow_until(const Try& succeeds) {
  constexpr int kMostTries = 8;
  for (int tries = 0; tries < kMostTries; ++tries) {
    if (succeeds()) return true;
    if (!grow()) return false;
  }
  throw vk::OutOfDeviceMemoryError("the buffers of a frame do not suffice");
}

// Finds pupils and budget for the whole frame, then draws some rows at a time.
void AdaptiveFrame::draw_in_bands(Image& image, const Context& context) {
  const Frame& frame = job_.frame;
  in_bands_ = true;
  if (keeps_bands())
    device_.need(device_.kept_rows(),
                 kPixelBytes * static_cast<std::uint64_t>(frame.width) * static_cast<std::uint64_t>(frame.height));
  prepare(frame);
  if (!grow_until([&] { return try_search(); })) throw TooManyRays();
  int rows = std::min(rows_a_band(), (frame.height + 1) / 2);
  for (int row = 0; row < frame.height && !context.cancelled();) {
    Frame band = frame;
    band.origin_y += row;
    band.height = std::min(rows, frame.height - row);
    prepare(band);
    if (!grow_until([&] { return try_rows(row, false, image); })) {
      if (band.height == 1)
        throw vk::OutOfDeviceMemoryError("the polygons of a row of the frame do not fit into the device's buffers");
      rows = (band.height + 1) / 2;
      continue;
    }
    row += band.height;
    if (context.progress) context.progress(static_cast<double>(row) / frame.height);
  }
}

// Stop patterns are dearer than the sums.
std::int32_t AdaptiveFrame::small_px() const { return job_.patterns || job_.dirt ? 64 : 12; }

std::uint32_t AdaptiveFrame::flags() const {
  const std::uint32_t bits = (job_.iris.is_circle() ? kCircle : 0U) | (job_.iris.has_half_tones() ? kHalfTones : 0U);
  return bits | dirt_flags(job_.dirt.get()) | (job_.has_axial_symmetry ? kSymmetric : 0U);
}

// The cells a side of an item of the mean flux, which was chosen (docs/gpu.md). Items with fringes have more, as maps
// to fringes are linear in half a cell. Frames of many lights have fewer, which must fit into the device's buffers.
std::uint32_t AdaptiveFrame::usual_cells() const {
  constexpr std::uint32_t kFringed = 16, kUsual = 8, kCoarse = 6;
  constexpr std::uint64_t kManyItems = 4096;  // several lights through a long zoom
  const std::uint64_t items = job_.items.size();
  const auto fits = [&](std::uint64_t cells) {
    constexpr std::uint64_t kShare = 2;  // of the buffer, for ghosts that need more
    return kShare * items * ((cells + 1) * (cells + 1) + kRaysABlock) <=
           device_.most_of(Slot::Crossings, std::max(kRayBytes, kCrossingBytes));
  };
  if (has_patterns_ && items <= kManyItems && fits(kFringed)) return kFringed;
  return fits(kUsual) ? kUsual : kCoarse;
}

DeviceWork AdaptiveFrame::draw(Image& image, const Context& context) {
  const Frame& frame = job_.frame;
  upload_paths();
  work_.bytes += tables_.upload(device_, info_, job_.patterns, job_.dirt);
  geometry_ = geometry_of(*job_.paths);
  has_patterns_ =
      std::ranges::any_of(job_.items, [](const DeviceItem& item) { return item.pattern != DevicePatterns::kNone; });
  AdaptiveParameters& p = parameters_;
  p.item_count = narrow(job_.items.size());
  p.group_count = narrow(job_.groups.size());
  p.flags = flags();
  p.picture = picture_number(job_.patterns.get());
  p.small_px = small_px();
  // At bounds finer than the standard one more of the error is what the measures do not see.
  const double fineness = std::min(job_.error / AdaptiveOptions{}.error, 1.0);
  p.usual_cells = usual_cells();
  p.spot_cells = static_cast<float>(kCellsOfSpots / fineness * p.usual_cells);
  p.window_blocks = job_.has_axial_symmetry ? 2 : 6;
  p.front_gap_mm = static_cast<float>(job_.front_gap_mm);
  const double squared_error = job_.error * job_.error * frame.width * frame.height;
  p.budget = static_cast<float>(kBudgetShare * std::sqrt(fineness) * squared_error);
  p.least_peak = static_cast<float>(job_.least_peak);
  p.merge_error = static_cast<float>(job_.error * std::sqrt(kMergeShare / static_cast<double>(job_.items.size())));
  prepare(frame);
  search_input_ = search_input();
  has_pupils_ = kept_.searched == search_input_;
  if (!has_pupils_) kept_.searched = {};  // until they are found
  if (rows_a_band() < frame.height || !grow_until([&] { return try_rows(0, true, image); }))
    draw_in_bands(image, context);
  else if (context.progress)
    context.progress(1.0);
  constexpr std::uint64_t kSearchedRays = 256;  // a block
  work_.rays += kRaysABlock * counters_[kRayBlocks] + kSearchedRays * counters_[kSearchedBlocks];
  return work_;
}

}  // namespace contrejour::inline internal::vulkan
