#include "render/driver/registry.h"

#include <algorithm>
#include <array>

#include "render/adaptive/adaptive.h"
#include "render/bundle/bundle.h"
#include "render/reference/reference.h"
#include "render/tiled/tiled.h"

namespace contrejour {

std::span<const Method> all_methods() {
  static constexpr std::array kMethods{kAdaptive, kBundle, kTiled, kReference};
  return kMethods;
}

const Method* find_method(std::string_view name) {
  const auto all = all_methods();
  const auto found = std::ranges::find(all, name, &Method::name);
  return found == all.end() ? nullptr : &*found;
}

std::vector<std::string_view> render_methods() {
  std::vector<std::string_view> names;
  for (const Method& method : all_methods()) names.push_back(method.name);
  return names;
}

std::optional<MethodTraits> method_traits(std::string_view method) {
  const Method* const known = find_method(method);
  return known != nullptr ? std::optional(known->traits) : std::nullopt;
}

}  // namespace contrejour
