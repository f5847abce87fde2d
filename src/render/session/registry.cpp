// SPDX-License-Identifier: Apache-2.0
#include "render/session/registry.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "render/adaptive/adaptive.h"
#include "render/bundle/bundle.h"
#include "render/polynomial/polynomial.h"
#include "render/reference/reference.h"
#include "render/tiled/tiled.h"

namespace contrejour::inline internal {

std::span<const Method> all_methods() {
  static constexpr std::array kMethods{kAdaptive, kPolynomial, kBundle, kTiled, kReference};
  return kMethods;
}

const Method* find_method(std::string_view name) {
  const auto all = all_methods();
  const auto found = std::ranges::find(all, name, &Method::name);
  return found == all.end() ? nullptr : &*found;
}

Result<const Method*> known_method(std::string_view name) {
  if (const Method* const known = find_method(name)) return known;
  return failure(ErrorCode::InvalidArgument,
                 fmt::format("there is no method '{}'; choose one of {}", name, fmt::join(render_methods(), ", ")));
}

}  // namespace contrejour::inline internal

namespace contrejour {

std::vector<std::string_view> render_methods() {
  std::vector<std::string_view> names;
  for (const Method& method : all_methods()) names.push_back(method.name);
  return names;
}

std::optional<MethodTraits> method_traits(std::string_view method) {
  const Method* const known = find_method(method);
  return known != nullptr ? std::optional(known->traits) : std::nullopt;
}

Result<MethodOptions> method_options(std::string_view method) {
  const auto known = known_method(method);
  if (!known) return tl::unexpected(known.error());
  return (*known)->default_options();
}

}  // namespace contrejour
