// SPDX-License-Identifier: Apache-2.0
#include "natron_host.h"

#include <stdexcept>
#include <string>

namespace contrejour::openfx {
namespace {

void require(const TestHost& host, const char* action, EffectStruct& effect, PropertySetStruct* in,
             PropertySetStruct* out) {
  const Status answer = host.act(action, &effect, in, out);
  if (answer != status::kOk && answer != status::kReplyDefault)
    throw std::runtime_error(std::string("Natron takes this for a failure: ") + action);
}

PropertySetStruct arguments(const EffectStruct& effect, double time, double scale) {
  PropertySetStruct in;
  in.known = effect.properties.known;
  in.put<double>(name::kTime, {time});
  in.put<double>(name::kRenderScale, {scale, scale});
  return in;
}

void copy_parameters(const EffectStruct& from, EffectStruct& to) {
  for (std::size_t k = 0; k < from.params.params.size(); ++k) {
    to.params.params[k]->numbers = from.params.params[k]->numbers;
    to.params.params[k]->text = from.params.params[k]->text;
    to.params.params[k]->keys = from.params.params[k]->keys;
  }
}

}  // namespace

HostOptions natron_options() {
  HostOptions options;
  options.name = "fr.inria.Natron";
  // The part of HostSupport's lists that this plug-in could meet.
  options.known_properties.declared = {name::kName,
                                       name::kLabel,
                                       name::kShortLabel,
                                       name::kLongLabel,
                                       name::kVersion,
                                       name::kVersionLabel,
                                       name::kPluginDescription,
                                       name::kType,
                                       name::kTime,
                                       name::kInstanceData,
                                       name::kChangeReason,
                                       name::kContext,
                                       name::kSupportedContexts,
                                       name::kSupportedPixelDepths,
                                       name::kGrouping,
                                       name::kRenderThreadSafety,
                                       name::kHostFrameThreading,
                                       name::kSingleInstance,
                                       name::kFieldRenderTwice,
                                       name::kSupportsTiles,
                                       name::kSupportsMultiResolution,
                                       name::kTemporalClipAccess,
                                       name::kSupportsMultipleClipDepths,
                                       name::kProjectPixelAspectRatio,
                                       name::kSupportsMultipleClipPars,
                                       name::kProjectSize,
                                       name::kProjectOffset,
                                       name::kProjectExtent,
                                       name::kRenderWindow,
                                       name::kRenderScale,
                                       name::kInteractiveRender,
                                       name::kRenderQualityDraft,
                                       name::kRegionOfDefinition,
                                       name::kRegionOfInterest,
                                       name::kFrameVarying,
                                       name::kOverlayV1,
                                       name::kEffectInstance,
                                       name::kPixelScale,
                                       name::kPenPosition,
                                       name::kSupportedComponents,
                                       name::kClipConnected,
                                       name::kClipOptional,
                                       name::kClipFieldExtraction,
                                       name::kClipRoiOfSource,
                                       name::kComponents,
                                       name::kPixelDepth,
                                       name::kImageData,
                                       name::kImageBounds,
                                       name::kImageRowBytes,
                                       name::kImagePixelAspectRatio,
                                       name::kDefault,
                                       name::kMin,
                                       name::kMax,
                                       name::kDisplayMin,
                                       name::kDisplayMax,
                                       name::kHint,
                                       name::kScriptName,
                                       name::kParent,
                                       name::kChoiceOption,
                                       name::kStringMode,
                                       name::kStringFilePathExists,
                                       name::kGroupOpen,
                                       name::kDoubleType,
                                       name::kDefaultCoordinateSystem,
                                       name::kDigits,
                                       name::kAnimates};
  return options;
}

NatronNode::NatronNode(const TestHost& host, double project_width, double project_height, HostPicture* source)
    : host_(host), width_(project_width), height_(project_height), source_(source),
      effect_(host.create(context::kGeneral, project_width, project_height)) {
  effect_->clip(clip::kSource)->picture = source;
  PropertySetStruct in, out;
  in.put<double>(name::kTime, {1.0});
  require(host, "OfxImageEffectActionGetTimeDomain", *effect_, nullptr, &out);
  require(host, action::kGetClipPreferences, *effect_, nullptr, &out);
  for (const double scale : {1.0, 0.5}) static_cast<void>(region(scale));
}

RectD NatronNode::region(double scale) const {
  effect_->scale = scale;
  PropertySetStruct in = arguments(*effect_, 1.0, scale), out;
  require(host_, action::kGetRegionOfDefinition, *effect_, &in, &out);
  effect_->scale = 1.0;
  const auto side = [&](std::size_t k) { return out.get<double>(name::kRegionOfDefinition, k); };
  return {side(0), side(1), side(2), side(3)};
}

std::unique_ptr<EffectStruct> NatronNode::clone() const {
  auto copy = host_.populate(context::kGeneral, width_, height_);
  copy->properties = effect_->properties;
  copy_parameters(*effect_, *copy);
  copy->clip(clip::kSource)->picture = source_;
  if (host_.act(action::kCreateInstance, copy.get()) != status::kOk) throw std::runtime_error("no clone was created");
  return copy;
}

Status NatronNode::render(HostPicture& output, double time, double scale, bool aborts) const {
  const auto effect = clone();
  effect->scale = scale;
  effect->clip(clip::kOutput)->picture = &output;
  effect->aborts = [aborts, render_thread = std::this_thread::get_id()] {
    return aborts && std::this_thread::get_id() == render_thread ? 1 : 0;
  };
  const RectI& window = output.bounds;
  PropertySetStruct in = arguments(*effect, time, scale), out;
  in.put<int>(name::kRenderWindow, {window.x1, window.y1, window.x2, window.y2});
  require(host_, action::kGetRegionOfDefinition, *effect, &in, &out);
  require(host_, action::kIsIdentity, *effect, &in, &out);
  require(host_, action::kGetRegionsOfInterest, *effect, &in, &out);
  require(host_, "OfxImageEffectActionGetFramesNeeded", *effect, &in, &out);
  require(host_, "OfxImageEffectActionBeginSequenceRender", *effect, &in, nullptr);
  const Status rendered =
      host_.render(*effect, {.time = time, .window = window, .scale = scale, .is_interactive = false});
  require(host_, "OfxImageEffectActionEndSequenceRender", *effect, &in, nullptr);
  host_.destroy(*effect);
  return rendered;
}

}  // namespace contrejour::openfx
