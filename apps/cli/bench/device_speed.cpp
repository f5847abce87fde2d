// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/device_speed.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <thread>
#include <utility>

#include "cli/bench/scene.h"
#include "contrejour/expert/metrics.h"
#include "contrejour/expert/settings.h"
#include "contrejour/renderer.h"

namespace contrejour::cli {
namespace {

constexpr double kStep = 1e-5;           // of a light's direction from frame to frame, less than a pixel
constexpr double kFineError = 1e-4;      // of what the first frame is compared with
constexpr double kWarm_ms = 1500.0;  // of frames that do not count: clocks rise, buffers grow
constexpr std::size_t kMostInFlight = 3;  // frames at once
constexpr int kWarmFrames = 4;           // of each further renderer that do not count
constexpr std::string_view kDevicePhase = "device: ", kCopyPhase = "device: fetch";

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

std::vector<Light> moved(std::vector<Light> lights, std::size_t frame) {
  for (Light& light : lights) {
    light.direction.x += kStep * static_cast<double>(frame);
    light.direction = normalized(light.direction);
  }
  return lights;
}

// The times of the frames so far.
class Times {
 public:
  void add(const RenderStatistics& frame, double elapsed_ms) {
    frame_ms_.push_back(elapsed_ms);
    double device_ms = 0.0;
    for (const auto& [phase, ms] : frame.time_ms) {
      if (!phase.starts_with(kDevicePhase)) continue;
      by_stage_[phase].push_back(ms);
      if (phase != kCopyPhase) device_ms += ms;
    }
    device_ms_.push_back(device_ms);
  }

  [[nodiscard]] std::size_t count() const { return frame_ms_.size(); }
  void report(DeviceSpeed& to) const {
    to.frames = static_cast<int>(frame_ms_.size());
    to.frame_ms = median(frame_ms_);
    to.device_ms = median(device_ms_);
    for (const auto& [phase, ms] : to.last.time_ms)
      if (const auto stage = by_stage_.find(phase); stage != by_stage_.end())
        to.stages_ms.emplace_back(phase.substr(kDevicePhase.size()), median(stage->second));
  }

 private:
  std::vector<double> frame_ms_, device_ms_;
  std::map<std::string, std::vector<double>> by_stage_;
};

// Draws frames by all renderers at once. Returns how many there were in a second.
Result<double> frames_a_second(std::vector<Renderer>& renderers, const BenchScene& scene, int frames,
                               const Context& context) {
  std::atomic<int> next = 0;
  std::vector<Result<void>> ends(renderers.size());
  const auto draw = [&](std::size_t k) {
    for (int frame = next++; frame < frames && ends[k]; frame = next++) {
      const FrameTarget target{.pixels = {}, .draft_is_ready = {}, .is_discarded = true};
      const auto lights = moved(scene.lights, static_cast<std::size_t>(frame));
      if (auto drawn = renderers[k].render(lights, scene.settings, target, context); !drawn)
        ends[k] = tl::unexpected(drawn.error());
    }
  };
  const auto start = std::chrono::steady_clock::now();
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < renderers.size(); ++k) threads.emplace_back(draw, k);
  for (std::thread& thread : threads) thread.join();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  for (const Result<void>& end : ends)
    if (!end) return tl::unexpected(end.error());
  return frames / elapsed.count();
}

// The same for one renderer and more.
Result<std::vector<double>> speeds_in_flight(Renderer first, const BenchScene& scene, int frames,
                                             const Context& context) {
  std::vector<Renderer> renderers;
  renderers.push_back(std::move(first));
  std::vector<double> speeds;
  while (true) {
    const int warm = kWarmFrames * static_cast<int>(renderers.size());
    if (auto warmed = frames_a_second(renderers, scene, warm, context); !warmed) return tl::unexpected(warmed.error());
    const auto speed = frames_a_second(renderers, scene, frames, context);
    if (!speed) return tl::unexpected(speed.error());
    speeds.push_back(*speed);
    if (speeds.size() == kMostInFlight) return speeds;
    auto other = renderers.front().another();
    if (!other) return tl::unexpected(other.error());
    renderers.push_back(std::move(*other));
  }
}

Result<std::optional<double>> compared(const BenchScene& scene, const Image& first, const Context& context) {
  auto exact = Renderer::create(AdaptiveOptions{kFineError});
  if (!exact) return tl::unexpected(exact.error());
  if (const auto set = exact->set_lens(scene.lens); !set) return tl::unexpected(set.error());
  const auto flare = exact->render(scene.lights, scene.settings, context);
  if (!flare) return tl::unexpected(flare.error());
  const auto difference = compare(flare->image, first);
  if (!difference) return tl::unexpected(difference.error());
  return difference->psnr_db;
}

}  // namespace

Result<DeviceSpeed> measure_device(const PaperSystem& system, const DeviceRun& run, const params::Values& values,
                                   const Context& context) {
  const auto scene = bench_scene(system, run.lights, {}, values);
  if (!scene) return tl::unexpected(scene.error());
  const auto options = params::method_options(values, run.method);
  if (!options) return tl::unexpected(options.error());
  auto renderer = Renderer::create(*options, Device::Vulkan);
  if (!renderer) return tl::unexpected(renderer.error());
  if (const auto set = renderer->set_lens(scene->lens); !set) return tl::unexpected(set.error());
  DeviceSpeed speed;
  speed.system = system.name;
  speed.f_number = system.f_number;
  speed.lights = run.lights;
  if (static_cast<std::size_t>(run.lights) <= system.by_lights.size())
    speed.paper_ms = system.by_lights[static_cast<std::size_t>(run.lights - 1)].tiled_total_ms;
  Image picture(scene->settings.frame.width, scene->settings.frame.height);
  Times times;
  const auto begin = std::chrono::steady_clock::now();
  for (std::size_t frame = 0; times.count() < static_cast<std::size_t>(run.frames); ++frame) {
    const std::vector<Light> lights = moved(scene->lights, frame);
    const auto start = std::chrono::steady_clock::now();
    const FrameTarget target{.pixels = view_of(picture), .draft_is_ready = {}, .is_discarded = frame > 0};
    auto statistics = renderer->render(lights, scene->settings, target, context);
    if (!statistics) return tl::unexpected(statistics.error());
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
    if (frame == 0 && run.compares) {
      const auto psnr_db = compared(*scene, picture, context);
      if (!psnr_db) return tl::unexpected(psnr_db.error());
      speed.psnr_db = *psnr_db;
    }
    const std::chrono::duration<double, std::milli> since_begin = std::chrono::steady_clock::now() - begin;
    if (since_begin.count() > kWarm_ms) times.add(*statistics, elapsed.count());
    speed.last = std::move(*statistics);
  }
  times.report(speed);
  auto in_flight = speeds_in_flight(std::move(*renderer), *scene, run.frames, context);
  if (!in_flight) return tl::unexpected(in_flight.error());
  speed.frames_a_second = std::move(*in_flight);
  return speed;
}

}  // namespace contrejour::cli
