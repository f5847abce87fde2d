// SPDX-License-Identifier: Apache-2.0
// The test host's effects, clips and images, threads, messages and overlays.
#include <cstdarg>
#include <cstdio>

#include "host_suites.h"
#include "test_host.h"

namespace contrejour::openfx {
namespace {

// An image that a clip gave, until it is released.
struct GivenImage : PropertySetStruct {
  EffectStruct* effect = nullptr;
};

Status define_clip(EffectHandle effect, const char* name, PropertySetHandle* properties) {
  auto clip = std::make_unique<ClipStruct>();
  clip->name = name;
  clip->effect = effect;
  clip->properties.known = effect->properties.known;
  *properties = &clip->properties;
  effect->clips.push_back(std::move(clip));
  return status::kOk;
}

Status find_clip(EffectHandle effect, const char* name, ClipHandle* clip, PropertySetHandle* properties) {
  *clip = effect->clip(name);
  if (*clip == nullptr) return status::kErrUnknown;
  if (properties != nullptr) *properties = &(*clip)->properties;
  return status::kOk;
}

Status give_image(ClipHandle clip, Time /*time*/, const RectD* /*region*/, PropertySetHandle* image) {
  if (clip->picture == nullptr) return status::kFailed;
  HostPicture& picture = *clip->picture;
  auto given = std::make_unique<GivenImage>();
  given->effect = clip->effect;
  given->known = clip->effect->properties.known;
  given->put<void*>(name::kImageData, {picture.lowest_row()});
  given->put<int>(name::kImageBounds, {picture.bounds.x1, picture.bounds.y1, picture.bounds.x2, picture.bounds.y2});
  given->put<int>(name::kImageRowBytes, {picture.row_bytes});
  given->put<std::string>(name::kPixelDepth, {picture.depth});
  given->put<std::string>(name::kComponents, {picture.channels == 4 ? value::kRgba : value::kRgb});
  given->put<double>(name::kRenderScale, {clip->effect->scale, clip->effect->scale});
  given->put<double>(name::kImagePixelAspectRatio, {picture.pixel_aspect});
  ++clip->effect->images_out;
  *image = given.release();
  return status::kOk;
}

Status take_image_back(PropertySetHandle image) {
  const std::unique_ptr<GivenImage> given(static_cast<GivenImage*>(image));
  --given->effect->images_out;
  return status::kOk;
}

Status region_of(ClipHandle clip, Time /*time*/, RectD* region) {
  if (clip->picture == nullptr) return status::kFailed;
  const RectI& bounds = clip->picture->bounds;
  const double across = clip->picture->pixel_aspect / clip->effect->scale, down = 1.0 / clip->effect->scale;
  *region = {bounds.x1 * across, bounds.y1 * down, bounds.x2 * across, bounds.y2 * down};
  return status::kOk;
}

Status show_message(void* handle, const char* /*type*/, const char* /*id*/, const char* format, ...) {
  auto* const effect = static_cast<EffectStruct*>(handle);
  char text[2000];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  const std::lock_guard lock(effect->message_mutex);
  effect->message = text;
  ++effect->messages;
  return status::kOk;
}

Status clear_message(void* handle) {
  auto* const effect = static_cast<EffectStruct*>(handle);
  const std::lock_guard lock(effect->message_mutex);
  effect->message.clear();
  return status::kOk;
}

}  // namespace

const ImageEffectSuite& effect_suite() {
  static const ImageEffectSuite suite = [] {
    ImageEffectSuite functions{};
    functions.get_property_set = [](EffectHandle effect, PropertySetHandle* properties) {
      if (effect == nullptr) return status::kErrBadHandle;
      *properties = &effect->properties;
      return status::kOk;
    };
    functions.get_param_set = [](EffectHandle effect, ParamSetHandle* params) {
      *params = &effect->params;
      return status::kOk;
    };
    functions.clip_define = &define_clip;
    functions.clip_get_handle = &find_clip;
    functions.clip_get_property_set = [](ClipHandle clip, PropertySetHandle* properties) {
      clip->properties.put<int>(name::kClipConnected, {clip->picture != nullptr ? 1 : 0});
      *properties = &clip->properties;
      return status::kOk;
    };
    functions.clip_get_image = &give_image;
    functions.clip_release_image = &take_image_back;
    functions.clip_get_region_of_definition = &region_of;
    functions.abort = [](EffectHandle effect) { return effect->aborts ? effect->aborts() : 0; };
    return functions;
  }();
  return suite;
}

const MultiThreadSuite& thread_suite() {
  static const MultiThreadSuite suite = [] {
    MultiThreadSuite functions{};
    functions.cpu_count = [](unsigned int* count) {
      *count = 2;
      return status::kOk;
    };
    return functions;
  }();
  return suite;
}

const InteractSuite& interact_suite() {
  static const InteractSuite suite{[](InteractHandle) { return status::kOk; },
                                   [](InteractHandle) { return status::kOk; },
                                   [](InteractHandle interact, PropertySetHandle* properties) {
                                     *properties = &interact->properties;
                                     return status::kOk;
                                   }};
  return suite;
}

const DrawSuite& draw_suite() {
  static const DrawSuite suite = [] {
    DrawSuite functions{};
    functions.set_colour = [](DrawContext, const ColourF*) { return status::kOk; };
    functions.draw = [](DrawContext context, int, const PointD* points, int count) {
      context->points.insert(context->points.end(), points, points + count);
      return status::kOk;
    };
    return functions;
  }();
  return suite;
}

const MessageSuite& message_suite() {
  static const MessageSuite suite{&show_message, &show_message, &clear_message};
  return suite;
}

}  // namespace contrejour::openfx
