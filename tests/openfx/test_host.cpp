// SPDX-License-Identifier: Apache-2.0
#include "test_host.h"

#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <dlfcn.h>
#include <half.h>

#include "host_suites.h"

namespace contrejour::openfx {
namespace {

template <class Function>
Function symbol_of(void* library, const char* name) {
  return reinterpret_cast<Function>(dlsym(library, name));
}

void* library() {
  const char* const other = std::getenv("CONTREJOUR_OPENFX_PLUGIN");
  void* const opened = dlopen(other != nullptr ? other : CONTREJOUR_OPENFX_PLUGIN, RTLD_LAZY | RTLD_LOCAL);
  if (opened == nullptr) throw std::runtime_error(dlerror());
  return opened;
}

std::size_t components_of(const std::string& type) {
  if (type == type::kDouble2D) return 2;
  if (type == type::kRgb) return 3;
  return type == type::kString || type == type::kGroup || type == type::kPushButton ? 0 : 1;
}

// A parameter of an instance starts at its descriptor's default.
std::unique_ptr<ParamStruct> instance_of(const ParamStruct& described) {
  auto param = std::make_unique<ParamStruct>();
  param->name = described.name;
  param->type = described.type;
  param->properties = described.properties;
  for (std::size_t k = 0; k < components_of(described.type); ++k)
    param->numbers.push_back(described.is_whole() ? described.properties.get<int>(name::kDefault, k)
                                                  : described.properties.get<double>(name::kDefault, k));
  param->text = described.properties.get<std::string>(name::kDefault);
  return param;
}

}  // namespace

const PluginTable* open_plugin() { return symbol_of<PluginTable* (*)(int)>(library(), "OfxGetPlugin")(0); }

bool ParamStruct::is_whole() const { return type == type::kInteger || type == type::kBoolean || type == type::kChoice; }

const std::vector<double>& ParamStruct::at(double time) const {
  if (keys.empty()) return numbers;
  auto after = keys.upper_bound(time);
  return after == keys.begin() ? after->second : std::prev(after)->second;
}

ParamStruct* ParamSetStruct::find(const std::string& name) const {
  for (const auto& param : params)
    if (param->name == name) return param.get();
  return nullptr;
}

HostPicture HostPicture::of(RectI bounds, int channels, bool is_half, Rows rows) {
  HostPicture picture;
  picture.bounds = bounds;
  picture.channels = channels;
  picture.depth = is_half ? value::kHalf : value::kFloat;
  const int packed = picture.width() * channels * static_cast<int>(picture.sample_bytes());
  const int bytes = rows == Rows::Packed ? packed : packed + 20;
  picture.row_bytes = rows == Rows::Upwards ? -bytes : bytes;
  picture.memory.resize(static_cast<std::size_t>(bytes) * static_cast<std::size_t>(picture.height()));
  return picture;
}

std::byte* HostPicture::lowest_row() {
  return row_bytes >= 0 ? memory.data() : memory.data() + static_cast<std::ptrdiff_t>(height() - 1) * -row_bytes;
}

std::byte* HostPicture::sample(int x, int y, int c) {
  const std::ptrdiff_t in_row = static_cast<std::ptrdiff_t>(x - bounds.x1) * channels + c;
  return lowest_row() + static_cast<std::ptrdiff_t>(y - bounds.y1) * row_bytes +
         in_row * static_cast<std::ptrdiff_t>(sample_bytes());
}

float HostPicture::at(int x, int y, int c) {
  if (depth == value::kHalf) {
    half sample_value;
    std::memcpy(&sample_value, sample(x, y, c), sizeof sample_value);
    return sample_value;
  }
  float sample_value = 0.0F;
  std::memcpy(&sample_value, sample(x, y, c), sizeof sample_value);
  return sample_value;
}

void HostPicture::set(int x, int y, int c, float number) {
  const half as_half(number);
  if (depth == value::kHalf)
    std::memcpy(sample(x, y, c), &as_half, sizeof as_half);
  else
    std::memcpy(sample(x, y, c), &number, sizeof number);
}

ClipStruct* EffectStruct::clip(const std::string& name) const {
  for (const auto& clip : clips)
    if (clip->name == name) return clip.get();
  return nullptr;
}

ParamStruct& EffectStruct::param(const std::string& name) const {
  ParamStruct* const found = params.find(name);
  if (found == nullptr) throw std::runtime_error("no parameter " + name);
  return *found;
}

void EffectStruct::choose(const std::string& name, const std::string& option) const {
  ParamStruct& chosen = param(name);
  for (std::size_t k = 0; k < chosen.properties.count(name::kChoiceOption); ++k)
    if (chosen.properties.get<std::string>(name::kChoiceOption, k) == option)
      return void(chosen.numbers = {static_cast<double>(k)});
  throw std::runtime_error(name + " has no choice " + option);
}

TestHost::TestHost(HostOptions options) : options_(std::move(options)) {
  properties_.host = this;
  properties_.put<std::string>(name::kName, {options_.name});
  properties_.put<std::string>(name::kType, {"OfxTypeImageEffectHost"});
  table_ = {&properties_, &TestHost::fetch_suite};
  plugin_ = open_plugin();
  plugin_->set_host(&table_);
  load_status_ = act(action::kLoad, nullptr);
}

TestHost::~TestHost() {
  if (load_status_ == status::kOk) act(action::kUnload, nullptr);
}

const void* TestHost::fetch_suite(PropertySetHandle host, const char* name, int version) {
  const TestHost& self = *static_cast<Properties*>(host)->host;
  const std::string wanted = name + std::to_string(version);
  if (self.options_.missing_suites.contains(wanted)) return nullptr;
  if (wanted == "OfxPropertySuite1") return &property_suite();
  if (wanted == "OfxParameterSuite1") return &parameter_suite();
  if (wanted == "OfxImageEffectSuite1") return &effect_suite();
  if (wanted == "OfxMultiThreadSuite1") return &thread_suite();
  if (wanted == "OfxInteractSuite1") return &interact_suite();
  if (wanted == "OfxDrawSuite1") return &draw_suite();
  if (wanted == "OfxMessageSuite2" || wanted == "OfxMessageSuite1") return &message_suite();
  return nullptr;
}

Status TestHost::act(const char* action, EffectStruct* effect, PropertySetStruct* in, PropertySetStruct* out) const {
  return plugin_->main_entry(action, effect, in, out);
}

std::unique_ptr<EffectStruct> TestHost::describe(const char* context) const {
  auto effect = std::make_unique<EffectStruct>();
  effect->properties.known = &options_.known_properties;
  effect->params.properties.known = &options_.known_properties;
  PropertySetStruct in;
  in.put<std::string>(name::kContext, {context});
  PropertySetStruct host = properties_;
  if (act(action::kDescribe, effect.get()) != status::kOk ||
      act(action::kDescribeInContext, effect.get(), options_.passes_context ? &in : &host) != status::kOk)
    throw std::runtime_error("the plug-in did not describe itself");
  return effect;
}

std::unique_ptr<EffectStruct> TestHost::create(const char* context, double width, double height) const {
  auto effect = populate(context, width, height);
  if (act(action::kCreateInstance, effect.get()) != status::kOk) throw std::runtime_error("no instance was created");
  return effect;
}

std::unique_ptr<EffectStruct> TestHost::populate(const char* context, double width, double height) const {
  const auto descriptor = describe(context);
  auto effect = std::make_unique<EffectStruct>();
  effect->properties.known = &options_.known_properties;
  effect->properties.put<std::string>(name::kContext, {context});
  effect->properties.put<double>(name::kProjectSize, {width, height});
  effect->properties.put<double>(name::kProjectOffset, {0.0, 0.0});
  effect->properties.put<double>(name::kProjectPixelAspectRatio, {1.0});
  for (const auto& param : descriptor->params.params) effect->params.params.push_back(instance_of(*param));
  for (const auto& described : descriptor->clips) {
    auto clip = std::make_unique<ClipStruct>();
    clip->name = described->name;
    clip->effect = effect.get();
    effect->clips.push_back(std::move(clip));
  }
  return effect;
}

Status TestHost::render(EffectStruct& effect, const RenderArguments& arguments) const {
  PropertySetStruct in;
  in.known = &options_.known_properties;
  in.put<double>(name::kTime, {arguments.time});
  const RectI& window = arguments.window;
  in.put<int>(name::kRenderWindow, {window.x1, window.y1, window.x2, window.y2});
  in.put<double>(name::kRenderScale, {arguments.scale, arguments.scale});
  in.put<int>(name::kInteractiveRender, {arguments.is_interactive ? 1 : 0});
  return act(action::kRender, &effect, &in);
}

}  // namespace contrejour::openfx
