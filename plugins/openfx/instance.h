// SPDX-License-Identifier: Apache-2.0
// An instance of the effect, and what all instances share while the plug-in is loaded. All state that a project keeps
// is in the host's parameters. Thread-safety: what an action calls may be called on several threads at once.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "openfx/engine_pool.h"
#include "openfx/host.h"
#include "openfx/host_abort.h"
#include "openfx/parameter_list.h"

namespace contrejour::openfx {

[[nodiscard]] EffectContext context_of(const std::string& name);
// Hosts of which the pixels are mostly coded for a display.
[[nodiscard]] bool is_display_referred(const Host& host);

// From the first load on, until the last unload and the end of the last instance.
struct LoadedPlugin {
  explicit LoadedPlugin(Host the_host);

  Host host;
  std::array<std::vector<ParamSpec>, 3> parameters;  // by context
  EnginePool engines;
  AbortableRuns runs;  // behind the engines, which they use until they end

  [[nodiscard]] const std::vector<ParamSpec>& parameters_in(EffectContext context) const {
    return parameters[static_cast<std::size_t>(context)];
  }
};

class Instance {
 public:
  Instance(std::shared_ptr<LoadedPlugin> loaded, EffectHandle effect);

  [[nodiscard]] LoadedPlugin& loaded() const { return *loaded_; }
  [[nodiscard]] const Host& host() const { return loaded_->host; }
  [[nodiscard]] EffectHandle effect() const { return effect_; }
  [[nodiscard]] Properties properties() const { return host().of(effect_); }
  [[nodiscard]] ParamSetHandle parameter_set() const { return parameter_set_; }
  [[nodiscard]] const std::vector<ParamSpec>& specs() const { return loaded_->parameters_in(context_); }
  // Null where the host did not make the parameter. k: of specs().
  [[nodiscard]] ParamHandle handle(std::size_t k) const { return handles_[k]; }
  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;

  // Null for a clip that this context lacks.
  [[nodiscard]] ClipHandle clip(const char* name) const;
  [[nodiscard]] bool is_connected(ClipHandle clip) const;

  // Shows a fault to the user, once until it changes; an empty text takes it away.
  void show_fault(const std::string& text);

 private:
  std::shared_ptr<LoadedPlugin> loaded_;
  EffectHandle effect_;
  EffectContext context_ = EffectContext::Filter;
  ParamSetHandle parameter_set_ = nullptr;
  std::vector<ParamHandle> handles_;
  std::mutex fault_mutex_;
  std::string fault_;
};

// The instance of an effect; null before it is created and after it is destroyed.
[[nodiscard]] Instance* instance_of(const Host& host, EffectHandle effect);

}  // namespace contrejour::openfx
