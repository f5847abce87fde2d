// SPDX-License-Identifier: Apache-2.0
#include "openfx/flare_engine.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <system_error>

#include <fmt/format.h>

#include "contrejour/expert/detected_picture.h"
#include "contrejour/expert/measured_settings.h"
#include "contrejour/expert/renderer_settings.h"
#include "contrejour/expert/settings.h"
#include "openfx/parameter_list.h"

namespace contrejour::openfx {
namespace {

using params::Values;

constexpr double kDraftError = 0.02;  // RMS, as that of a Renderer's own drafts

// All values as one text: equal texts, equal values.
std::string key_of(const Values& values) {
  std::string key;
  for (const params::Parameter& row : params::all_parameters())
    for (const std::string& text : values.list(row.name)) key += fmt::format("{}={}\n", row.name, text);
  return key;
}

// FNV-1a over 64-bit words, to recognise a source that the host shows again for another part of its frame.
std::uint64_t hash_of(const Image& image) {
  constexpr std::uint64_t kPrime = 0x100000001b3;
  std::uint64_t hash = 0xcbf29ce484222325;
  const std::size_t bytes = image.pixels.size() * sizeof(float);
  const auto* const data = reinterpret_cast<const char*>(image.pixels.data());
  for (std::size_t k = 0; k < bytes; k += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, data + k, std::min(sizeof word, bytes - k));
    hash = (hash ^ word) * kPrime;
  }
  return hash;
}

std::string text_of(const PixelWindow& window) {
  return fmt::format("{},{},{},{}", window.x, window.y, window.width, window.height);
}

std::string frame_key_of(const FlareRequest& request, const Values& with_lights, const std::string& lens) {
  return fmt::format("{}{} {} {} {} {} {} {} {}", key_of(with_lights), lens, text_of(request.region),
                     text_of(request.frame), text_of(request.unscaled_frame), request.pixel_aspect, request.is_draft,
                     request.shows_detected_lights, hash_of(request.source));
}

// A light's brightness is the sum of its image in the host's full resolution. At a smaller render scale there are fewer
// pixels to sum over, and the picture must look the same.
Result<std::vector<Light>> given_lights_of(const FlareRequest& request, const Values& values, const LensState& lens,
                                           const Frame& scaled, ColourSpace space) {
  const auto unscaled = pixel_grid(values, lens, request.unscaled_frame, request.unscaled_frame, request.pixel_aspect);
  if (!unscaled) return tl::unexpected(unscaled.error());
  auto lights = params::given_lights(values, lens, unscaled->frame, space);
  if (!lights) return lights;
  const double pixels_per_pixel = unscaled->frame.pixel_pitch_mm / scaled.pixel_pitch_mm;
  const double factor = params::gain(values) * pixels_per_pixel * pixels_per_pixel;
  for (Light& light : *lights)
    for (double& value : light.value) value *= factor;
  return lights;
}

void add_given_lights(FlarePlan& plan, const std::vector<Light>& lights) {
  plan.given_light_count = lights.size();
  plan.lights.insert(plan.lights.end(), lights.begin(), lights.end());
  if (!plan.imaged_lights || lights.empty()) return;
  std::vector<Light> imaged = *plan.imaged_lights;
  imaged.insert(imaged.end(), lights.begin(), lights.end());
  plan.imaged_lights = std::make_shared<const std::vector<Light>>(std::move(imaged));
}

// The smallest area of a detected light is in pixels of the full resolution.
Result<void> scale_min_pixels(const FlareRequest& request, Values& values) {
  const double scale_x = static_cast<double>(request.frame.width) / std::max(1, request.unscaled_frame.width);
  const double scale_y = static_cast<double>(request.frame.height) / std::max(1, request.unscaled_frame.height);
  const double pixels = std::max(1.0, std::round(values.number("min-pixels") * std::min(1.0, scale_x * scale_y)));
  return values.set("min-pixels", fmt::format("{:.0f}", pixels));
}

}  // namespace

template <class T, class Read>
Result<const T*> FlareEngine::keep(Kept<T>& kept, const std::string& name, const Read& read) {
  std::error_code code;
  auto written = std::filesystem::last_write_time(name, code);
  if (code) written = {};  // a bundled name, or a file that is not there, which read() reports
  if (!kept.value || kept.name != name || kept.written != written) {
    kept.value.reset();
    auto value = read(name);
    if (!value) return tl::unexpected(value.error());
    kept.name = name;
    kept.written = written;
    kept.value = std::move(*value);
  }
  return &*kept.value;
}

// The host's parameters override the file of lights, and the file overrides the look, as on the command line.
Result<FlareEngine::FrameValues> FlareEngine::values_of(const FlareRequest& request) {
  FrameValues values{request.own, {}, request.lens};
  const Animation* animation = nullptr;
  if (!request.lights_file.empty()) {
    const auto read = keep(animation_, request.lights_file,
                           [](const std::string& file) { return read_animation(std::filesystem::path(file)); });
    if (!read) return tl::unexpected(read.error());
    animation = *read;
    values.all = values.all.over(parameters_at(*animation, request.time));
  }
  if (!request.look.empty()) {
    const auto look = keep(look_, request.look, params::find_preset);
    if (!look) return tl::unexpected(look.error());
    values.all = values.all.over((*look)->values);
    if (values.lens.empty()) values.lens = (*look)->lens;
  }
  if (values.lens.empty()) values.lens = kDefaultLens;
  if (auto scaled = scale_min_pixels(request, values.all); !scaled) return tl::unexpected(scaled.error());
  if (auto set = values.all.set("pixel-aspect", fmt::format("{}", request.pixel_aspect)); !set)
    return tl::unexpected(set.error());
  values.with_lights = values.all;
  for (const auto& [name, text] : request.lights)
    if (auto set = values.with_lights.set(name, text); !set) return tl::unexpected(set.error());
  if (animation) {
    const Shutter shutter{values.all.number("shutter-angle"), *values.all.text("shutter-offset") == "centre"};
    add_lights_at(*animation, request.time, values.with_lights, shutter);
  }
  return values;
}

Result<void> FlareEngine::set_source(const FlareRequest& request, const FrameValues& values) {
  measured_ = nullptr;
  if (!is_measured_flare(values.lens)) return set_lens(values);
  const auto flare =
      keep(flare_, values.lens, [](const std::string& file) { return read_flare(std::filesystem::path(file)); });
  if (!flare) return tl::unexpected(flare.error());
  const auto use = request.source.pixels.empty() ? MeasuredUse::Lights : MeasuredUse::Photograph;
  if (auto good = check_measured_values(**flare, values.all, use); !good) return good;
  measured_ = *flare;
  lens_ = ideal_lens_of(**flare);
  lens_key_.clear();
  return {};
}

// The lens is configured anew where any value changed, which takes little; the renderer keeps what still holds.
Result<void> FlareEngine::set_lens(const FrameValues& values) {
  const auto lens = keep(prescription_, values.lens, [](const std::string& name) { return find_lens(name); });
  if (!lens) return tl::unexpected(lens.error());
  const auto written = prescription_.written.time_since_epoch().count();
  std::string key = fmt::format("{} {}\n{}", values.lens, written, key_of(values.all));
  if (renderer_ && key == lens_key_) return {};
  lens_key_.clear();
  auto state = params::lens_of(**lens, values.all);
  if (!state) return tl::unexpected(state.error());
  lens_ = std::move(*state);
  if (!renderer_) {
    auto renderer = Renderer::create();
    if (!renderer) return tl::unexpected(renderer.error());
    renderer_ = std::move(*renderer);
  }
  if (auto set = renderer_->set_lens(lens_); !set) return set;
  lens_key_ = std::move(key);
  return {};
}

Result<void> FlareEngine::set_method(const Values& values, bool is_draft) {
  return is_draft ? renderer_->set_method(AdaptiveOptions{kDraftError}) : configure_renderer(*renderer_, values);
}

Result<std::vector<Light>> FlareEngine::given_lights(const FlareRequest& request, const FrameValues& values,
                                                     const FlarePlan& plan) const {
  auto lights = given_lights_of(request, values.with_lights, lens_, plan.grid.frame, plan.space);
  if (!lights || measured_ == nullptr) return lights;
  return exposed_lights(*measured_, std::move(*lights), values.all);
}

Result<FlarePlan> FlareEngine::plan(FlareRequest& request, const FrameValues& values, Picture& picture) const {
  FlarePlan plan;
  if (!request.source.pixels.empty()) {
    picture.rgb = std::move(request.source);
    picture.data_window = request.region;
    picture.display_window = request.frame;
    auto detected = plan_flare(picture, lens_, values.all);
    if (!detected) return detected;
    plan = std::move(*detected);
  } else {
    plan.space = params::colour_space(values.all, ColourSpace::Rec709);
    const auto grid = pixel_grid(values.all, lens_, request.region, request.frame, request.pixel_aspect);
    if (!grid) return tl::unexpected(grid.error());
    plan.grid = *grid;
  }
  const auto lights = given_lights(request, values, plan);
  if (!lights) return tl::unexpected(lights.error());
  add_given_lights(plan, *lights);
  return plan;
}

Result<Flare> FlareEngine::render_plan(const FlareRequest& request, const FrameValues& values, const FlarePlan& plan,
                                       const Context& context) {
  Context own = context;
  own.threads = values.all.integer("threads");
  if (own.threads == 0) own.threads = request.threads;
  if (measured_ != nullptr) {
    std::vector<Light> points = plan.lights;  // a measured flare takes no shapes of detected lights
    for (Light& light : points) light.shape = nullptr;
    return contrejour::render(*measured_, points, plan.grid.frame, own);
  }
  FrameSettings settings = params::frame_settings(values.all, plan.grid.frame, plan.space);
  if (request.is_draft) settings.area_error = kDraftError;
  settings.starburst.left_out = plan.light_matte;
  settings.starburst.lights = plan.imaged_lights;
  return renderer_->render(plan.lights, settings, own);
}

Result<std::shared_ptr<const Image>> FlareEngine::draw(FlareRequest& request, const FrameValues& values,
                                                       const Context& context) {
  Picture picture;
  auto planned = plan(request, values, picture);
  if (!planned) return tl::unexpected(planned.error());
  if (request.shows_detected_lights)
    return picture.rgb.pixels.empty() ? nullptr
                                      : std::make_shared<const Image>(pixels_of_lights(picture.rgb, planned->found));
  if (planned->lights.empty()) return nullptr;
  picture = {};
  auto flare = render_plan(request, values, *planned, context);
  if (!flare) return tl::unexpected(flare.error());
  auto image = picture_of_flare(std::move(flare->image), planned->grid);
  if (!image) return tl::unexpected(image.error());
  return std::make_shared<const Image>(std::move(*image));
}

Result<std::shared_ptr<const Image>> FlareEngine::render(FlareRequest request, const Context& context) {
  const auto values = values_of(request);
  if (!values) return tl::unexpected(values.error());
  if (const auto set = set_source(request, *values); !set) return tl::unexpected(set.error());
  if (measured_ == nullptr)
    if (const auto set = set_method(values->all, request.is_draft); !set) return tl::unexpected(set.error());
  std::string key;
  if (request.is_part_of_frame) {
    key = frame_key_of(request, values->with_lights, values->lens);
    if (key == frame_key_) return frame_;
  }
  frame_key_.clear();
  frame_.reset();
  auto frame = draw(request, *values, context);
  if (!frame || !request.is_part_of_frame) return frame;
  frame_key_ = std::move(key);
  frame_ = *frame;
  return frame;
}

}  // namespace contrejour::openfx
