// SPDX-License-Identifier: Apache-2.0
// A device, such as a GPU, that traces grids of rays and draws them into an image. The renderers describe what is to be
// drawn as plain data and know no device; an implementation is a layer that nobody includes (src/vulkan).
// Thread-safety: one thread at a time uses a device; another() makes one for a further thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/devices.h"
#include "contrejour/expert/vulkan_target.h"
#include "contrejour/frame.h"
#include "contrejour/image.h"
#include "contrejour/method_options.h"
#include "contrejour/result.h"
#include "diffraction/placed_starburst.h"
#include "ghosts/iris_shape.h"
#include "optics/trace/packet_trace.h"
#include "render/device/device_dirt.h"

namespace contrejour::inline internal {

// A pattern that replaces the sharp iris in a ghost at one wavelength, at the last crossing of the stop (StopPattern).
// Units: stop radii.
struct DevicePattern {
  std::uint32_t table = 0;  // number of its table
  std::uint32_t side = 0;  // samples a side of a pattern of the whole iris; 0: fringes of its edges
  float outer_radius = 1.0F;  // no light passes farther from the axis
  float scale = 1.0F;  // of edges: positions in the profile a stop radius; of a whole pattern: its extent
  float level_from = 0.0F;  // of edges: the position from which on the profile counts as 1
  float roughness =
      0.0F;  // of edges: the profile's squared slope, integrated; of a whole pattern: its mean over the iris
  float difference = 0.0F;  // the squared difference from the sharp iris, as a fraction of the iris's area
  float uniform_from = 0.0F;  // of edges: as level_from, for grids of rays, whose tolerance is the CPU's
};

// The patterns of a lens's ghosts, and their tables. The profile of an edge is pairs: the value at a position, and its
// integral from the dark end less that of a sharp edge. A pattern of the whole iris is an image pyramid, finest level
// first, rows from the top. A device keeps what it was given last, so that frames with the same object upload nothing
// of it again.
struct DevicePatterns {
  static constexpr double kFirstPosition = -6.0, kLastPosition = 32.0, kPositionsAUnit = 128.0;  // of profiles
  static constexpr std::uint32_t kNone = 0xffffffff;

  std::vector<std::shared_ptr<const void>> owners;  // of what the patterns were made from
  std::vector<DevicePattern> patterns;
  std::vector<std::vector<float>> tables;
  // The number of a picture as the iris, or kNone: the pattern with this number is an image pyramid of its opening, and
  // the next one has signed distances from its outline as samples, in stop radii. Then follow the distances again, at
  // the samples of the picture's own field, and its half-tones as an image pyramid, if it has any, which dim the light
  // of all patterns of edges; a scale of 0 is a sharp outline. The tables of these two begin with the picture's
  // coordinates of the stop's x axis; the scale of half-tones is their number across the stop's diameter.
  std::uint32_t picture = kNone;
};

// The rays of one ghost, light and wavelength over a rectangle of the entrance plane.
struct DeviceGrid {
  PacketPath path;  // begins at the rectangle's lower corner; its tables outlive the grid
  Vec2 step_mm;  // between neighbouring rays
  int side = 0;  // rays a side
  PacketPrecision precision = PacketPrecision::Float;
  double irradiance = 1.0;  // a ray of transmission 1 carries the area of a cell times this
  std::array<float, 3> gain{};  // from flux to pixel values
  Vec2 shift_mm{};  // of the ghost, on the sensor
  // Number in the job; none: the iris is sharp. With one, the path's stop is as large as the pattern.
  std::uint32_t pattern = DevicePatterns::kNone;
  double front_gap_mm = 0.0;  // along the axis, from the rays' plane to the plane of dirt on the front
};

// The use of a picture after it was drawn. Unless it is read, the image on the host is left undefined.
enum class PictureUse : std::uint8_t {
  Read,  // into the image
  Kept,  // on the device, for FrameDevice::write(); read if the device cannot add all starbursts
  Discarded,  // after it was drawn
};

// Grids are drawn as cells, as `bundle` does, or as primitives, as `tiled` does.
using GridStyle = std::variant<BundleOptions, TiledOptions>;

struct GridJob {
  const Frame& frame;
  const IrisShape& iris;
  std::span<const DeviceGrid> grids;
  const GridStyle& style;
  std::span<const PlacedStarburst> starbursts = {};  // to be added to the picture
  PictureUse use = PictureUse::Read;
  std::shared_ptr<const DevicePatterns> patterns = nullptr;  // null: the iris is sharp in all grids
  std::shared_ptr<const DeviceDirt> dirt = nullptr;  // null: the lens is clean
};

// The paths of a lens's ghosts, from any point of the entrance plane. A device keeps what it was given last, so that
// frames with the same object upload nothing of it again.
struct DevicePaths {
  std::shared_ptr<const void> owner;  // of what the paths refer to
  std::vector<PacketPath> paths;  // their starts do not count
};

// A light: its ray through the lower corner of its window of the entrance plane, and the direction of the plane that
// holds the light and the lens's axis, a unit vector. With axial symmetry the window lies along it.
struct DeviceStart {
  PacketStart start;
  Vec2 meridian{1.0, 0.0};
};

// A ghost of a light at one wavelength, of which the device itself finds the pupil and chooses the rays.
struct DeviceItem {
  std::uint32_t path = 0, start = 0;  // numbers in the job
  Vec2 window_mm;  // size of the window of the entrance plane in which the pupil lies
  double irradiance = 1.0;  // a ray of transmission 1 carries its part of the window's area times this
  std::array<float, 3> gain{};  // from flux to pixel values, at the middle
  std::array<float, 3> gain_by_x{}, gain_by_y{};  // its change by mm of the entrance plane
  Vec2 middle_mm{};  // from the point of its start
  Vec2 shift_mm{};  // of the ghost, on the sensor
  std::uint32_t pattern = DevicePatterns::kNone;  // number in the job; none: the iris is sharp
};

// The wavelengths of one ghost and light: items that follow each other, by their numbers.
struct DeviceGroup {
  std::uint32_t first = 0, count = 0;
  std::uint32_t middle = 0;  // the item whose pupil serves all
};

// A frame to be drawn with no more rays than an error needs, as `adaptive` does.
struct AdaptiveJob {
  const Frame& frame;
  const IrisShape& iris;
  std::shared_ptr<const DevicePaths> paths;
  std::shared_ptr<const DevicePatterns> patterns;  // null: the iris is sharp in all items
  // Null: the lens is clean. A device keeps what it was given last, as DevicePaths.
  std::shared_ptr<const DeviceDirt> dirt;
  double front_gap_mm = 0.0;  // along the axis, from the entrance plane to the plane of dirt on the front
  std::span<const DeviceStart> starts;
  std::span<const DeviceItem> items;
  std::span<const DeviceGroup> groups;
  double error = 0.003;  // AdaptiveOptions::error
  double least_peak = 0.0;  // FramePlan::min_peak
  PictureUse use = PictureUse::Read;
  std::span<const PlacedStarburst> starbursts = {};  // to be added to the picture
  // True if all ghosts have it: small pupils lie in the plane of the light and the axis, and each half of a window
  // mirrors the other.
  bool has_axial_symmetry = true;
};

// The work of a device, and what it took.
struct DeviceWork {
  std::uint64_t rays = 0, primitives = 0;
  std::uint64_t invocations = 0;  // of shaders; counted on processors only
  std::uint64_t bytes = 0;  // uploaded and read
  // The job's starbursts that were added: all or none, as of a frame without ghosts, or if their patterns do not fit.
  std::uint64_t starbursts = 0;
  bool is_kept = false;  // the picture is on the device, and not in the image
  double ms = 0.0;
  std::vector<std::pair<std::string, double>> stages_ms = {};  // by the device's own clock; empty: it has none

  void add(const DeviceWork& other) {
    rays += other.rays;
    primitives += other.primitives;
    invocations += other.invocations;
    bytes += other.bytes;
    starbursts += other.starbursts;
    is_kept = is_kept || other.is_kept;
    ms += other.ms;
    add_stages(other.stages_ms);
  }
  // Times of the same stage are summed.
  void add_stages(const std::vector<std::pair<std::string, double>>& others) {
    for (const auto& [stage, took_ms] : others) {
      const auto same = std::ranges::find(stages_ms, stage, &std::pair<std::string, double>::first);
      if (same == stages_ms.end())
        stages_ms.emplace_back(stage, took_ms);
      else
        same->second += took_ms;
    }
  }
};

// Rays as they arrive, by vertex of the grid: as RayGrid's. A ray that failed has relative_height kFailed.
struct DeviceRays {
  std::vector<float> sensor_x_mm, sensor_y_mm, transmission, relative_height;
  std::array<std::vector<float>, kMaxStopCrossings> stop_x, stop_y;
};

class FrameDevice {
 public:
  FrameDevice() = default;
  FrameDevice(const FrameDevice&) = delete;
  FrameDevice& operator=(const FrameDevice&) = delete;
  virtual ~FrameDevice() = default;

  [[nodiscard]] virtual const DeviceInfo& info() const = 0;

  // Draws grids into the image, whose values it replaces: the same bits whenever it is called. Errors: Unsupported, if
  // the device fails (out of memory, lost, no answer), after which the next call starts anew; Cancelled.
  [[nodiscard]] virtual Result<DeviceWork> draw(const GridJob& job, Image& image, const Context& context) = 0;

  // Draws items into the image likewise.
  [[nodiscard]] virtual Result<DeviceWork> draw(const AdaptiveJob& job, Image& image, const Context& context) = 0;

  // Writes a picture to the target, on a device that was opened with a caller's handles: this one, or if it is null the
  // one that the last draw() kept. The target is good (check_target). Errors: as draw(); after one the target and its
  // semaphores are untouched, unless the device was lost or gave no answer.
  [[nodiscard]] virtual Result<DeviceWork> write(const VulkanTarget& target, const Image* image) = 0;

  // Traces one grid alone, for comparison with trace_packets(). Errors: as draw().
  [[nodiscard]] virtual Result<DeviceRays> trace(const DeviceGrid& grid) = 0;

  [[nodiscard]] virtual std::uint64_t memory_bytes() const = 0;  // held on the device

  // A further one on the same logical device, whose frames another thread draws at the same time; the bits of frames
  // are the same. The two share the queue and the pipelines, and no other memory. After a failure of either that is no
  // lack of memory, the next call of each starts anew. Thread-safety: any thread, also while this one draws. Errors:
  // Unsupported, if the device fails.
  [[nodiscard]] virtual Result<std::unique_ptr<FrameDevice>> another() const = 0;
};

// How a device is opened.
struct DeviceOptions {
  std::string which = {};  // index, or a part of the name; empty: CONTREJOUR_DEVICE, or else the first usable one
  std::optional<VulkanHandles> lent = std::nullopt;  // a caller's device, in place of one that is opened by name
  // Not empty: validation layers are on (not for a lent device), where they are installed, and each message is
  // reported, by each thread that draws.
  std::function<void(const std::string& message)> on_message = {};
  // Until a submission counts as hanging, times the number of devices that another() has made; 0: 10 s, on processors
  // acting as GPUs 300 s.
  double longest_wait_s = 0.0;
  std::uint64_t most_buffer_bytes = 0;  // a smaller limit than the device's for one buffer, for tests; 0: the device's
  int most_rows = 0;  // of a picture that are drawn at once, for tests; 0: as many as fit into the device's buffers
  int large_pixels = 0;  // from which on `bundle` and `tiled` draw by tile, for tests; 0: what suits the device
  bool draws_as_gpu = false;  // a processor, too, with the code for GPUs, for tests
  // Called before each submission with its number, by each thread that draws; an exception counts as the device's
  // failure. For tests.
  std::function<void(std::uint64_t submission)> before_submission = {};
};

// Both are implemented by the backend that the library was built with. Errors: Unsupported, if there is no such
// device or it is unusable, with the reason.
[[nodiscard]] std::vector<DeviceInfo> frame_devices();
[[nodiscard]] Result<std::unique_ptr<FrameDevice>> open_frame_device(const DeviceOptions& options);

}  // namespace contrejour::inline internal
