// SPDX-License-Identifier: Apache-2.0
#include "mlt_host.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include <half.h>

#include "host_suites.h"

namespace contrejour::openfx {
namespace {

constexpr const char* kByte = "OfxBitDepthByte";
constexpr const char* kShort = "OfxBitDepthShort";

std::vector<std::string> texts(const PropertySetStruct& set, const char* property) {
  std::vector<std::string> all;
  for (std::size_t k = 0; k < set.count(property); ++k) all.push_back(set.get<std::string>(property, k));
  return all;
}

bool has(const std::vector<std::string>& all, const char* one) { return std::ranges::find(all, one) != all.end(); }

// "0.25 0.5" as numbers; missing ones are 0, as MLT's are.
std::vector<double> numbers_of(const std::string& text, std::size_t count) {
  std::vector<double> numbers(count);
  const char* at = text.c_str();
  for (double& number : numbers) {
    char* end = nullptr;
    number = std::strtod(at, &end);
    at = end;
  }
  return numbers;
}

MltHost::Offered offered_of(const ParamStruct& param) {
  MltHost::Offered offered;
  const auto fallback = [&](std::size_t k) { return param.properties.get<double>(name::kDefault, k); };
  if (param.type == type::kDouble) offered.type = "float";
  if (param.type == type::kInteger) offered.type = "integer";
  if (param.type == type::kBoolean) offered.type = "boolean";
  if (param.type == type::kChoice || param.type == type::kString) offered.type = "string";
  if (param.type == type::kRgb) offered.type = offered.widget = "color";
  if (param.type == type::kGroup) offered.type = "group";
  if (param.type == type::kDouble2D) {
    offered.type = "float";
    const auto kind = param.properties.get<std::string>(name::kDoubleType, 0, "OfxParamDoubleTypeXY");
    if (kind == value::kDoublePoint) offered.widget = "point";
    if (kind == "OfxParamDoubleTypeXY") offered.widget = "size";
    offered.is_normalised = param.properties.get<std::string>(name::kDefaultCoordinateSystem) == value::kNormalised;
    offered.fallback = std::to_string(fallback(0)) + " " + std::to_string(fallback(1));
  }
  if (param.type == type::kString) offered.fallback = param.properties.get<std::string>(name::kDefault);
  return offered;
}

// A user's value, written to the parameter as MLT writes it.
void write_value(ParamStruct& param, const MltHost::Offered& offered, const std::string& text) {
  if (offered.widget == "point" || offered.widget == "size") {
    param.numbers = numbers_of(text, 2);
  } else if (offered.type == "color") {
    // "#rrggbbaa" with eight bits a channel.
    for (std::size_t c = 0; c < 3; ++c) param.numbers[c] = std::stoi(text.substr(1 + 2 * c, 2), nullptr, 16) / 255.0;
  } else if (offered.type == "string") {
    param.text = text;
  } else if (!param.numbers.empty()) {
    param.numbers[0] = std::strtod(text.c_str(), nullptr);
  }
}

std::size_t sample_bytes(const std::string& depth) { return depth == value::kFloat ? 4 : 2; }

// MLT's own conversion cuts the mantissa and has no numbers below the smallest normal half.
half cut_to_half(float value) {
  half nearest(value);
  if (std::abs(value) < 6.104e-5F) return half(0.0F);
  while (std::abs(static_cast<float>(nearest)) > std::abs(value)) nearest.setBits(nearest.bits() - 1);
  return nearest;
}

std::vector<std::byte> pixels_in(const std::string& depth, const std::vector<std::uint16_t>& samples) {
  std::vector<std::byte> pixels(samples.size() * sample_bytes(depth));
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const float number = static_cast<float>(samples[k]) * (1.0F / 65535.0F);
    const half cut = depth == value::kHalf ? cut_to_half(number) : half(0.0F);
    if (depth == value::kFloat)
      std::memcpy(&pixels[4 * k], &number, 4);
    else if (depth == value::kHalf)
      std::memcpy(&pixels[2 * k], &cut, 2);
    else
      std::memcpy(&pixels[2 * k], &samples[k], 2);
  }
  return pixels;
}

void samples_from(const std::string& depth, const std::vector<std::byte>& pixels, std::vector<std::uint16_t>& samples) {
  for (std::size_t k = 0; k < samples.size(); ++k) {
    float number = 0.0F;
    half cut;
    if (depth == kShort) {
      std::memcpy(&samples[k], &pixels[2 * k], 2);
      continue;
    }
    if (depth == value::kFloat) std::memcpy(&number, &pixels[4 * k], 4);
    if (depth == value::kHalf) std::memcpy(&cut, &pixels[2 * k], 2), number = cut;
    samples[k] = static_cast<std::uint16_t>((number >= 0.0F ? std::min(number, 1.0F) : 0.0F) * 65535.0F + 0.5F);
  }
}

// The arguments that a frame passes to the actions.
struct MltFrame {
  int width, height;
  double scale_x, scale_y, pixel_aspect, time;
  std::string depth;

  void set_scale(PropertySetStruct& set) const { set.put<double>(name::kRenderScale, {scale_x, scale_y}); }
};

// The clip's properties are those of its image, too.
void set_clip(ClipStruct& clip, const MltFrame& frame, std::vector<std::byte>& pixels) {
  PropertySetStruct& set = clip.properties;
  const int row = frame.width * 4 * static_cast<int>(sample_bytes(frame.depth));
  set.put<int>(name::kImageRowBytes, {-row});
  set.put<void*>(name::kImageData, {pixels.data() + static_cast<std::ptrdiff_t>(frame.height - 1) * row});
  set.put<std::string>(name::kPixelDepth, {frame.depth});
  set.put<std::string>(name::kComponents, {value::kRgba});
  set.put<int>(name::kImageBounds, {0, 0, frame.width, frame.height});
  set.put<int>("OfxImagePropRegionOfDefinition", {0, 0, frame.width, frame.height});
  set.put<std::string>(name::kSupportedComponents,
                       {"OfxImageComponentNone", value::kRgba, value::kRgb, "OfxImageComponentAlpha"});
  set.put<double>(name::kImagePixelAspectRatio, {frame.pixel_aspect});
  set.put<std::string>("OfxImageEffectPropPreMultiplication", {"OfxImageAlphaUnPremultiplied"});
  set.put<std::string>("OfxImagePropField", {"OfxFieldBoth"});
  set.put<int>(name::kClipConnected, {1});
  frame.set_scale(set);
}

PropertySetStruct render_arguments(const MltFrame& frame) {
  PropertySetStruct in;
  in.put<double>(name::kTime, {frame.time});
  in.put<std::string>("OfxImageEffectPropFieldToRender", {"OfxFieldBoth"});
  in.put<int>(name::kRenderWindow, {0, 0, frame.width, frame.height});
  in.put<int>("OfxImageEffectPropSequentialRenderStatus", {1});
  in.put<int>(name::kInteractiveRender, {0});
  in.put<int>(name::kRenderQualityDraft, {0});
  frame.set_scale(in);
  return in;
}

PropertySetStruct sequence_arguments(const MltFrame& frame) {
  PropertySetStruct in;
  in.put<double>("OfxImageEffectPropFrameRange", {frame.time, frame.time});
  in.put<double>("OfxImageEffectPropFrameStep", {1.0});
  in.put<int>("OfxPropIsInteractive", {0});
  in.put<int>(name::kInteractiveRender, {0});
  frame.set_scale(in);
  return in;
}

}  // namespace

MltHost::MltHost() {
  properties_.put<std::string>(name::kName, {"MLT"});
  properties_.put<std::string>(name::kLabel, {"MLT"});
  properties_.put<int>("OfxPropAPIVersion", {1, 5});
  properties_.put<std::string>(name::kContext, {context::kFilter});
  properties_.put<std::string>(name::kSupportedPixelDepths, {kByte, kShort, value::kHalf, value::kFloat});
  properties_.put<std::string>(name::kSupportedComponents, {value::kRgba, value::kRgb});
  properties_.put<int>("OfxImageEffectPropSupportsOverlays", {0});
  table_ = {&properties_, &mlt_suite};
  plugin_ = open_plugin();
  plugin_->set_host(&table_);
  if (plugin_->main_entry(action::kLoad, nullptr, nullptr, nullptr) != status::kOk)
    throw std::runtime_error("MLT does not take a plug-in that does not load with kOfxStatOK");
  EffectStruct effect;
  if (plugin_->main_entry(action::kDescribe, &effect, nullptr, nullptr) != status::kOk)
    throw std::runtime_error("MLT does not take a plug-in that does not describe itself with kOfxStatOK");
  if (plugin_->main_entry(action::kDescribeInContext, &effect, &properties_, nullptr) == status::kErrMissingHostFeature)
    throw std::runtime_error("MLT does not take a plug-in that lacks a feature of the host");
  plugin_->main_entry(action::kUnload, nullptr, nullptr, nullptr);
  if (!has(texts(effect.properties, name::kSupportedContexts), context::kFilter))
    throw std::runtime_error("MLT takes filters only");
}

MltHost::~MltHost() {
  for (int k = 0; k < loads_; ++k) plugin_->main_entry(action::kUnload, nullptr, nullptr, nullptr);
}

void MltHost::call(const char* action, EffectStruct& effect, PropertySetStruct* in, PropertySetStruct* out) const {
  const Status answer = plugin_->main_entry(action, &effect, in, out);
  if (answer != status::kOk && answer != status::kReplyDefault)
    throw std::runtime_error(std::string(action) + " failed");
}

std::unique_ptr<EffectStruct> MltHost::new_effect() const {
  auto effect = std::make_unique<EffectStruct>();
  effect->properties.put<std::string>(name::kContext, {context::kFilter});
  plugin_->set_host(const_cast<HostTable*>(&table_));
  call(action::kLoad, *effect);
  ++loads_;
  call(action::kDescribe, *effect);
  plugin_->main_entry(action::kDescribeInContext, effect.get(), const_cast<PropertySetStruct*>(&properties_), nullptr);
  for (const auto& param : effect->params.params) {
    const std::size_t numbers = param->properties.count(name::kDefault);
    for (std::size_t k = 0; k < numbers; ++k)
      param->numbers.push_back(param->is_whole() ? param->properties.get<int>(name::kDefault, k)
                                                 : param->properties.get<double>(name::kDefault, k));
    param->text = param->properties.get<std::string>(name::kDefault);
    if (param->type == type::kChoice && numbers > 0)
      param->text =
          param->properties.get<std::string>(name::kChoiceOption, static_cast<std::size_t>(param->numbers[0]));
  }
  return effect;
}

std::map<std::string, MltHost::Offered> MltHost::offered() const {
  std::map<std::string, Offered> all;
  const auto effect = new_effect();
  for (const auto& param : effect->params.params)
    if (param->type != type::kPushButton) all[param->name] = offered_of(*param);
  return all;
}

std::string MltHost::depth() const {
  const auto depths = texts(new_effect()->properties, name::kSupportedPixelDepths);
  for (const char* depth : {kShort, value::kHalf, value::kFloat})
    if (has(depths, depth)) return depth;
  throw std::runtime_error("MLT has no 16-bit pixels for this plug-in");
}

void MltHost::filter(MltImage& image, const std::map<std::string, std::string>& properties, const Profile& profile,
                     int position) const {
  const auto effect = new_effect();
  plugin_->main_entry(action::kCreateInstance, effect.get(), nullptr, nullptr);
  const MltFrame frame{image.width,
                       image.height,
                       static_cast<double>(image.width) / profile.width,
                       static_cast<double>(image.height) / profile.height,
                       profile.pixel_aspect,
                       static_cast<double>(position),
                       depth()};
  for (const auto& [name, text] : properties) {
    ParamStruct& param = effect->param(name);
    write_value(param, offered_of(param), text);
  }
  auto source = pixels_in(frame.depth, image.samples), output = source;
  ClipStruct &from = *effect->clip(clip::kSource), &to = *effect->clip(clip::kOutput);
  set_clip(from, frame, output);  // both clips have the output's memory until the frame is rendered
  set_clip(to, frame, output);
  PropertySetStruct preferences, region_in, region_out, interest_in, interest_out;
  region_in.put<double>(name::kTime, {frame.time});
  frame.set_scale(region_in);
  interest_in = region_in;
  interest_in.put<double>(name::kRegionOfInterest,
                          {0.0, 0.0, frame.width * frame.pixel_aspect, static_cast<double>(frame.height)});
  call(action::kGetClipPreferences, *effect, nullptr, &preferences);
  call(action::kGetRegionOfDefinition, *effect, &region_in, &region_out);
  call(action::kGetRegionsOfInterest, *effect, &interest_in, &interest_out);
  PropertySetStruct sequence = sequence_arguments(frame), arguments = render_arguments(frame);
  call("OfxImageEffectActionBeginSequenceRender", *effect, &sequence);
  set_clip(from, frame, source);
  set_clip(to, frame, output);
  call(action::kRender, *effect, &arguments);
  call("OfxImageEffectActionEndSequenceRender", *effect, &sequence);
  plugin_->main_entry(action::kDestroyInstance, effect.get(), nullptr, nullptr);
  samples_from(frame.depth, output, image.samples);
}

}  // namespace contrejour::openfx
