// SPDX-License-Identifier: Apache-2.0
// Colour spaces by OpenColorIO: between a space of a configuration and scene-linear ACEScg or Rec.709.
#include <algorithm>
#include <cctype>
#include <exception>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "plate_modules/aces_config.h"
#include "plates/colour_module.h"

namespace contrejour::inline internal {
namespace {

namespace ocio = OCIO_NAMESPACE;

constexpr int kMaxListed = 40;

ocio::ConstConfigRcPtr open_config(const std::string& name) {
  return name.empty() ? aces_config() : ocio::Config::CreateFromFile(name.c_str());
}

std::string spaces_of(const ocio::Config& config) {
  std::vector<std::string> names;
  for (int k = 0; k < std::min(kMaxListed, config.getNumColorSpaces()); ++k)
    names.emplace_back(config.getColorSpaceNameByIndex(k));
  const int rest = config.getNumColorSpaces() - static_cast<int>(names.size());
  return fmt::format("{}{}", fmt::join(names, ", "), rest > 0 ? fmt::format(" and {} others", rest) : "");
}

// The configuration's name of ACES2065-1, by which its spaces are related to those of other configurations.
std::optional<std::string> interchange_of(const ocio::Config& config) {
  for (const char* name : {"aces_interchange", "ACES2065-1", "ACES - ACES2065-1", "lin_ap0"})
    if (const auto space = config.getColorSpace(name)) return space->getName();
  return std::nullopt;
}

// The working space that a scene-linear space is by its name.
std::optional<ColourSpace> known_linear(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  const auto has = [&](const char* part) { return name.find(part) != std::string::npos; };
  if (has("acescg") || has("ap1")) return ColourSpace::AcesCg;
  if (has("709") || has("srgb") || name == "linear") return ColourSpace::Rec709;
  return std::nullopt;
}

tl::unexpected<Error> unknown_linear() {
  return failure(ErrorCode::Unsupported,
                 "the configuration has no role aces_interchange, and its role scene_linear is neither ACEScg nor "
                 "linear Rec.709; add the role aces_interchange to it");
}

// From a space to the working space, and which one that is.
struct ToWorking {
  ocio::GroupTransformRcPtr transform = ocio::GroupTransform::Create();
  ColourSpace working = ColourSpace::AcesCg;
};

Result<ToWorking> to_working(const ocio::Config& config, const std::string& space) {
  ToWorking to;
  auto step = ocio::ColorSpaceTransform::Create();
  step->setSrc(space.c_str());
  to.transform->appendTransform(step);
  if (const auto interchange = interchange_of(config)) {
    step->setDst(interchange->c_str());
    auto to_acescg = ocio::BuiltinTransform::Create();
    to_acescg->setStyle("ACEScg_to_ACES2065-1");
    to_acescg->setDirection(ocio::TRANSFORM_DIR_INVERSE);
    to.transform->appendTransform(to_acescg);
    return to;
  }
  const auto linear = config.getColorSpace(ocio::ROLE_SCENE_LINEAR);
  const auto known = linear ? known_linear(linear->getName()) : std::nullopt;
  if (!known) return unknown_linear();
  step->setDst(linear->getName());
  to.working = *known;
  return to;
}

Result<ColourConversion> open(const ColourRequest& request) {
  ocio::SetLoggingLevel(ocio::LOGGING_LEVEL_NONE);
  constexpr const char* kBuiltIn = "ocio://";
  if (request.config.starts_with(kBuiltIn) && OCIO_VERSION_HEX < 0x02020000)
    return failure(ErrorCode::Unsupported,
                   fmt::format("OpenColorIO {} has no built-in configurations; leave --ocio-config and $OCIO out for "
                               "the ACES spaces and camera logs that it has, or give a file",
                               ocio::GetVersion()),
                   {request.config});
  const auto config = open_config(request.config);
  const auto space = config->getColorSpace(request.space.c_str());
  if (!space)
    return failure(ErrorCode::InvalidArgument, fmt::format("there is no colour space \"{}\"; the configuration has {}",
                                                           request.space, spaces_of(*config)));
  auto to = to_working(*config, space->getName());
  if (!to) return tl::unexpected(to.error());
  const auto direction = request.to_working ? ocio::TRANSFORM_DIR_FORWARD : ocio::TRANSFORM_DIR_INVERSE;
  const auto processor = config->getProcessor(to->transform, direction);
  // Without the approximations of logarithms and powers, which cost codes.
  const ocio::ConstCPUProcessorRcPtr cpu = processor->getOptimizedCPUProcessor(ocio::OPTIMIZATION_LOSSLESS);
  return ColourConversion{to->working, std::make_shared<const ocio::ConstCPUProcessorRcPtr>(cpu)};
}

// The working space as a view's source, and what leads there from it.
Result<ColourConversion> open_view(const std::string& name_of_config, const ColourViewName& name) {
  ocio::SetLoggingLevel(ocio::LOGGING_LEVEL_NONE);
  const auto config = open_config(name_of_config);
  if (std::string(config->getDisplayViewColorSpaceName(name.display.c_str(), name.view.c_str())).empty())
    return failure(ErrorCode::InvalidArgument,
                   fmt::format("the configuration has no view \"{}\" of a display \"{}\"", name.view, name.display),
                   {name_of_config});
  const auto interchange = interchange_of(*config);
  const auto linear = config->getColorSpace(ocio::ROLE_SCENE_LINEAR);
  const auto known = linear ? known_linear(linear->getName()) : std::nullopt;
  if (!interchange && !known) return unknown_linear();
  auto steps = ocio::GroupTransform::Create();
  if (interchange) {
    auto to_aces = ocio::BuiltinTransform::Create();
    to_aces->setStyle("ACEScg_to_ACES2065-1");
    steps->appendTransform(to_aces);
  }
  auto to_display = ocio::DisplayViewTransform::Create();
  to_display->setSrc(interchange ? interchange->c_str() : linear->getName());
  to_display->setDisplay(name.display.c_str());
  to_display->setView(name.view.c_str());
  steps->appendTransform(to_display);
  const ocio::ConstCPUProcessorRcPtr cpu = config->getProcessor(steps)->getDefaultCPUProcessor();
  return ColourConversion{interchange ? ColourSpace::AcesCg : *known,
                          std::make_shared<const ocio::ConstCPUProcessorRcPtr>(cpu)};
}

// The names with the default moved to the front.
template <class Item>
void put_first(std::vector<Item>& items, const std::string& name) {
  const auto found = std::find_if(items.begin(), items.end(), [&](const Item& item) {
    if constexpr (std::is_same_v<Item, ColourDisplay>)
      return item.name == name;
    else
      return item == name;
  });
  if (found != items.end()) std::rotate(items.begin(), found, found + 1);
}

Result<std::vector<ColourDisplay>> displays_of(const std::string& name_of_config) {
  ocio::SetLoggingLevel(ocio::LOGGING_LEVEL_NONE);
  const auto config = open_config(name_of_config);
  std::vector<ColourDisplay> displays;
  for (int k = 0; k < config->getNumDisplays(); ++k) {
    ColourDisplay display{config->getDisplay(k), {}};
    for (int v = 0; v < config->getNumViews(display.name.c_str()); ++v)
      display.views.emplace_back(config->getView(display.name.c_str(), v));
    put_first(display.views, config->getDefaultView(display.name.c_str()));
    displays.push_back(std::move(display));
  }
  put_first(displays, config->getDefaultDisplay());
  return displays;
}

Result<void> apply(const ColourConversion& conversion, float* rgb, std::size_t pixels) {
  const auto& cpu = *static_cast<const ocio::ConstCPUProcessorRcPtr*>(conversion.transform.get());
  ocio::PackedImageDesc image(rgb, static_cast<long>(pixels), 1, 3);
  cpu->apply(image);
  return {};
}

template <class Call>
auto guarded(const std::string& config, const Call& call) -> decltype(call()) {
  try {
    return call();
  } catch (const std::exception& error) {
    return failure(ErrorCode::Parse, fmt::format("OpenColorIO: {}", error.what()), {config});
  }
}

}  // namespace

extern "C" CONTREJOUR_API const ColourModule* contrejour_colour_module() {
  static const ColourModule module{
      kColourModuleVersion,
      [](const ColourRequest& request) { return guarded(request.config, [&] { return open(request); }); },
      [](const std::string& config, const ColourViewName& name) {
        return guarded(config, [&] { return open_view(config, name); });
      },
      [](const std::string& config) { return guarded(config, [&] { return displays_of(config); }); },
      [](const ColourConversion& conversion, float* rgb, std::size_t pixels) {
        return guarded("", [&] { return apply(conversion, rgb, pixels); });
      }};
  return &module;
}

}  // namespace contrejour::inline internal
