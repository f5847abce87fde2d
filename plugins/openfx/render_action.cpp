// SPDX-License-Identifier: Apache-2.0
// Renders a window of a frame. A fault shows a message, and the source passes through.
#include <cmath>
#include <utility>

#include "contrejour/expert/parameter_text.h"
#include "openfx/actions.h"
#include "openfx/host_image.h"
#include "openfx/read_parameters.h"
#include "openfx/regions.h"

namespace contrejour::openfx {
namespace {

// A render that owns what it needs, because it may outlast the host's interest in it. The plug-in waits for it before
// it is unloaded.
struct FlareJob {
  EnginePool& engines;
  const void* instance;  // for the pool: never looked into
  FlareRequest request;
  Result<std::shared_ptr<const Image>> flare = nullptr;

  void run(const std::atomic<bool>& cancel) {
    auto engine = engines.take(instance);
    Context context;
    context.cancel = &cancel;
    flare = engine->render(std::move(request), context);
    engines.give_back(std::move(engine), instance);
  }
};

double positive_or(std::optional<double> value, double otherwise) {
  return value && std::isfinite(*value) && *value > 0.0 ? *value : otherwise;
}

// A host's arguments may name another scale than the image has; the image's is the one its pixels are of.
PixelScale scale_of(const Instance& instance, const Properties& in, const HostImage& output) {
  const Properties& image = output.properties();
  PixelScale scale;
  scale.x = positive_or(image.real(name::kRenderScale, 0), positive_or(in.real(name::kRenderScale, 0), 1.0));
  scale.y = positive_or(image.real(name::kRenderScale, 1), positive_or(in.real(name::kRenderScale, 1), scale.x));
  const double project = positive_or(instance.properties().real(name::kProjectPixelAspectRatio), 1.0);
  scale.pixel_aspect = positive_or(image.real(name::kImagePixelAspectRatio), project);
  return scale;
}

bool is_interactive(const Properties& in) {
  return in.integer(name::kInteractiveRender).value_or(0) != 0 ||
         in.integer(name::kRenderQualityDraft).value_or(0) != 0;
}

bool contains(const RectI& window, const PixelWindow& pixels, const RectI& bounds) {
  return window.x1 <= std::max(bounds.x1, pixels.x) && window.x2 >= std::min(bounds.x2, pixels.x + pixels.width) &&
         window.y1 <= std::max(bounds.y1, -pixels.y - pixels.height) && window.y2 >= std::min(bounds.y2, -pixels.y);
}

struct RenderTask {
  Time time = 0.0;
  RectI window{};
  const HostImage& output;
  const HostImage* source = nullptr;  // or null
  PixelScale scale;
};

FlareRequest request_of(const Instance& instance, const Properties& in, const RenderTask& frame, ReadParameters& read) {
  FlareRequest request;
  const RectD sensor = canonical(instance, sensor_frame(instance, frame.time, read.frame), frame.scale);
  const RectD region = canonical(instance, output_region(instance, frame.time, read.frame), frame.scale);
  request.region = pixels_of(region, frame.scale);
  request.frame = pixels_of(sensor, frame.scale);
  request.unscaled_frame = pixels_of(sensor, frame.scale.in_full_resolution());
  request.pixel_aspect = frame.scale.pixel_aspect;
  request.time = frame.time;
  request.is_draft = read.drafts_while_interacting && is_interactive(in);
  request.shows_detected_lights = read.output == OutputPicture::DetectedLights;
  request.is_part_of_frame = !contains(frame.window, request.region, frame.output.bounds());
  request.threads = instance.host().granted_threads();
  // A larger region is refused by the library.
  const double pixels = static_cast<double>(request.region.width) * request.region.height;
  if (frame.source != nullptr && read.own.is_on("detect") && pixels <= params::kMaxPixels)
    request.source = decoded_region(*frame.source, request.region, read.transfer);
  request.own = std::move(read.own);
  request.lights = std::move(read.lights);
  request.look = std::move(read.look);
  request.lens = std::move(read.lens);
  request.lights_file = std::move(read.lights_file);
  return request;
}

Result<std::shared_ptr<const Image>> flare_of(Instance& instance, FlareRequest request) {
  LoadedPlugin& loaded = instance.loaded();
  const auto job = std::make_shared<FlareJob>(FlareJob{loaded.engines, &instance, std::move(request)});
  const ImageEffectSuite& effects = *loaded.host.effects;
  const auto host_aborts = [&] { return effects.abort != nullptr && effects.abort(instance.effect()) != 0; };
  if (loaded.runs.run(host_aborts, [job](const std::atomic<bool>& cancel) { job->run(cancel); })) return job->flare;
  return failure(ErrorCode::Cancelled, "the host aborted");
}

void pass_through(const RenderTask& frame) {
  compose({.source = frame.source, .region = {}}, frame.window, frame.output);
}

Status render_frame(Instance& instance, const Properties& in, const RenderTask& frame) {
  auto read = read_parameters(instance, frame.time);
  if (!read) {
    instance.show_fault(read.error().to_string());
    pass_through(frame);
    return status::kOk;
  }
  Composition composition{.source = frame.source, .region = {}};
  composition.shows_source = read->output == OutputPicture::SourceAndFlare && frame.source != nullptr;
  composition.alpha = static_cast<Composition::Alpha>(read->alpha);
  composition.curve = read->transfer;
  FlareRequest request = request_of(instance, in, frame, *read);
  composition.region = request.region;
  const auto flare = flare_of(instance, std::move(request));
  if (flare) {
    instance.show_fault("");
    composition.flare = flare->get();
    compose(composition, frame.window, frame.output);
    return status::kOk;
  }
  if (flare.error().code == ErrorCode::Cancelled) return status::kOk;  // the host throws the frame away
  instance.show_fault(flare.error().to_string());
  pass_through(frame);
  return status::kOk;
}

// Images of depths or channels that were not offered. Sources of another depth than the output's are such, too.
Result<void> check_images(const HostImage& output, const std::optional<HostImage>& source) {
  if (auto good = output.check(); !good || !source) return good;
  if (auto good = source->check(); !good) return good;
  if (source->depth() == output.depth()) return {};
  return invalid_argument("the source and the output have pixels of different depths; convert the source to float");
}

}  // namespace

Status render(Instance& instance, const Properties& in) {
  const Host& host = instance.host();
  const auto time = in.real(name::kTime);
  const auto window = in.rectangle(name::kRenderWindow);
  if (!time || !window) return status::kErrValue;
  const auto output = HostImage::fetch(host, instance.clip(clip::kOutput), *time);
  if (!output) return status::kFailed;
  const ClipHandle source_clip = instance.clip(clip::kSource);
  std::optional<HostImage> source;
  if (instance.is_connected(source_clip)) {
    if (auto image = HostImage::fetch(host, source_clip, *time)) source.emplace(std::move(*image));
  }
  if (const auto good = check_images(*output, source); !good) {
    instance.show_fault(good.error().message);
    return status::kErrImageFormat;
  }
  const RenderTask frame{*time, *window, *output, source ? &*source : nullptr, scale_of(instance, in, *output)};
  return render_frame(instance, in, frame);
}

}  // namespace contrejour::openfx
