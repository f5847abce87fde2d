#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "contrejour/render.h"
#include "render/adaptive/adaptive.h"
#include "render/bundle/bundle.h"
#include "render/reference/reference.h"
#include "render/tiled/tiled.h"

namespace contrejour {
namespace {

struct Method {
  std::string_view name;
  Result<Flare> (*render)(const LensState&, std::span<const Light>, const RenderSettings&, const Context&);
};

// The default first.
constexpr std::array kMethods{Method{"adaptive", render_adaptive}, Method{"bundle", render_bundle},
                              Method{"tiled", render_tiled}, Method{"reference", render_reference}};

}  // namespace

std::vector<std::string_view> render_methods() {
  std::vector<std::string_view> names;
  for (const Method& method : kMethods) names.push_back(method.name);
  return names;
}

Result<Flare> render(std::string_view method, const LensState& lens, std::span<const Light> lights,
                     const RenderSettings& settings, const Context& context) {
  for (const Method& known : kMethods) {
    if (known.name == method) return known.render(lens, lights, settings, context);
  }
  return failure(ErrorCode::InvalidArgument,
                 fmt::format("there is no method '{}'; choose one of {}", method, fmt::join(render_methods(), ", ")));
}

}  // namespace contrejour
