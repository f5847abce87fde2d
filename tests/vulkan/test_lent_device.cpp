// SPDX-License-Identifier: Apache-2.0
// Frames that are drawn on a device of the caller, into its images and buffers, against the same frames read.
#include <bit>
#include <cstring>
#include <functional>
#include <limits>

#include "caller.h"
#include "contrejour/renderer.h"
#include "device_frames.h"
#include "vulkan/shader.h"

using namespace contrejour;
using test::Caller, test::CallerBuffer, test::CallerImage, test::kTwoLights, test::lens_of, test::settings_of;

namespace {

constexpr int kWidth = 48, kHeight = 27;
constexpr float kLargestHalf = 65504.0F;

std::vector<MethodOptions> methods_on_device() {
  BundleOptions bundle;
  bundle.grid.rays = 24;
  TiledOptions tiled;
  tiled.grid.rays = 24;
  return {AdaptiveOptions{}, bundle, tiled};
}

FrameSettings lent_settings(const LensState& lens) {
  FrameSettings settings = settings_of(lens, kWidth, kHeight);
  settings.selection = SelectBrightest{6};
  return settings;
}

std::unique_ptr<Caller> make_caller() {
  auto caller = Caller::make();
  if (!caller) MESSAGE("skipped, as no device is usable");
  return caller;
}

Renderer renderer_on(const Caller& caller, const LensState& lens, const MethodOptions& method = AdaptiveOptions{}) {
  auto renderer = Renderer::create(method);
  REQUIRE(renderer.has_value());
  REQUIRE(renderer->set_lens(lens).has_value());
  const auto set = renderer->set_vulkan_device(caller.handles());
  REQUIRE_MESSAGE(set.has_value(), (set ? std::string() : set.error().message));
  return std::move(*renderer);
}

void check_done(const Result<RenderStatistics>& done) {
  REQUIRE_MESSAGE(done.has_value(), (done ? std::string() : done.error().message));
}

float float_at(const std::byte* from) {
  float value = 0.0F;
  std::memcpy(&value, from, sizeof value);
  return value;
}

float half_at(const std::byte* from) {
  std::uint16_t bits = 0;
  std::memcpy(&bits, from, sizeof bits);
  const int exponent = (bits >> 10U) & 31U, fraction = bits & 1023U;
  if (exponent == 31) return std::numeric_limits<float>::infinity();  // or no number
  const float size = exponent == 0 ? std::ldexp(static_cast<float>(fraction), -24)
                                   : std::ldexp(static_cast<float>(1024 + fraction), exponent - 25);
  return (bits & 0x8000U) != 0 ? -size : size;
}

// Whether a number of a picture is written as another: half floats are rounded, in either direction, and clipped.
bool is_written_as(float value, float written, std::uint32_t format) {
  if (format == kVulkanRgba32Float) return std::bit_cast<std::uint32_t>(value) == std::bit_cast<std::uint32_t>(written);
  const float nearest = std::clamp(value, -kLargestHalf, kLargestHalf);
  return std::abs(nearest - written) <= 0x1p-10F * std::abs(nearest) + 0x1p-24F;
}

// The pixels of a picture that are not written so into a picture of this width, from a pixel on.
int wrong_pixels(const Image& wanted, const std::byte* written, std::uint32_t format, int width, int left, int top) {
  const std::size_t size = format == kVulkanRgba16Float ? 2 : 4;
  int wrong = 0;
  for (int y = 0; y < wanted.height; ++y)
    for (int x = 0; x < wanted.width; ++x) {
      const std::byte* const pixel = written + 4 * size * static_cast<std::size_t>((top + y) * width + left + x);
      const auto number = [&](int c) {
        const std::byte* const at = pixel + size * static_cast<std::size_t>(c);
        return size == 2 ? half_at(at) : float_at(at);
      };
      bool is_right = number(3) == 0.0F;
      for (int c = 0; c < 3; ++c) is_right = is_right && is_written_as(wanted.at(x, y, c), number(c), format);
      wrong += is_right ? 0 : 1;
    }
  return wrong;
}

float brightest(const Image& image) { return *std::ranges::max_element(image.pixels); }

std::vector<std::uint32_t> capabilities_of(vulkan::Shader shader) {
  constexpr std::size_t kHeaderWords = 5;
  constexpr std::uint32_t kOpCapability = 17;  // SPIR-V 1.6, 3.52.1
  std::vector<std::uint32_t> all;
  const auto code = vulkan::code_of(shader);
  for (std::size_t at = kHeaderWords; at < code.size(); at += code[at] >> 16U)
    if ((code[at] & 0xffffU) == kOpCapability) all.push_back(code[at + 1]);
  return all;
}

}  // namespace

TEST_CASE("a frame in a caller's image has the bits of one that is read, and the pixels around it are left [slow]") {
  const auto caller = make_caller();
  if (!caller) return;
  const LensState lens = lens_of("heliar", 5, 8.0);
  FrameSettings settings = lent_settings(lens);
  for (const bool has_starburst : {false, true}) {
    settings.starburst.on = has_starburst;
    for (const MethodOptions& method : methods_on_device()) {
      INFO(method.name());
      Renderer renderer = renderer_on(*caller, lens, method);
      const auto wanted = renderer.render(kTwoLights, settings);
      REQUIRE(wanted.has_value());
      REQUIRE(brightest(wanted->image) > 0.0F);
      for (const std::uint32_t format : {kVulkanRgba32Float, kVulkanRgba16Float}) {
        CallerImage image = caller->image(format, kWidth + 5, kHeight + 4, 7.0F);
        image.image.left = 3;
        image.image.top = 2;
        const auto done = renderer.render_to_vulkan(kTwoLights, settings, {.to = image.image});
        check_done(done);
        CHECK(done->device == wanted->statistics.device);
        const auto bytes = caller->bytes_of(image);
        CHECK(wrong_pixels(wanted->image, bytes.data(), format, kWidth + 5, 3, 2) == 0);
        const std::size_t size = format == kVulkanRgba16Float ? 2 : 4;
        int left_as_they_were = 0;
        for (std::size_t at = 0; at < bytes.size(); at += size)
          left_as_they_were += (size == 2 ? half_at(&bytes[at]) : float_at(&bytes[at])) == 7.0F ? 1 : 0;
        CHECK(left_as_they_were == 4 * ((kWidth + 5) * (kHeight + 4) - kWidth * kHeight));
      }
    }
  }
  test::check_no_messages();
}

TEST_CASE("a frame in a caller's buffer has the bits of one that is read, and the bytes around it are left") {
  const auto caller = make_caller();
  if (!caller) return;
  const LensState lens = lens_of("tessar", 6, 8.0);
  const FrameSettings settings = lent_settings(lens);
  Renderer renderer = renderer_on(*caller, lens);
  const auto wanted = renderer.render(kTwoLights, settings);
  REQUIRE(wanted.has_value());
  for (const std::uint32_t format : {kVulkanRgba32Float, kVulkanRgba16Float}) {
    const std::size_t before = 20, after = 12, pixels = (format == kVulkanRgba16Float ? 8U : 16U) * kWidth * kHeight;
    CallerBuffer buffer = caller->buffer(format, before + pixels + after, 0xA5);
    buffer.buffer.offset_bytes = before;
    check_done(renderer.render_to_vulkan(kTwoLights, settings, {.to = buffer.buffer}));
    const std::byte* const bytes = buffer.memory.mapped;
    CHECK(wrong_pixels(wanted->image, bytes + before, format, kWidth, 0, 0) == 0);
    CHECK(std::all_of(bytes, bytes + before, [](std::byte b) { return b == std::byte{0xA5}; }));
    CHECK(std::all_of(bytes + before + pixels, bytes + before + pixels + after,
                      [](std::byte b) { return b == std::byte{0xA5}; }));
  }
  test::check_no_messages();
}

TEST_CASE("half floats of a bright flare are clipped") {
  const auto caller = make_caller();
  if (!caller) return;
  const LensState lens = lens_of("tessar", 6, 8.0);
  const FrameSettings settings = lent_settings(lens);
  const std::vector<Light> bright{{.direction = kTwoLights.front().direction, .value = {1e12, 1e11, 1e10}}};
  Renderer renderer = renderer_on(*caller, lens);
  const auto wanted = renderer.render(bright, settings);
  REQUIRE(wanted.has_value());
  REQUIRE(brightest(wanted->image) > kLargestHalf);
  const CallerBuffer buffer = caller->buffer(kVulkanRgba16Float, std::uint64_t{8} * kWidth * kHeight, 0);
  check_done(renderer.render_to_vulkan(bright, settings, {.to = buffer.buffer}));
  CHECK(wrong_pixels(wanted->image, buffer.memory.mapped, kVulkanRgba16Float, kWidth, 0, 0) == 0);
  test::check_no_messages();
}

TEST_CASE("frames in bands of rows stay on the device until they are written as a whole") {
  const auto caller = make_caller();
  if (!caller) return;
  const LensState lens = lens_of("heliar", 5, 8.0);
  FrameSettings settings = lent_settings(lens);
  settings.starburst.on = true;
  RenderCache cache;
  KeptDevice& kept = *cache.section<KeptDevice>({});
  int submissions = 0;
  kept.device = *open_frame_device(
      {.lent = caller->handles(), .most_rows = 7, .before_submission = [&](std::uint64_t) { ++submissions; }});
  kept.is_required = true;
  for (const MethodOptions& method : methods_on_device()) {
    INFO(method.name());
    const Flare wanted = test::frame_by(method, lens, kTwoLights, settings, cache);
    const CallerImage image = caller->image(kVulkanRgba32Float, kWidth, kHeight, 7.0F);
    submissions = 0;
    check_done(render_frame_to(method, {lens, kTwoLights, settings, cache}, {.to = image.image}, {}));
    CHECK(kept.has_kept_picture);
    CHECK(submissions >= 5);  // four bands, and what writes them
    const auto bytes = caller->bytes_of(image);
    CHECK(wrong_pixels(wanted.image, bytes.data(), kVulkanRgba32Float, kWidth, 0, 0) == 0);
  }
  test::check_no_messages();
}

TEST_CASE("what the device does not draw whole is uploaded to the caller's image [slow]") {
  const auto caller = make_caller();
  if (!caller) return;
  const LensState lens = lens_of("heliar", 5, 8.0);
  const auto check_uploaded = [&](const MethodOptions& method, const FrameSettings& settings,
                                  std::span<const Light> lights, DeviceOptions options) {
    RenderCache cache;
    KeptDevice& kept = *cache.section<KeptDevice>({});
    options.lent = caller->handles();
    kept.device = *open_frame_device(options);
    const Flare wanted = test::frame_by(method, lens, lights, settings, cache);
    const CallerImage image = caller->image(kVulkanRgba32Float, kWidth, kHeight, 7.0F);
    const auto done = render_frame_to(method, {lens, lights, settings, cache}, {.to = image.image}, {});
    check_done(done);
    CHECK_FALSE(kept.has_kept_picture);
    CHECK(done->device == wanted.statistics.device);
    const auto bytes = caller->bytes_of(image);
    CHECK(wrong_pixels(wanted.image, bytes.data(), kVulkanRgba32Float, kWidth, 0, 0) == 0);
  };
  const FrameSettings plain = lent_settings(lens);
  FrameSettings glare = plain, starburst = plain;
  glare.glare.fraction = 0.02;
  starburst.starburst.on = true;
  std::vector<Light> area = kTwoLights;
  area.back().radius_rad = 0.01;
  const ReferenceOptions reference;
  FrameSettings few = plain;
  few.selection = SelectBrightest{1};
  few.wavelengths = 1;
  check_uploaded(reference, few, std::span(kTwoLights).first(1), {.most_rows = 7});
  check_uploaded(AdaptiveOptions{}, glare, kTwoLights, {});
  check_uploaded(AdaptiveOptions{}, few, area, {});
  check_uploaded(AdaptiveOptions{}, starburst, kTwoLights, {.most_buffer_bytes = 1U << 21U});  // patterns do not fit
  check_uploaded(AdaptiveOptions{}, plain, {}, {});
  test::check_no_messages();
}

TEST_CASE("a frame waits for a semaphore and signals one") {
  const auto caller = make_caller();
  if (!caller) return;
  const LensState lens = lens_of("heliar", 5, 8.0);
  const FrameSettings settings = lent_settings(lens);
  Renderer renderer = renderer_on(*caller, lens);
  const CallerImage image = caller->image(kVulkanRgba32Float, kWidth, kHeight, 7.0F);
  const vk::SemaphoreTypeCreateInfo timeline_type(vk::SemaphoreType::eTimeline, 3);
  const vk::raii::Semaphore timeline(caller->device(), vk::SemaphoreCreateInfo({}, &timeline_type));
  const vk::raii::Semaphore binary(caller->device(), vk::SemaphoreCreateInfo());
  VulkanTarget target{.to = image.image, .wait = {*timeline, 3}, .signal = {*timeline, 4}};
  check_done(renderer.render_to_vulkan(kTwoLights, settings, target));
  CHECK(timeline.getCounterValue() == 4);
  std::get<VulkanImage>(target.to).layout_before = image.image.layout_after;
  target.wait = {*timeline, 4};
  target.signal = {*binary};
  check_done(renderer.render_to_vulkan(kTwoLights, settings, target));
  caller->wait_on_queue(*binary);

  // An error touches neither the semaphores nor the image's layout.
  target.wait = {*timeline, 4};
  target.signal = {*timeline, 5};
  auto lenses = settings;
  lenses.frame.width = kWidth + 1;
  CHECK_FALSE(renderer.render_to_vulkan(kTwoLights, lenses, target).has_value());
  CHECK(timeline.getCounterValue() == 4);
  check_done(renderer.render_to_vulkan(kTwoLights, settings, target));
  CHECK(timeline.getCounterValue() == 5);
  test::check_no_messages();
}

TEST_CASE("the caller's device works on after the renderer, and after failures of its frames") {
  const auto caller = make_caller();
  if (!caller) return;
  const LensState lens = lens_of("heliar", 5, 8.0);
  const FrameSettings settings = lent_settings(lens);
  const CallerImage image = caller->image(kVulkanRgba32Float, kWidth, kHeight, 7.0F);
  std::vector<std::byte> once;
  {
    Renderer renderer = renderer_on(*caller, lens);
    check_done(renderer.render_to_vulkan(kTwoLights, settings, {.to = image.image}));
    once = caller->bytes_of(image);
    CHECK(renderer.set_device(Device::Cpu).has_value());
    CHECK_FALSE(renderer.render_to_vulkan(kTwoLights, settings, {.to = image.image}).has_value());
  }
  CHECK(caller->bytes_of(image) == once);

  RenderCache cache;
  KeptDevice& kept = *cache.section<KeptDevice>({});
  bool fails = false;
  kept.device = *open_frame_device({.lent = caller->handles(), .before_submission = [&](std::uint64_t) {
                                      if (fails) test::lose_device();
                                    }});
  kept.is_required = true;
  VulkanImage again = image.image;
  again.layout_before = VK_IMAGE_LAYOUT_UNDEFINED;
  const FrameRequest frame{lens, kTwoLights, settings, cache};
  fails = true;
  CHECK_FALSE(render_frame_to(AdaptiveOptions{}, frame, {.to = again}, {}).has_value());
  CHECK(caller->bytes_of(image) == once);  // in its layout
  fails = false;
  check_done(render_frame_to(AdaptiveOptions{}, frame, {.to = again}, {}));
  CHECK(caller->bytes_of(image) == once);
  test::check_no_messages();
}

TEST_CASE("a semaphore that nobody signals is an error, and the next frame is drawn") {
  auto caller = make_caller();
  if (!caller) return;
  const LensState lens = lens_of("heliar", 5, 8.0);
  const FrameSettings settings = lent_settings(lens);
  {
    RenderCache cache;
    KeptDevice& kept = *cache.section<KeptDevice>({});
    kept.device = *open_frame_device({.lent = caller->handles(), .longest_wait_s = 0.5});
    const CallerImage image = caller->image(kVulkanRgba32Float, kWidth, kHeight, 7.0F);
    const vk::SemaphoreTypeCreateInfo timeline(vk::SemaphoreType::eTimeline, 0);
    const vk::raii::Semaphore never(caller->device(), vk::SemaphoreCreateInfo({}, &timeline));
    const FrameRequest dark{lens, {}, settings, cache};
    const VulkanTarget target{.to = image.image, .wait = {*never, 1}};
    const auto done = render_frame_to(AdaptiveOptions{}, dark, target, {});
    REQUIRE_FALSE(done.has_value());
    CHECK(done.error().message.find("no answer") != std::string::npos);
    caller->device().signalSemaphore(vk::SemaphoreSignalInfo(*never, 1));
    caller->device().waitIdle();
    check_done(render_frame_to(AdaptiveOptions{}, dark, {.to = image.image}, {}));
  }
  test::messages().clear();  // what was abandoned is not destroyed before the device, which the layer reports
  caller.reset();
  test::messages().clear();
}

TEST_CASE("a device that lacks something is refused with its name") {
  const auto caller = make_caller();
  if (!caller) return;
  CHECK(missing_for_vulkan(caller->handles()).empty());
  const auto is_refused = [&](const char* name, const std::function<void(VulkanHandles&)>& change) {
    VulkanHandles handles = caller->handles();
    change(handles);
    const auto missing = missing_for_vulkan(handles);
    REQUIRE(missing.size() == 1);
    CHECK_MESSAGE(missing.front().starts_with(name), missing.front());
    auto renderer = Renderer::create();
    REQUIRE(renderer.has_value());
    const auto set = renderer->set_vulkan_device(handles);
    REQUIRE_FALSE(set.has_value());
    CHECK(set.error().code == ErrorCode::Unsupported);
    CHECK(set.error().message.find(missing.front()) != std::string::npos);
  };
  is_refused("shaderFloat64", [](VulkanHandles& h) { h.features = nullptr; });
  is_refused("apiVersion", [](VulkanHandles& h) { h.api_version = VK_API_VERSION_1_2; });
  is_refused("queue_family", [](VulkanHandles& h) { h.queue_family = 99; });
  is_refused("get_instance_proc_addr", [](VulkanHandles& h) { h.get_instance_proc_addr = nullptr; });
  is_refused("instance", [](VulkanHandles& h) { h.instance = nullptr; });
  is_refused("physical_device", [](VulkanHandles& h) { h.physical_device = nullptr; });
  is_refused("device", [](VulkanHandles& h) { h.device = nullptr; });
  is_refused("queue", [](VulkanHandles& h) { h.queue = nullptr; });
  const auto without_doubles = Caller::make(false);
  REQUIRE(without_doubles);
  const auto missing = missing_for_vulkan(without_doubles->handles());
  REQUIRE(missing.size() == 1);
  CHECK(missing.front().starts_with("shaderFloat64"));
  const auto stranger = Caller::make();
  is_refused("physical_device", [&](VulkanHandles& h) { h.physical_device = stranger->handles().physical_device; });
  test::check_no_messages();
}

TEST_CASE("targets that do not suit a frame are refused before anything is drawn") {
  const auto caller = make_caller();
  if (!caller) return;
  const LensState lens = lens_of("heliar", 5, 8.0);
  const FrameSettings settings = lent_settings(lens);
  Renderer renderer = renderer_on(*caller, lens);
  const CallerImage image = caller->image(kVulkanRgba32Float, kWidth, kHeight, 7.0F);
  const CallerBuffer buffer = caller->buffer(kVulkanRgba32Float, std::uint64_t{16} * kWidth * kHeight, 7);
  const auto is_refused = [&](const VulkanTarget& target) {
    const auto done = renderer.render_to_vulkan(kTwoLights, settings, target);
    return !done && done.error().code == ErrorCode::InvalidArgument;
  };
  const auto image_with = [&](const std::function<void(VulkanImage&)>& change) {
    VulkanImage changed = image.image;
    change(changed);
    return VulkanTarget{.to = changed};
  };
  const auto buffer_with = [&](const std::function<void(VulkanBuffer&)>& change) {
    VulkanBuffer changed = buffer.buffer;
    change(changed);
    return VulkanTarget{.to = changed};
  };
  CHECK(is_refused(image_with([](VulkanImage& i) { i.image = nullptr; })));
  CHECK(is_refused(image_with([](VulkanImage& i) { i.format = VK_FORMAT_R8G8B8A8_UNORM; })));
  CHECK(is_refused(image_with([](VulkanImage& i) { i.width = kWidth - 1; })));
  CHECK(is_refused(image_with([](VulkanImage& i) { i.height = 0; })));
  CHECK(is_refused(image_with([](VulkanImage& i) { i.left = 1; })));
  CHECK(is_refused(image_with([](VulkanImage& i) { i.top = -1; })));
  CHECK(is_refused(image_with([](VulkanImage& i) { i.layout_after = VK_IMAGE_LAYOUT_UNDEFINED; })));
  CHECK(is_refused(buffer_with([](VulkanBuffer& b) { b.buffer = nullptr; })));
  CHECK(is_refused(buffer_with([](VulkanBuffer& b) { b.format = 0; })));
  CHECK(is_refused(buffer_with([](VulkanBuffer& b) { b.size_bytes -= 1; })));
  CHECK(is_refused(buffer_with([](VulkanBuffer& b) { b.offset_bytes = 4; })));
  CHECK(is_refused(buffer_with([](VulkanBuffer& b) { b.size_bytes += 2, b.offset_bytes = 2; })));
  auto on_cpu = Renderer::create();
  REQUIRE(on_cpu.has_value());
  REQUIRE(on_cpu->set_lens(lens).has_value());
  CHECK_FALSE(on_cpu->render_to_vulkan(kTwoLights, settings, {.to = image.image}).has_value());
  test::check_no_messages();
}

TEST_CASE("shaders need no more of a device than enable_vulkan_features() sets") {
  // SPIR-V 1.6, 3.31. Every device has texel buffers.
  constexpr std::uint32_t kShader = 1, kFloat64 = 10, kSampledBuffer = 46;
  for (std::size_t k = 0; k < vulkan::kShaders; ++k)
    for (const std::uint32_t capability : capabilities_of(static_cast<vulkan::Shader>(k)))
      CHECK((capability == kShader || capability == kFloat64 || capability == kSampledBuffer));
}
