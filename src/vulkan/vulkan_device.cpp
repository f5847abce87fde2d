// SPDX-License-Identifier: Apache-2.0
// The backend: finds devices, and turns every failure of one into an error value.
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include "base/clock.h"
#include "render/device/device_frame.h"
#include "render/device/frame_device.h"
#include "vulkan/adaptive_frame.h"
#include "vulkan/device_context.h"
#include "vulkan/device_source.h"
#include "vulkan/grid_frame.h"
#include "vulkan/instance.h"
#include "vulkan/picture_writer.h"
#include "vulkan/starburst_stage.h"
#include "vulkan/stop_tables.h"

namespace contrejour::inline internal {
namespace vulkan {
namespace {

constexpr double kLongestWait_s = 10.0, kLongestWaitOfProcessor_s = 300.0;

// The options with their defaults for a device.
DeviceOptions completed(DeviceOptions options, const DeviceInfo& info) {
  if (!(options.longest_wait_s > 0.0))
    options.longest_wait_s = info.kind == "processor" ? kLongestWaitOfProcessor_s : kLongestWait_s;
  if (options.lent) options.lent->features = nullptr;  // which are the caller's only during its call
  return options;
}

class VulkanDevice final : public FrameDevice {
 public:
  VulkanDevice(std::shared_ptr<DeviceSource> source, DeviceInfo info, DeviceOptions options)
      : source_(std::move(source)), info_(std::move(info)), options_(std::move(options)) {
    if (options_.most_buffer_bytes > 0)
      info_.storage_range_bytes = std::min(info_.storage_range_bytes, options_.most_buffer_bytes);
  }
  ~VulkanDevice() override { drop_context(); }

  [[nodiscard]] const DeviceInfo& info() const override { return info_; }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return context_ ? context_->memory_bytes() : 0; }

  [[nodiscard]] Result<std::unique_ptr<FrameDevice>> another() const override {
    auto device = std::make_unique<VulkanDevice>(source_, info_, options_);
    if (const auto started = device->start(); !started) return tl::unexpected(started.error());
    return device;
  }

  // Makes the context now, so that a device that does not start is an error when it is opened.
  [[nodiscard]] Result<void> start() {
    return guarded([&] { static_cast<void>(context()); });
  }

  Result<DeviceWork> draw(const GridJob& job, Image& image, const Context& context) override {
    adaptive_.paths = nullptr;  // grids use the same buffers
    grids_.most_rows = options_.most_rows;
    grids_.large_pixels = options_.large_pixels;
    return run(job.grids.empty(), image, context, [&](DeviceContext& device) {
      StarburstStage starbursts(device, info_, job.starbursts, starbursts_);
      GridJob used = job;
      used.use = use_of(job.use, starbursts);
      GridFrame frame(device, info_, used, {}, grids_, stop_tables_, starbursts);
      return with(starbursts, used, frame, frame.draw(image, context));
    });
  }

  Result<DeviceWork> draw(const AdaptiveJob& job, Image& image, const Context& context) override {
    adaptive_.most_rows = options_.most_rows;
    return run(job.items.empty(), image, context,
               [&](DeviceContext& device) { return draw_groups(device, job, image, context); });
  }

  Result<DeviceWork> write(const VulkanTarget& target, const Image* image) override {
    if (!options_.lent) return invalid_argument("a Vulkan image or buffer is of no device that was lent");
    const auto from = Clock::now();
    DeviceWork work;
    const auto done = guarded([&] {
      // A picture that is kept is lost with its context, which is used for it even if another frame has failed.
      DeviceContext& device = image == nullptr && context_ ? *context_ : context();
      if (image != nullptr) picture_ = sent(device, *image);
      PictureWriter(device, info_, options_.most_rows, target).write(picture_);
      work.add_stages(device.stages_ms());
    });
    if (!done) return tl::unexpected(done.error());
    work.ms = ms_since(from);
    return work;
  }

  Result<DeviceRays> trace(const DeviceGrid& grid) override {
    DeviceRays out;
    adaptive_.paths = nullptr;
    const auto done = guarded([&] { out = trace_alone(context(), grid); });
    if (!done) return tl::unexpected(done.error());
    return out;
  }

 private:
  DeviceContext& context() {
    if (opened_ && opened_->has_failed()) drop_context();  // in another frame
    if (!opened_) opened_ = source_->device();
    if (!context_) context_ = std::make_unique<DeviceContext>(opened_, info_, options_);
    return *context_;
  }

  // Forgets all that is on the device. After a hang nothing of it may be freed, since it may still run.
  void drop_context() {
    adaptive_ = {};
    stop_tables_ = {};
    grids_ = {};
    starbursts_ = {};
    picture_ = {};
    if (opened_ && opened_->is_abandoned())
      static_cast<void>(context_.release());
    else
      context_ = nullptr;
    opened_ = nullptr;
  }

  // The others that share the device begin their next frames on a new one, too.
  void fail_device() {
    if (opened_) opened_->set_failed();
  }

  // A picture to which the CPU has to add starbursts is read.
  [[nodiscard]] static PictureUse use_of(PictureUse wanted, const StarburstStage& starbursts) {
    return wanted == PictureUse::Kept && !starbursts.has_all() ? PictureUse::Read : wanted;
  }

  // The work of a frame with that of its starbursts, and where its picture is.
  template <class Job, class DrawnFrame>
  [[nodiscard]] DeviceWork with(const StarburstStage& starbursts, const Job& job, const DrawnFrame& frame,
                                DeviceWork work) {
    work.starbursts = starbursts.added();
    work.bytes += starbursts.uploaded_bytes();
    work.is_kept = job.use == PictureUse::Kept;
    picture_ = {job.frame.width, job.frame.height, frame.keeps_bands() ? &context_->kept_rows() : nullptr};
    return work;
  }

  [[nodiscard]] DeviceWork draw_groups(DeviceContext& device, const AdaptiveJob& job, Image& image,
                                       const Context& context) {
    try {
      StarburstStage starbursts(device, info_, job.starbursts, starbursts_);
      AdaptiveJob used = job;
      used.use = use_of(job.use, starbursts);
      AdaptiveFrame frame(device, info_, used, adaptive_, stop_tables_, starbursts);
      return with(starbursts, used, frame, frame.draw(image, context));
    } catch (const TooManyRays&) {
      if (job.groups.size() < 2) throw;
    }
    return draw_halves(device, job, image, context);
  }

  // Draws the groups of a job in two halves, which are added on the host: each is within the job's error of its own
  // peak.
  [[nodiscard]] DeviceWork draw_halves(DeviceContext& device, const AdaptiveJob& job, Image& image,
                                       const Context& context) {
    const std::size_t half = job.groups.size() / 2;
    const std::uint32_t items = job.groups[half].first;
    AdaptiveJob first = job;
    first.use = PictureUse::Read;
    first.groups = job.groups.first(half);
    first.items = job.items.first(items);
    DeviceWork work = draw_groups(device, first, image, part_of(context, {0.0, 0.5}));
    if (context.cancelled()) return work;
    std::vector<DeviceGroup> groups(job.groups.begin() + static_cast<std::ptrdiff_t>(half), job.groups.end());
    for (DeviceGroup& group : groups) {
      group.first -= items;
      group.middle -= items;
    }
    AdaptiveJob second = first;
    second.groups = groups;
    second.items = job.items.subspan(items);
    second.starbursts = {};
    Image rest(image.width, image.height);
    work.add(draw_groups(device, second, rest, part_of(context, {0.5, 1.0})));
    for (std::size_t k = 0; k < image.pixels.size(); ++k) image.pixels[k] += rest.pixels[k];
    return work;
  }

  // Uploads a picture of the host.
  [[nodiscard]] static StoredPicture sent(DeviceContext& device, const Image& image) {
    device.need(device.sent_rows(), sizeof(float) * image.pixels.size());
    device.sent_rows().write(std::span<const float>(image.pixels));
    return {image.width, image.height, &device.sent_rows()};
  }

  // Draws an image, which is dark where there is nothing to draw, and measures the work.
  template <class Draw>
  [[nodiscard]] Result<DeviceWork> run(bool is_dark, Image& image, const Context& context, const Draw& draw) {
    const auto from = Clock::now();
    DeviceWork work;
    const auto done = guarded([&] {
      DeviceContext& device = this->context();
      const std::uint64_t invocations = device.invocations(), fetched_bytes = device.fetched_bytes();
      if (is_dark) {
        std::ranges::fill(image.pixels, 0.0F);
        return;
      }
      work = draw(device);
      work.invocations = device.invocations() - invocations;
      work.bytes += device.fetched_bytes() - fetched_bytes;
    });
    if (!done) return tl::unexpected(done.error());
    if (context.cancelled()) return failure(ErrorCode::Cancelled, "cancelled");
    work.ms = ms_since(from);
    return work;
  }

  [[nodiscard]] DeviceRays trace_alone(DeviceContext& device, const DeviceGrid& grid) const;

  // Calls a function that may fail. After a failure the next call begins with a new context; and with a new device,
  // unless only memory was short, which is the context's.
  template <class Work>
  [[nodiscard]] Result<void> guarded(const Work& work) {
    std::string message, instead = "--device cpu";
    try {
      work();
      return {};
    } catch (const Hang& hang) {
      message = hang.what();
      source_->abandon(opened_);
    } catch (const vk::OutOfDeviceMemoryError& error) {
      message = fmt::format("its memory does not suffice ({})", error.what());
      if (opened_ && opened_->contexts() > 1) instead = "--frames-in-flight 1, or --device cpu";
    } catch (const vk::DeviceLostError& error) {
      message = fmt::format("it was lost ({})", error.what());
      fail_device();
    } catch (const std::exception& error) {
      message = error.what();
      fail_device();
    }
    drop_context();
    if (options_.lent)
      return failure(ErrorCode::Unsupported, fmt::format("the lent device ({}) failed: {}", info_.name, message));
    return failure(ErrorCode::Unsupported,
                   fmt::format("device {} ({}) failed: {}; render with {}", info_.index, info_.name, message, instead));
  }

  std::shared_ptr<DeviceSource> source_;
  DeviceInfo info_;
  DeviceOptions options_;
  std::shared_ptr<OpenedDevice> opened_;  // null: the next call asks for it
  std::unique_ptr<DeviceContext> context_;
  AdaptiveKept adaptive_;
  GridKept grids_;
  StopTables stop_tables_;
  StarburstKept starbursts_;
  StoredPicture picture_;  // that the last draw kept
};

DeviceRays VulkanDevice::trace_alone(DeviceContext& device, const DeviceGrid& grid) const {
  PathData data;
  Parameters p;
  const PathPlace place = data.add(grid, {{}, {1.0, 1.0}}, p);
  p.side = static_cast<std::uint32_t>(grid.side);
  p.flags = kCircle;
  p.triangle_weight = 1.0F;
  upload_paths(device, data);
  const std::uint64_t count = ray_count(grid);
  device.need(Slot::Rays, kRayBytes * count);
  device.need(Slot::Crossings, kCrossingBytes * count);
  device.need(Slot::Vertices, kVertexBytes * count);
  device.need_fetched((kRayBytes + kCrossingBytes) * count);
  device.begin();
  dispatch_trace(device, info_, grid, place, p);
  device.barrier();
  device.fetch(Slot::Rays, kRayBytes * count);
  device.fetch(Slot::Crossings, kCrossingBytes * count, kRayBytes * count);
  device.finish();
  const auto* const rays = device.read<float>();
  const auto* const crossings = device.read<float>(kRayBytes * count);
  DeviceRays out;
  for (std::size_t k = 0; k < count; ++k) {
    const float height = rays[4 * k + 3];
    out.sensor_x_mm.push_back(rays[4 * k]);
    out.sensor_y_mm.push_back(rays[4 * k + 1]);
    out.transmission.push_back(rays[4 * k + 2]);
    out.relative_height.push_back(height >= 0.5F * kFailedHeight ? kFailed : height);
    for (std::size_t c = 0; c < static_cast<std::size_t>(grid.path.stop_crossings()); ++c) {
      out.stop_x[c].push_back(crossings[2 * (kMaxStopCrossings * k + c)]);
      out.stop_y[c].push_back(crossings[2 * (kMaxStopCrossings * k + c) + 1]);
    }
  }
  return out;
}

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool is_index(const std::string& text) {
  return !text.empty() && text.size() < 4 &&
         std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c) != 0; });
}

std::string names_of(const std::vector<DeviceInfo>& all) {
  std::string names;
  for (const DeviceInfo& info : all)
    names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", info.index, info.name);
  return names;
}

// The device that was asked for, or else the first usable one, GPUs before processors.
Result<DeviceInfo> chosen(const std::vector<DeviceInfo>& all, const std::string& which) {
  if (all.empty()) return failure(ErrorCode::Unsupported, "Vulkan lists no device: install a driver for the GPU");
  if (which.empty()) {
    const auto rank = [](const DeviceInfo& info) {
      return !info.is_usable                 ? 9
             : info.kind == "discrete GPU"   ? 0
             : info.kind == "integrated GPU" ? 1
             : info.kind == "processor"      ? 3
                                             : 2;
    };
    const DeviceInfo& best = *std::ranges::min_element(all, {}, rank);
    if (best.is_usable) return best;
    return failure(ErrorCode::Unsupported, fmt::format("no device is usable: {}: {}", best.name, best.reason));
  }
  const auto matches = [&](const DeviceInfo& info) {
    return is_index(which) ? info.index == std::stoi(which) : lower(info.name).find(lower(which)) != std::string::npos;
  };
  const auto found = std::ranges::find_if(all, matches);
  if (found == all.end())
    return failure(ErrorCode::Unsupported,
                   fmt::format("there is no device '{}'; choose one of {}", which, names_of(all)));
  if (!found->is_usable)
    return failure(ErrorCode::Unsupported, fmt::format("device {} is unusable: {}", found->name, found->reason));
  return *found;
}

Result<void> check_lent(const VulkanHandles& handles) {
  const std::vector<std::string> missing = missing_for_vulkan(handles);
  if (missing.empty()) return {};
  return failure(ErrorCode::Unsupported,
                 fmt::format("the Vulkan device that was lent lacks {}", fmt::join(missing, "; ")));
}

}  // namespace
}  // namespace vulkan

std::vector<DeviceInfo> frame_devices() {
  const auto instance = vulkan::Instance::open({});
  if (!instance) return {};
  try {
    return (*instance)->devices();
  } catch (const std::exception&) {
    return {};  // a driver that fails to describe its devices offers none
  }
}

Result<std::unique_ptr<FrameDevice>> open_frame_device(const DeviceOptions& options) {
  if (options.lent)
    if (const auto good = vulkan::check_lent(*options.lent); !good) return tl::unexpected(good.error());
  auto instance = vulkan::open_instance(options);
  if (!instance) return tl::unexpected(instance.error());
  std::vector<DeviceInfo> all;
  try {
    all = (*instance)->devices();
  } catch (const std::exception& error) {
    return failure(ErrorCode::Unsupported,
                   fmt::format("the Vulkan driver fails to describe its devices: {}", error.what()));
  }
  const char* const wanted = options.lent ? nullptr : std::getenv("CONTREJOUR_DEVICE");
  const auto info = vulkan::chosen(all, !options.which.empty() ? options.which : wanted != nullptr ? wanted : "");
  if (!info) return tl::unexpected(info.error());
  const DeviceOptions used = vulkan::completed(options, *info);
  auto source = std::make_shared<vulkan::DeviceSource>(std::move(*instance), *info, used);
  auto device = std::make_unique<vulkan::VulkanDevice>(std::move(source), *info, used);
  if (const auto started = device->start(); !started) return tl::unexpected(started.error());
  return device;
}

}  // namespace contrejour::inline internal
