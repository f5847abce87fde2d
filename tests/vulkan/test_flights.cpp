// SPDX-License-Identifier: Apache-2.0
// Several frames in flight on one device: their bits, their failures, their memory.
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include "caller.h"
#include "contrejour/renderer.h"
#include "device_frames.h"

using namespace contrejour;
using test::frame_by, test::kTwoLights, test::lens_of, test::settings_of;

namespace {

struct FlightScene {
  MethodOptions method;
  LensState lens;
  std::vector<Light> lights;
  FrameSettings settings;
};

FlightScene flight_scene(const MethodOptions& method, const LensState& lens, std::size_t lights, bool has_starburst) {
  FrameSettings settings = settings_of(lens, 64, 36);
  settings.selection = SelectBrightest{3};
  settings.starburst.on = has_starburst;
  return {method, lens, {kTwoLights.begin(), kTwoLights.begin() + static_cast<std::ptrdiff_t>(lights)}, settings};
}

// Frames that differ in all that a device keeps: paths, patterns, starbursts, sizes of buffers.
std::vector<FlightScene> flight_scenes() {
  const LensState heliar = lens_of("heliar", 7, 8.0), tessar = lens_of("tessar", 6, 11.0);
  std::vector<FlightScene> scenes{flight_scene(AdaptiveOptions{}, heliar, 2, false),
                                  flight_scene(BundleOptions{.grid = {.rays = 24}}, tessar, 1, true),
                                  flight_scene(AdaptiveOptions{}, tessar, 1, true),
                                  flight_scene(TiledOptions{.grid = {.rays = 24}}, heliar, 2, false),
                                  flight_scene(AdaptiveOptions{}, lens_of("heliar", 7, 16.0), 1, false)};
  scenes.back().settings.ringing.mode = RingingMode::Fresnel;
  return scenes;
}

// Devices that draw at the same time, each with a cache and a thread of its own.
class Flights {
 public:
  explicit Flights(std::size_t count, DeviceOptions options = {}) {
    caches_.push_back(std::make_unique<RenderCache>());
    kept(0).device = test::open_device(std::move(options));
    kept(0).is_required = true;
    if (!kept(0).device) return;
    while (caches_.size() < count) {
      auto other = kept(0).device->another();
      REQUIRE_MESSAGE(other.has_value(), (other ? std::string() : other.error().message));
      caches_.push_back(std::make_unique<RenderCache>());
      kept(caches_.size() - 1).device = std::move(*other);
      kept(caches_.size() - 1).is_required = true;
    }
  }

  [[nodiscard]] bool is_there() { return kept(0).device != nullptr; }
  [[nodiscard]] KeptDevice& kept(std::size_t flight) { return *cache(flight).section<KeptDevice>({}); }
  [[nodiscard]] RenderCache& cache(std::size_t flight) { return *caches_[flight]; }
  [[nodiscard]] Result<Flare> draw(std::size_t flight, const FlightScene& scene) {
    cache(flight).next_frame();
    return render_frame(scene.method, {scene.lens, scene.lights, scene.settings, cache(flight)}, {});
  }

  // Calls a function for each flight, all at once.
  void run(const std::function<void(std::size_t flight)>& body) {
    std::vector<std::thread> threads;
    for (std::size_t k = 0; k < caches_.size(); ++k) threads.emplace_back(body, k);
    for (std::thread& thread : threads) thread.join();
  }

 private:
  std::vector<std::unique_ptr<RenderCache>> caches_;
};

// Each scene as a device draws it that draws nothing else.
std::vector<Pixels> alone(const std::vector<FlightScene>& scenes) {
  std::vector<Pixels> pixels;
  for (const FlightScene& scene : scenes) {
    Flights single(1);
    auto flare = single.draw(0, scene);
    REQUIRE_MESSAGE(flare.has_value(), (flare ? std::string() : flare.error().message));
    CHECK(flare->statistics.device == single.kept(0).device->info().name);
    pixels.push_back(std::move(flare->image.pixels));
  }
  return pixels;
}

// The end of a frame.
enum class Ending { Same, Different, Error };

Ending ending_of(const Result<Flare>& flare, const Pixels& wanted) {
  if (!flare) return Ending::Error;
  return flare->image.pixels == wanted ? Ending::Same : Ending::Different;
}

// Fails once, in whichever flight makes the submission with this number, counted over all.
struct Failing {
  std::atomic<int> left = -1;  // submissions until it fails; negative: never
  std::atomic<int> kind = 0;

  DeviceOptions options() {
    return {.before_submission = [this](std::uint64_t) {
      if (left < 0 || left-- != 0) return;
      if (kind == 0) test::lose_device();
      if (kind == 1) test::exhaust_device();
      test::hang_device();
    }};
  }
};

}  // namespace

TEST_CASE("frames in flight have the bits of frames that are drawn alone [slow]") {
  if (!Flights(1).is_there()) return;
  const std::vector<FlightScene> scenes = flight_scenes();
  const std::vector<Pixels> wanted = alone(scenes);
  for (const std::size_t count : {2U, 3U}) {
    Flights flights(count);
    std::vector<std::vector<Ending>> endings(count);
    flights.run([&](std::size_t flight) {
      for (std::size_t k = 0; k < 2 * scenes.size(); ++k) {
        const std::size_t scene = (k + 2 * flight) % scenes.size();
        endings[flight].push_back(ending_of(flights.draw(flight, scenes[scene]), wanted[scene]));
      }
    });
    for (const auto& of_flight : endings) CHECK(of_flight == std::vector<Ending>(2 * scenes.size(), Ending::Same));
  }
  test::check_no_messages();
}

TEST_CASE("a device that fails in one flight fails it alone or others too, and all draw their next frames [slow]") {
  Failing failing;
  Flights flights(2, failing.options());
  if (!flights.is_there()) return;
  const std::vector<FlightScene> scenes = flight_scenes();
  const std::vector<Pixels> wanted = alone(scenes);
  for (const int kind : {0, 1, 2}) {
    for (const int after : {0, 3}) {
      CAPTURE(kind);
      CAPTURE(after);
      failing.kind = kind;
      failing.left = after;
      std::array<std::vector<Ending>, 2> endings;
      flights.run([&](std::size_t flight) {
        for (const std::size_t scene : {flight, 2 * flight})
          endings[flight].push_back(ending_of(flights.draw(flight, scenes[scene]), wanted[scene]));
      });
      std::ptrdiff_t errors = 0;
      for (const auto& of_flight : endings) {
        CHECK(std::ranges::count(of_flight, Ending::Different) == 0);
        errors += std::ranges::count(of_flight, Ending::Error);
      }
      CHECK(errors == 1);  // as no device was lost in truth
      flights.run([&](std::size_t flight) {
        endings[flight] = {ending_of(flights.draw(flight, scenes[flight]), wanted[flight])};
      });
      for (const auto& of_flight : endings) CHECK(of_flight == std::vector<Ending>{Ending::Same});
    }
  }
  test::messages().clear();  // the layer may report what was left behind
}

TEST_CASE("if memory does not suffice for several flights, the error says how to have one") {
  Failing failing;
  Flights flights(2, failing.options());
  if (!flights.is_there()) return;
  failing.kind = 1;
  failing.left = 0;
  const auto failed = flights.draw(0, flight_scenes().front());
  REQUIRE(!failed.has_value());
  CHECK(failed.error().message.find("--frames-in-flight 1") != std::string::npos);
  test::check_no_messages();
}

TEST_CASE("a failed flight with auto is drawn by the CPU, and its sibling goes on") {
  Failing failing;
  Flights flights(2, failing.options());
  if (!flights.is_there()) return;
  const FlightScene scene = flight_scenes().front();
  flights.kept(1).is_required = false;
  failing.left = 0;
  const auto by_cpu = flights.draw(1, scene);
  REQUIRE(by_cpu.has_value());
  CHECK(by_cpu->statistics.device.starts_with("cpu ("));
  for (const std::size_t flight : {0U, 1U}) {
    const auto flare = flights.draw(flight, scene);
    REQUIRE(flare.has_value());
    CHECK(flare->statistics.device == flights.kept(flight).device->info().name);
  }
  test::check_no_messages();
}

TEST_CASE("the memory of flights stays as it is over many frames, and ends with them [slow]") {
  constexpr int kFirst = 6, kLast = 24;
  Flights flights(2);
  if (!flights.is_there()) return;
  const std::vector<FlightScene> scenes = flight_scenes();
  std::array<std::uint64_t, 2> first{}, last{};
  flights.run([&](std::size_t flight) {
    for (int k = 0; k < kLast; ++k) {
      static_cast<void>(flights.draw(flight, scenes[static_cast<std::size_t>(k) % scenes.size()]));
      (k < kFirst ? first : last)[flight] = flights.kept(flight).device->memory_bytes();
    }
  });
  CHECK(first == last);
  CHECK(first[0] == first[1]);
  for (int k = 0; k < 10; ++k) {
    const auto other = flights.kept(0).device->another();
    REQUIRE(other.has_value());
    CHECK((*other)->memory_bytes() == 0);
  }
  CHECK(flights.kept(0).device->memory_bytes() == first[0]);
  test::check_no_messages();
}

TEST_CASE("a renderer and another one draw at once, with the method, the lens and the device of the first") {
  auto first = Renderer::create(AdaptiveOptions{}, Device::Auto);
  REQUIRE(first.has_value());
  if (!first->has_device()) return;
  const FlightScene scene = flight_scenes().front();
  REQUIRE(first->set_lens(scene.lens).has_value());
  auto other = first->another();
  REQUIRE(other.has_value());
  CHECK(other->has_device());
  const std::array<Renderer*, 2> renderers{&*first, &*other};
  std::array<std::optional<Result<Flare>>, 2> flares;
  std::array<std::thread, 2> threads;
  for (std::size_t k = 0; k < 2; ++k)
    threads[k] = std::thread([&, k] { flares[k] = renderers[k]->render(scene.lights, scene.settings); });
  for (std::thread& thread : threads) thread.join();
  for (const auto& flare : flares) {
    REQUIRE(flare->has_value());
    CHECK((*flare)->statistics.device != "cpu");
    CHECK((*flare)->image.pixels == (*flares.front())->image.pixels);
  }
}

TEST_CASE("renderers on a lent device draw into images of it at once") {
  const auto caller = test::Caller::make();
  if (!caller) return;
  const FlightScene scene = flight_scenes()[2];
  auto first = Renderer::create(scene.method);
  REQUIRE(first.has_value());
  REQUIRE(first->set_lens(scene.lens).has_value());
  REQUIRE(first->set_vulkan_device(caller->handles()).has_value());
  auto other = first->another();
  REQUIRE(other.has_value());
  const std::array<Renderer*, 2> renderers{&*first, &*other};
  std::array<test::CallerImage, 2> images;
  for (test::CallerImage& image : images) {
    image = caller->image(kVulkanRgba32Float, 64, 36, 7.0F);
    image.image.layout_before = VK_IMAGE_LAYOUT_UNDEFINED;  // all is replaced, and each frame leaves another
  }
  std::array<int, 2> done{};
  std::array<std::thread, 2> threads;
  for (std::size_t k = 0; k < 2; ++k)
    threads[k] = std::thread([&, k] {
      for (int frame = 0; frame < 3; ++frame)
        if (renderers[k]->render_to_vulkan(scene.lights, scene.settings, {.to = images[k].image})) ++done[k];
    });
  for (std::thread& thread : threads) thread.join();
  CHECK(done == std::array<int, 2>{3, 3});
  CHECK(caller->bytes_of(images[0]) == caller->bytes_of(images[1]));
  test::check_no_messages();
}
