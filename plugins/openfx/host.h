// SPDX-License-Identifier: Apache-2.0
// The host's functions, and property sets read with care: hosts leave out whatever is newer than they are, so every
// read may find nothing. Thread-safety: as the host's functions.
#pragma once

#include <optional>
#include <string>

#include "openfx/openfx_abi.h"

namespace contrejour::openfx {

class Properties {
 public:
  Properties() = default;
  Properties(const PropertySuite* suite, PropertySetHandle set) : suite_(suite), set_(set) {}

  [[nodiscard]] explicit operator bool() const { return set_ != nullptr; }
  [[nodiscard]] PropertySetHandle handle() const { return set_; }

  // Empty where the host has no such property.
  [[nodiscard]] std::optional<int> integer(const char* property, int index = 0) const;
  [[nodiscard]] std::optional<double> real(const char* property, int index = 0) const;
  [[nodiscard]] std::optional<std::string> text(const char* property, int index = 0) const;
  [[nodiscard]] void* pointer(const char* property) const;
  [[nodiscard]] std::optional<RectI> rectangle(const char* property) const;

  // A host that does not know a property refuses it, which is no fault.
  void set(const char* property, int value, int index = 0) const;
  void set(const char* property, double value, int index = 0) const;
  void set(const char* property, const char* value, int index = 0) const;
  void set(const char* property, const std::string& value, int index = 0) const { set(property, value.c_str(), index); }
  void set(const char* property, void* value, int index = 0) const;
  void set(const char* property, const RectD& value) const;

 private:
  const PropertySuite* suite_ = nullptr;
  PropertySetHandle set_ = nullptr;
};

struct Host {
  std::string name;
  const PropertySuite* properties = nullptr;
  const ImageEffectSuite* effects = nullptr;
  const ParameterSuite* parameters = nullptr;
  // Null where the host has none.
  const MultiThreadSuite* threads = nullptr;
  const MessageSuite* messages = nullptr;
  const InteractSuite* interacts = nullptr;
  const DrawSuite* drawing = nullptr;
  bool has_persistent_messages = false;

  // Empty if the host lacks one of the three suites without which nothing works.
  [[nodiscard]] static std::optional<Host> create(const HostTable* table);

  // MLT (read in its version 7.41, src/modules/openfx) differs from the standard in ways that pictures depend on.
  [[nodiscard]] bool is_mlt() const { return name == "MLT"; }

  [[nodiscard]] Properties of(PropertySetHandle set) const { return {properties, set}; }
  [[nodiscard]] Properties of(EffectHandle effect) const;
  // The number of threads that the host grants; 0 if it does not say.
  [[nodiscard]] int granted_threads() const;
};

}  // namespace contrejour::openfx
