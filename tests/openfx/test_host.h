// SPDX-License-Identifier: Apache-2.0
// A host of OpenFX plug-ins for tests: loads the built bundle and plays a host's part by the written standard, or the
// part of hosts that keep less of it.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "openfx/openfx_abi.h"

namespace contrejour::openfx {

using PropertyValue = std::variant<int, double, std::string, void*>;

// The properties that a host has.
struct KnownProperties {
  std::set<std::string> refused = {};
  std::set<std::string> declared = {};  // if there are any, all others are refused

  [[nodiscard]] bool has(const std::string& property) const {
    return !refused.contains(property) && (declared.empty() || declared.contains(property));
  }
};

struct PropertySetStruct {
  std::map<std::string, std::vector<PropertyValue>> values;
  const KnownProperties* known = nullptr;  // null: all

  template <class T>
  void put(const std::string& name, std::initializer_list<T> all) {
    values[name] = std::vector<PropertyValue>(all.begin(), all.end());
  }
  template <class T>
  [[nodiscard]] T get(const std::string& name, std::size_t index = 0, T otherwise = {}) const {
    const auto found = values.find(name);
    if (found == values.end() || index >= found->second.size()) return otherwise;
    const T* value = std::get_if<T>(&found->second[index]);
    return value != nullptr ? *value : otherwise;
  }
  [[nodiscard]] std::size_t count(const std::string& name) const {
    const auto found = values.find(name);
    return found == values.end() ? 0 : found->second.size();
  }
};

struct ParamStruct {
  std::string name, type;
  PropertySetStruct properties;
  std::vector<double> numbers;
  std::string text;
  std::map<double, std::vector<double>> keys;  // steps from one to the next

  [[nodiscard]] bool is_whole() const;
  [[nodiscard]] const std::vector<double>& at(double time) const;
};

struct ParamSetStruct {
  PropertySetStruct properties;
  std::vector<std::unique_ptr<ParamStruct>> params;  // in the order of definition
  [[nodiscard]] ParamStruct* find(const std::string& name) const;
};

// Pixels as a host may lay them out.
struct HostPicture {
  RectI bounds{};
  int channels = 4;
  std::string depth = value::kFloat;
  int row_bytes = 0;  // negative: the memory's last row is the lowest
  std::vector<std::byte> memory;
  double pixel_aspect = 1.0;

  enum class Rows { Packed, Padded, Upwards };  // Upwards: negative row bytes
  static HostPicture of(RectI bounds, int channels = 4, bool is_half = false, Rows rows = Rows::Packed);
  [[nodiscard]] int width() const { return bounds.x2 - bounds.x1; }
  [[nodiscard]] int height() const { return bounds.y2 - bounds.y1; }
  [[nodiscard]] std::size_t sample_bytes() const { return depth == value::kHalf ? 2 : 4; }
  [[nodiscard]] std::byte* lowest_row();
  [[nodiscard]] std::byte* sample(int x, int y, int c);
  [[nodiscard]] float at(int x, int y, int c);  // floats, and halves converted
  void set(int x, int y, int c, float value);
};

struct ClipStruct {
  std::string name;
  PropertySetStruct properties;
  struct EffectStruct* effect = nullptr;
  HostPicture* picture = nullptr;  // null: not connected
};

struct EffectStruct {
  PropertySetStruct properties;
  ParamSetStruct params;
  std::vector<std::unique_ptr<ClipStruct>> clips;
  std::function<int()> aborts;
  std::atomic<int> images_out = 0;
  std::mutex message_mutex;
  std::string message;  // the persistent one
  int messages = 0;
  double scale = 1.0;  // of the images that clips give

  [[nodiscard]] ClipStruct* clip(const std::string& name) const;
  [[nodiscard]] ParamStruct& param(const std::string& name) const;
  void set(const std::string& name, std::vector<double> numbers) const { param(name).numbers = std::move(numbers); }
  void set_text(const std::string& name, std::string text) const { param(name).text = std::move(text); }
  void choose(const std::string& name, const std::string& option) const;
};

// A viewer's interact, and what was drawn in it: the suite's handle to the drawing.
struct InteractStruct {
  PropertySetStruct properties;
};
struct DrawContextStruct {
  std::vector<PointD> points;
};

// The first plug-in of the built bundle, loaded as hosts load it.
[[nodiscard]] const PluginTable* open_plugin();

struct HostOptions {
  std::string name = "org.contrejour.TestHost";
  std::set<std::string> missing_suites = {};  // by name and version: "OfxMessageSuite2"
  KnownProperties known_properties = {};
  bool passes_context = true;  // to DescribeInContext; false: the host's own properties, as one host does
};

struct RenderArguments {
  double time = 1.0;
  RectI window{};
  double scale = 1.0;
  bool is_interactive = false;
};

// Loads the plug-in with a host of its own, and unloads it at the end.
class TestHost {
 public:
  explicit TestHost(HostOptions options = {});
  ~TestHost();
  TestHost(const TestHost&) = delete;
  TestHost& operator=(const TestHost&) = delete;

  [[nodiscard]] const PluginTable& plugin() const { return *plugin_; }
  [[nodiscard]] Status load_status() const { return load_status_; }

  Status act(const char* action, EffectStruct* effect, PropertySetStruct* in = nullptr,
             PropertySetStruct* out = nullptr) const;

  // A descriptor, described in a context.
  [[nodiscard]] std::unique_ptr<EffectStruct> describe(const char* context) const;
  // An instance in a project of this size, with all parameters at their defaults.
  [[nodiscard]] std::unique_ptr<EffectStruct> create(const char* context, double width, double height) const;
  // The same without kOfxActionCreateInstance.
  [[nodiscard]] std::unique_ptr<EffectStruct> populate(const char* context, double width, double height) const;
  void destroy(EffectStruct& effect) const { act(action::kDestroyInstance, &effect); }
  [[nodiscard]] Status render(EffectStruct& effect, const RenderArguments& arguments) const;

  static const void* fetch_suite(PropertySetHandle host, const char* name, int version);

 private:
  struct Properties : PropertySetStruct {
    const TestHost* host = nullptr;
  };
  HostOptions options_;
  Properties properties_;
  HostTable table_{};
  const PluginTable* plugin_ = nullptr;
  Status load_status_ = status::kFailed;
};

}  // namespace contrejour::openfx
