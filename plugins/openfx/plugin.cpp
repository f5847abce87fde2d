// SPDX-License-Identifier: Apache-2.0
// The functions that a host looks up in the binary, and the entry point of all actions. Nothing is thrown out of them.
#include <memory>
#include <mutex>
#include <new>
#include <string_view>
#include <utility>

#include "openfx/actions.h"
#include "openfx/overlay.h"

#if defined(_WIN32)
#define CONTREJOUR_OPENFX_EXPORT extern "C" __declspec(dllexport)
#else
#define CONTREJOUR_OPENFX_EXPORT extern "C" __attribute__((visibility("default")))
#endif

namespace contrejour::openfx {
namespace {

// The standard passes neither the host nor a plug-in's data to an action, so both have to be kept here. Never
// destroyed: a host may end its process with instances alive.
struct Entry {
  std::mutex mutex;
  const HostTable* host = nullptr;
  int loads = 0;
  std::shared_ptr<LoadedPlugin> loaded;
};

Entry& entry() {
  static Entry* const the_entry = new Entry;
  return *the_entry;
}

// Hosts load more often than they unload, and some not at all before the first action.
std::shared_ptr<LoadedPlugin> loaded_plugin() {
  Entry& state = entry();
  const std::lock_guard lock(state.mutex);
  if (state.loaded) return state.loaded;
  auto host = Host::create(state.host);
  if (host) state.loaded = std::make_shared<LoadedPlugin>(std::move(*host));
  return state.loaded;
}

Status load_plugin() {
  if (!loaded_plugin()) return status::kErrMissingHostFeature;
  Entry& state = entry();
  const std::lock_guard lock(state.mutex);
  ++state.loads;
  return status::kOk;
}

Status unload_plugin() {
  Entry& state = entry();
  std::shared_ptr<LoadedPlugin> last;  // destroyed without the lock
  const std::lock_guard lock(state.mutex);
  if (state.loads > 0 && --state.loads == 0) last.swap(state.loaded);
  return status::kOk;
}

Status create_instance(const std::shared_ptr<LoadedPlugin>& loaded, EffectHandle effect) {
  const Properties properties = loaded->host.of(effect);
  if (!properties) return status::kErrBadHandle;
  auto instance = std::make_unique<Instance>(loaded, effect);
  properties.set(name::kInstanceData, static_cast<void*>(instance.release()));
  return status::kOk;
}

Status destroy_instance(const Host& host, EffectHandle effect) {
  const std::unique_ptr<Instance> instance(instance_of(host, effect));
  host.of(effect).set(name::kInstanceData, static_cast<void*>(nullptr));
  return status::kOk;
}

Status act_on(Instance& instance, std::string_view action, const Properties& in, const Properties& out) {
  if (action == action::kRender) return render(instance, in);
  if (action == action::kIsIdentity) return is_identity(instance, in, out);
  if (action == action::kGetRegionOfDefinition) return region_of_definition(instance, in, out);
  if (action == action::kGetRegionsOfInterest) return regions_of_interest(instance, in, out);
  if (action == action::kGetClipPreferences) return clip_preferences(instance, out);
  if (action == action::kInstanceChanged) return instance_changed(instance, in);
  return status::kReplyDefault;
}

bool is_of_instance(std::string_view action) {
  for (const char* const known : {action::kRender, action::kIsIdentity, action::kGetRegionOfDefinition,
                                  action::kGetRegionsOfInterest, action::kGetClipPreferences, action::kInstanceChanged})
    if (action == known) return true;
  return false;
}

Status overlay_entry(const char* action, const void* handle, PropertySetHandle in, PropertySetHandle out);
Status overlay_entry_v2(const char* action, const void* handle, PropertySetHandle in, PropertySetHandle out);

Status act(std::string_view action, EffectHandle effect, PropertySetHandle in, PropertySetHandle out) {
  if (action == action::kLoad) return load_plugin();
  if (action == action::kUnload) return unload_plugin();
  const auto loaded = loaded_plugin();
  if (!loaded) return status::kErrMissingHostFeature;
  const Host& host = loaded->host;
  if (action == action::kDescribe) return describe(host, effect, {&overlay_entry, &overlay_entry_v2});
  if (action == action::kDescribeInContext) return describe_in_context(*loaded, effect, host.of(in));
  if (action == action::kCreateInstance) return create_instance(loaded, effect);
  if (action == action::kDestroyInstance) return destroy_instance(host, effect);
  if (action == action::kPurgeCaches) {
    loaded->engines.clear();
    return status::kOk;
  }
  if (action == action::kSyncPrivateData) return status::kOk;  // the parameters hold everything
  if (!is_of_instance(action)) return status::kReplyDefault;
  Instance* const instance = instance_of(host, effect);
  if (instance == nullptr) return status::kErrBadHandle;
  return act_on(*instance, action, host.of(in), host.of(out));
}

// Calls a function that may throw, as no host must see.
template <class Function>
Status guarded(const Function& function) {
  try {
    return function();
  } catch (const std::bad_alloc&) {
    return status::kErrMemory;
  } catch (...) {
    return status::kFailed;
  }
}

Status overlay_act(const char* action, const void* handle, PropertySetHandle in, bool has_draw_suite) {
  if (action == nullptr) return status::kErrValue;
  return guarded([&] {
    const auto loaded = loaded_plugin();
    if (!loaded || loaded->host.interacts == nullptr) return status::kErrMissingHostFeature;
    const auto interact = static_cast<InteractHandle>(const_cast<void*>(handle));
    return act_on_overlay(loaded->host, action, interact, loaded->host.of(in), has_draw_suite);
  });
}

Status overlay_entry(const char* action, const void* handle, PropertySetHandle in, PropertySetHandle /*out*/) {
  return overlay_act(action, handle, in, false);
}

Status overlay_entry_v2(const char* action, const void* handle, PropertySetHandle in, PropertySetHandle /*out*/) {
  return overlay_act(action, handle, in, true);
}

Status main_entry(const char* action, const void* handle, PropertySetHandle in, PropertySetHandle out) {
  if (action == nullptr) return status::kErrValue;
  return guarded([&] { return act(action, static_cast<EffectHandle>(const_cast<void*>(handle)), in, out); });
}

void set_host(HostTable* host) {
  Entry& state = entry();
  const std::lock_guard lock(state.mutex);
  state.host = host;
}

PluginTable& plugin_table() {
  static PluginTable table{kImageEffectApi, 1, kPluginIdentifier, 1, 0, &set_host, &main_entry};
  return table;
}

}  // namespace
}  // namespace contrejour::openfx

CONTREJOUR_OPENFX_EXPORT int OfxGetNumberOfPlugins() { return 1; }

CONTREJOUR_OPENFX_EXPORT contrejour::openfx::PluginTable* OfxGetPlugin(int nth) {
  return nth == 0 ? &contrejour::openfx::plugin_table() : nullptr;
}

// A host that knows this function calls it before all others; it may then be another host than the last.
CONTREJOUR_OPENFX_EXPORT int OfxSetHost(const contrejour::openfx::HostTable* host) {
  if (host != nullptr) contrejour::openfx::set_host(const_cast<contrejour::openfx::HostTable*>(host));
  return contrejour::openfx::status::kOk;
}
