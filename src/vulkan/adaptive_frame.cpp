// SPDX-License-Identifier: Apache-2.0
#include "vulkan/adaptive_frame.h"

#include <algorithm>
#include <bit>

#include "base/tasks.h"
#include "vulkan/grid_frame.h"

namespace contrejour::inline internal::vulkan {
namespace {

// The part of the squared error that the rays' spacing may spend; the rest is for what the measures of coarse cells do
// not see. It was chosen, not derived: the papers' lenses came out at 50 dB and better with it (docs/gpu.md).
constexpr double kBudgetShare = 0.25;

// In parallel, since a picture's memory is first touched here.
void copy_rows(const float* from, int rows, Image& image, int first_row) {
  const auto row_length = 3 * static_cast<std::size_t>(image.width);
  parallel_for(static_cast<std::size_t>(rows), {}, [&](std::size_t row) {
    std::copy_n(from + row * row_length, row_length,
                image.pixels.data() + image.index(0, first_row + static_cast<int>(row)));
  });
}

std::uint32_t narrow(std::uint64_t value) { return static_cast<std::uint32_t>(value); }

// Levels of an image pyramid (DownsampledPicture).
std::uint32_t levels_of(std::uint32_t side) {
  std::uint32_t levels = 1;
  for (; side % 2 == 0 && side > 2; side /= 2) ++levels;
  return levels;
}

// The records of all patterns, followed by their tables.
std::vector<std::uint32_t> pattern_words(const DevicePatterns& all) {
  std::vector<std::uint32_t> table_at;
  std::size_t size = sizeof(PatternRecord) / sizeof(std::uint32_t) * all.patterns.size();
  for (const std::vector<float>& table : all.tables) {
    table_at.push_back(narrow(size));
    size += table.size();
  }
  std::vector<std::uint32_t> words;
  words.reserve(size);
  for (const DevicePattern& p : all.patterns) {
    const PatternRecord record{table_at[p.table], p.side,      p.side == 0 ? 0 : levels_of(p.side),
                               p.outer_radius,    p.scale,     p.level_from,
                               p.roughness,       p.difference};
    const auto numbers = std::bit_cast<std::array<std::uint32_t, 8>>(record);
    words.insert(words.end(), numbers.begin(), numbers.end());
  }
  for (const std::vector<float>& table : all.tables)
    for (const float number : table) words.push_back(std::bit_cast<std::uint32_t>(number));
  return words;
}

}  // namespace

AdaptiveFrame::AdaptiveFrame(DeviceContext& device, const DeviceInfo& info, const AdaptiveJob& job, AdaptiveKept& kept)
    : device_(device), info_(info), job_(job), kept_(kept), capacity_(kept.capacity) {}

int AdaptiveFrame::rows_a_band() const {
  const std::uint64_t row_bytes = kPixelBytes * static_cast<std::uint64_t>(job_.frame.width);
  return static_cast<int>(std::clamp<std::uint64_t>(info_.storage_range_bytes / row_bytes, 1,
                                                    static_cast<std::uint64_t>(job_.frame.height)));
}

GroupCount AdaptiveFrame::rows_of(std::uint64_t groups) const { return groups_of(groups * kRaysABlock, info_); }

void AdaptiveFrame::upload_paths() {
  if (kept_.paths == job_.paths) return;
  PathData data;
  kept_.paths = nullptr;  // until all is there
  kept_.places.clear();
  for (const PacketPath& path : job_.paths->paths) kept_.places.push_back(data.add(path, PacketPrecision::Float));
  device_.upload(Slot::Floats, data.floats());
  device_.upload(Slot::Integers, data.integers());
  device_.upload(Slot::Tables, data.tables());
  work_.uploaded_bytes += 4 * (data.floats().size() + data.integers().size() + data.tables().size());
  kept_.paths = job_.paths;
}

void AdaptiveFrame::upload_patterns() {
  if (!job_.patterns || kept_.patterns == job_.patterns) return;
  kept_.patterns = nullptr;
  const std::vector<std::uint32_t> words = pattern_words(*job_.patterns);
  const std::uint64_t bytes = sizeof(std::uint32_t) * words.size();
  if (bytes > info_.storage_range_bytes)
    throw vk::OutOfDeviceMemoryError("the stop patterns of a frame do not fit into the device's buffers");
  device_.upload(Slot::Patterns, words);
  work_.uploaded_bytes += bytes;
  kept_.patterns = job_.patterns;
}

void AdaptiveFrame::upload_items(const Frame& band) {
  std::vector<float> starts;
  for (const DeviceStart& start : job_.starts) {
    const std::vector<float> numbers = start_numbers(start.start, start.meridian, pixel_map(band, {}));
    starts.insert(starts.end(), numbers.begin(), numbers.end());
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
  device_.upload(Slot::Items, items);
  device_.upload(Slot::Groups, groups);
  work_.uploaded_bytes +=
      4 * (starts.size() + bounds.size()) + sizeof(ItemRecord) * items.size() + sizeof(GroupRecord) * groups.size();
  parameters_.bound_count = narrow(bounds.size() / 8);
}

void AdaptiveFrame::need_buffers() {
  const std::uint64_t groups = job_.groups.size(), items = job_.items.size();
  const auto pixels = static_cast<std::uint64_t>(parameters_.width) * static_cast<std::uint64_t>(parameters_.height);
  const std::uint64_t tiles = std::uint64_t{parameters_.tiles_across} * parameters_.tiles_down;
  device_.need(Slot::Boxes, kBoxBytes * kMostLevels * groups);
  device_.need(Slot::Found, kFoundBytes * kMostLevels * groups);
  device_.need(Slot::States, kStateBytes * items);
  device_.need(Slot::Offsets, sizeof(std::uint32_t) * (items + 1));
  device_.need(Slot::Sums, kHistogramBytes);
  device_.need(Slot::Counters, sizeof(std::uint32_t) * kAdaptiveCounters);
  device_.need(Slot::Indirect, kIndirectBytes);
  device_.need(Slot::Rays, kRayBytes * capacity_.rays);
  device_.need(Slot::Crossings, kCrossingBytes * capacity_.rays);
  device_.need(Slot::Vertices, kVertexBytes * capacity_.rays);
  device_.need(Slot::Large, kLargeBytes * capacity_.polygons);
  device_.need(Slot::LargeCorners, kCornerBytes * capacity_.corners);
  device_.need(Slot::CutCells, kCutBytes * capacity_.cut_cells);
  device_.need(Slot::TileCounts, 2 * sizeof(std::uint32_t) * tiles);
  device_.need(Slot::TileFirst, sizeof(std::uint32_t) * tiles);
  device_.need(Slot::Wide, sizeof(std::uint32_t) * capacity_.polygons);
  device_.need(Slot::TileLists, sizeof(std::uint32_t) * capacity_.tile_entries);
  device_.need(Slot::Picture, kPixelBytes * pixels);
  device_.need_fetched(kPixelBytes * pixels + sizeof(std::uint32_t) * kAdaptiveCounters);
  parameters_.ray_capacity = narrow(capacity_.rays);
  parameters_.large_capacity = narrow(capacity_.polygons);
  parameters_.corner_capacity = narrow(capacity_.corners);
  parameters_.cut_capacity = narrow(capacity_.cut_cells);
  parameters_.list_capacity = narrow(capacity_.tile_entries);
}

void AdaptiveFrame::clear_buffers() {
  const std::uint64_t tiles = std::uint64_t{parameters_.tiles_across} * parameters_.tiles_down;
  device_.clear(Slot::Found, 0, kFoundBytes * kMostLevels * job_.groups.size());
  device_.clear(Slot::Sums, 0, kHistogramBytes);
  device_.clear(Slot::Counters, 0, sizeof(std::uint32_t) * kAdaptiveCounters);
  device_.clear(Slot::TileCounts, 0, 2 * sizeof(std::uint32_t) * tiles);
  device_.barrier();
}

void AdaptiveFrame::dispatch_at(std::uint32_t level, Shader shader, GroupCount groups) {
  AdaptiveParameters p = parameters_;
  p.level = level;
  device_.dispatch(shader, p, groups);
}

void AdaptiveFrame::search() {
  const std::uint64_t groups = job_.groups.size();
  for (std::uint32_t level = 0; level < kSearchLevels; ++level) {
    dispatch_at(level, Shader::AdaptiveSearch, rows_of(groups * (level == 0 ? kFirstSearchBlocks : kSearchBlocks)));
    device_.barrier();
  }
  device_.end_stage("pupils");
  dispatch(Shader::AdaptiveMeasure, rows_of(groups));
  device_.barrier();
  device_.end_stage("measures");
  dispatch(Shader::AdaptiveBudget, {1, 1});
  device_.barrier();
  device_.end_stage("budget");
}

void AdaptiveFrame::list_polygons() {
  dispatch_indirect(Shader::AdaptiveTrace, kIndirectRays);
  device_.barrier();
  device_.end_stage("rays");
  dispatch_indirect(Shader::AdaptiveVertices, kIndirectRays);
  device_.barrier();
  dispatch_indirect(Shader::AdaptiveCells, kIndirectRays);
  device_.barrier();
  device_.end_stage("cells");
  dispatch_at(0, Shader::AdaptiveSizes, {1, 1});
  device_.barrier();
  dispatch_indirect(Shader::AdaptiveCut, kIndirectCut);
  device_.barrier();
  device_.end_stage("cut cells");
}

void AdaptiveFrame::fill_tiles() {
  dispatch_at(1, Shader::AdaptiveSizes, {1, 1});
  device_.barrier();
  AdaptiveParameters p = parameters_;
  p.level = 0;
  device_.dispatch_indirect(Shader::AdaptiveBin, p, kIndirectPolygons);
  device_.barrier();
  dispatch_at(2, Shader::AdaptiveSizes, {1, 1});
  device_.barrier();
  device_.dispatch_indirect(Shader::AdaptiveBinWide, p, kIndirectWide);
  device_.barrier();
  dispatch(Shader::AdaptiveTiles, groups_of(std::uint64_t{p.tiles_across} * p.tiles_down, info_));
  device_.barrier();
  p.level = 1;
  device_.dispatch_indirect(Shader::AdaptiveBin, p, kIndirectPolygons);
  device_.barrier();
  device_.dispatch_indirect(Shader::AdaptiveBinWide, p, kIndirectWide);
  device_.barrier();
  device_.end_stage("tile lists");
  dispatch(job_.patterns ? Shader::AdaptiveRasterPatterned : Shader::AdaptiveRaster, {p.tiles_across, p.tiles_down});
  device_.barrier();
  device_.end_stage("tiles");
}

void AdaptiveFrame::record() {
  device_.begin();
  clear_buffers();
  device_.end_stage("clear");
  search();
  list_polygons();
  fill_tiles();
}

bool AdaptiveFrame::try_band(Image& image, int first_row) {
  need_buffers();
  record();
  const auto values =
      3 * static_cast<std::uint64_t>(parameters_.width) * static_cast<std::uint64_t>(parameters_.height);
  if (job_.is_read) device_.fetch(Slot::Picture, sizeof(float) * values);
  device_.fetch(Slot::Counters, sizeof(std::uint32_t) * kAdaptiveCounters, sizeof(float) * values);
  device_.end_stage("fetch");
  device_.finish();
  std::copy_n(device_.read<std::uint32_t>(sizeof(float) * values), std::size_t{kAdaptiveCounters}, counters_.begin());
  if (counters_[kAdaptiveOverflows] != 0) return false;
  if (job_.is_read) copy_rows(device_.read<float>(), parameters_.height, image, first_row);
  return true;
}

// Buffers that were too small become as large as was counted and a quarter more. Stages after the first overflow were
// not counted in full, so that another try may be needed.
void AdaptiveFrame::grow() {
  const auto enough = [&](std::uint64_t& capacity, std::uint64_t counted, std::uint64_t bytes) {
    if (counted <= capacity) return;
    const std::uint64_t most = info_.storage_range_bytes / bytes;
    if (counted > most)
      throw vk::OutOfDeviceMemoryError("the polygons of a frame do not fit into the device's buffers");
    capacity = std::min(counted + counted / 4, most);
  };
  enough(capacity_.rays, std::uint64_t{kRaysABlock} * counters_[kRayBlocks], std::max(kRayBytes, kCrossingBytes));
  enough(capacity_.polygons, counters_[kPolygonsListed], kLargeBytes);
  enough(capacity_.corners, counters_[kCornersListed], kCornerBytes);
  enough(capacity_.cut_cells, counters_[kCutCells], kCutBytes);
  enough(capacity_.tile_entries, counters_[kTileEntries], sizeof(std::uint32_t));
}

DeviceWork AdaptiveFrame::draw(Image& image, const Context& context) {
  constexpr int kMostTries = 8;
  const Frame& frame = job_.frame;
  const int rows = rows_a_band();
  upload_paths();
  upload_patterns();
  for (int row = 0; row < frame.height && !context.cancelled(); row += rows) {
    Frame band = frame;
    band.origin_y += row;
    band.height = std::min(rows, frame.height - row);
    AdaptiveParameters& p = parameters_;
    p.item_count = narrow(job_.items.size());
    p.group_count = narrow(job_.groups.size());
    p.level = kSearchLevels;
    p.flags = job_.iris.is_circle() ? kCircle : 0U;
    p.width = band.width;
    p.height = band.height;
    p.tiles_across = (static_cast<std::uint32_t>(band.width) + kAdaptiveTile - 1) / kAdaptiveTile;
    p.tiles_down = (static_cast<std::uint32_t>(band.height) + kAdaptiveTile - 1) / kAdaptiveTile;
    p.budget = static_cast<float>(kBudgetShare * job_.error * job_.error * band.width * band.height);
    p.least_peak = static_cast<float>(job_.least_peak);
    upload_items(band);
    int tries = 0;
    while (!try_band(image, row)) {
      if (++tries == kMostTries) throw vk::OutOfDeviceMemoryError("the buffers of a frame do not suffice");
      grow();
    }
    work_.rays += std::uint64_t{kRaysABlock} * counters_[kRayBlocks];
    work_.primitives += counters_[kPolygonsListed];
    work_.stages_ms = device_.stages_ms();
    if (context.progress) context.progress(static_cast<double>(row + band.height) / frame.height);
  }
  return work_;
}

}  // namespace contrejour::inline internal::vulkan
