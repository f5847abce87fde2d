// SPDX-License-Identifier: Apache-2.0
#include "openfx/instance.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace contrejour::openfx {

EffectContext context_of(const std::string& name) {
  if (name == context::kGenerator) return EffectContext::Generator;
  return name == context::kGeneral ? EffectContext::General : EffectContext::Filter;
}

bool is_display_referred(const Host& host) {
  constexpr std::string_view kStarts[] = {"MLT", "DaVinciResolve", "com.vegascreativesoftware", "com.sony."};
  return std::ranges::any_of(kStarts, [&](std::string_view start) { return host.name.starts_with(start); });
}

LoadedPlugin::LoadedPlugin(Host the_host) : host(std::move(the_host)) {
  for (const auto context : {EffectContext::Filter, EffectContext::General, EffectContext::Generator})
    parameters[static_cast<std::size_t>(context)] = parameter_list(context, is_display_referred(host));
}

Instance::Instance(std::shared_ptr<LoadedPlugin> loaded, EffectHandle effect)
    : loaded_(std::move(loaded)), effect_(effect),
      context_(context_of(properties().text(name::kContext).value_or(context::kFilter))) {
  if (host().effects->get_param_set(effect, &parameter_set_) != status::kOk) parameter_set_ = nullptr;
  for (const ParamSpec& spec : specs()) {
    ParamHandle param = nullptr;
    const bool is_group = spec.type == ParamType::Group;
    if (is_group || parameter_set_ == nullptr ||
        host().parameters->get_handle(parameter_set_, spec.name.c_str(), &param, nullptr) != status::kOk)
      param = nullptr;
    handles_.push_back(param);
  }
}

std::optional<std::size_t> Instance::find(std::string_view name) const {
  const auto found = std::ranges::find(specs(), name, &ParamSpec::name);
  if (found == specs().end()) return std::nullopt;
  return static_cast<std::size_t>(found - specs().begin());
}

ClipHandle Instance::clip(const char* name) const {
  if (context_ == EffectContext::Generator && std::string_view(name) == clip::kSource) return nullptr;
  ClipHandle clip = nullptr;
  return host().effects->clip_get_handle(effect_, name, &clip, nullptr) == status::kOk ? clip : nullptr;
}

bool Instance::is_connected(ClipHandle clip) const {
  PropertySetHandle set = nullptr;
  if (clip == nullptr || host().effects->clip_get_property_set(clip, &set) != status::kOk) return false;
  return host().of(set).integer(name::kClipConnected).value_or(1) != 0;
}

void Instance::show_fault(const std::string& text) {
  const std::lock_guard lock(fault_mutex_);
  if (text == fault_) return;
  fault_ = text;
  const MessageSuite* const messages = host().messages;
  if (messages == nullptr) return;
  // The host goes on rendering, because the source passes through: a warning, not an error, after which some hosts
  // render no more. Hosts without persistent messages would open a window for each frame, so they get a log entry.
  if (host().has_persistent_messages) {
    messages->clear_persistent_message(effect_);
    if (!text.empty())
      messages->set_persistent_message(effect_, value::kMessageWarning, "contrejour", "%s", text.c_str());
  } else if (!text.empty()) {
    messages->message(effect_, value::kMessageLog, "contrejour", "%s", text.c_str());
  }
}

Instance* instance_of(const Host& host, EffectHandle effect) {
  return static_cast<Instance*>(host.of(effect).pointer(name::kInstanceData));
}

}  // namespace contrejour::openfx
