// SPDX-License-Identifier: Apache-2.0
#include "openfx/host.h"

namespace contrejour::openfx {

std::optional<int> Properties::integer(const char* property, int index) const {
  int value = 0;
  if (set_ == nullptr || suite_->get_int(set_, property, index, &value) != status::kOk) return std::nullopt;
  return value;
}

std::optional<double> Properties::real(const char* property, int index) const {
  double value = 0.0;
  if (set_ == nullptr || suite_->get_double(set_, property, index, &value) != status::kOk) return std::nullopt;
  return value;
}

std::optional<std::string> Properties::text(const char* property, int index) const {
  char* value = nullptr;
  if (set_ == nullptr || suite_->get_string(set_, property, index, &value) != status::kOk || value == nullptr)
    return std::nullopt;
  return std::string(value);
}

void* Properties::pointer(const char* property) const {
  void* value = nullptr;
  if (set_ == nullptr || suite_->get_pointer(set_, property, 0, &value) != status::kOk) return nullptr;
  return value;
}

std::optional<RectI> Properties::rectangle(const char* property) const {
  int sides[4];
  for (int k = 0; k < 4; ++k) {
    const auto side = integer(property, k);
    if (!side) return std::nullopt;
    sides[k] = *side;
  }
  return RectI{sides[0], sides[1], sides[2], sides[3]};
}

void Properties::set(const char* property, int value, int index) const {
  if (set_ != nullptr) suite_->set_int(set_, property, index, value);
}

void Properties::set(const char* property, double value, int index) const {
  if (set_ != nullptr) suite_->set_double(set_, property, index, value);
}

void Properties::set(const char* property, const char* value, int index) const {
  if (set_ != nullptr) suite_->set_string(set_, property, index, value);
}

void Properties::set(const char* property, void* value, int index) const {
  if (set_ != nullptr) suite_->set_pointer(set_, property, index, value);
}

void Properties::set(const char* property, const RectD& value) const {
  const double sides[] = {value.x1, value.y1, value.x2, value.y2};
  for (int k = 0; k < 4; ++k) set(property, sides[k], k);
}

std::optional<Host> Host::create(const HostTable* table) {
  if (table == nullptr || table->fetch_suite == nullptr) return std::nullopt;
  const auto fetch = [&]<class Suite>(const Suite*& suite, int version) {
    suite = static_cast<const Suite*>(table->fetch_suite(table->host, Suite::kName, version));
    return suite != nullptr;
  };
  Host host;
  if (!fetch(host.properties, 1) || !fetch(host.effects, 1) || !fetch(host.parameters, 1)) return std::nullopt;
  fetch(host.threads, 1);
  fetch(host.interacts, 1);
  fetch(host.drawing, 1);
  host.has_persistent_messages = fetch(host.messages, 2);
  if (!host.has_persistent_messages) fetch(host.messages, 1);
  host.name = host.of(table->host).text(name::kName).value_or("");
  return host;
}

Properties Host::of(EffectHandle effect) const {
  PropertySetHandle set = nullptr;
  if (effect == nullptr || effects->get_property_set(effect, &set) != status::kOk) return {};
  return of(set);
}

int Host::granted_threads() const {
  unsigned int count = 0;
  constexpr unsigned int kMost = 1024;
  if (threads == nullptr || threads->cpu_count(&count) != status::kOk || count > kMost) return 0;
  return static_cast<int>(count);
}

}  // namespace contrejour::openfx
