// SPDX-License-Identifier: Apache-2.0
#include "image/exr_choice.h"

#include <algorithm>
#include <vector>

#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfPartType.h>
#include <fmt/format.h>

#include "image/exr_limits.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kLongestList = 200;  // of names in a message

int index_of(const Picture& picture, const std::string& name) {
  const auto found = std::find_if(picture.channels.begin(), picture.channels.end(),
                                  [&](const PictureChannel& channel) { return channel.name == name; });
  return found == picture.channels.end() ? -1 : static_cast<int>(found - picture.channels.begin());
}

std::optional<std::array<int, 3>> triple(const Picture& picture, const std::string& prefix) {
  static constexpr std::array<std::array<const char*, 3>, 3> kNames = {
      {{"R", "G", "B"}, {"r", "g", "b"}, {"red", "green", "blue"}}};
  for (const auto& names : kNames) {
    const std::array<int, 3> found = {index_of(picture, prefix + names[0]), index_of(picture, prefix + names[1]),
                                      index_of(picture, prefix + names[2])};
    if (*std::min_element(found.begin(), found.end()) >= 0) return found;
  }
  return std::nullopt;
}

// A picture of one channel is grey, whatever the channel's name, unless it names something other than light.
int only_channel(const Picture& picture) {
  int only = -1;
  for (std::size_t k = 0; k < picture.channels.size(); ++k) {
    const std::string& name = picture.channels[k].name;
    if (name == "A" || name == "alpha") continue;
    const bool is_no_light =
        name == "Z" || name == "ZBack" || name == "depth" || name == "id" || name == "RY" || name == "BY";
    if (only >= 0 || is_no_light) return -1;
    only = static_cast<int>(k);
  }
  return only;
}

ColourChannels grey_of(int channel) { return {{channel, channel, channel}, {-1, -1}}; }

// R, G, B or luminance with this prefix.
std::optional<ColourChannels> colours_of(const Picture& picture, const std::string& prefix) {
  if (const auto rgb = triple(picture, prefix)) return ColourChannels{*rgb, {-1, -1}};
  const int luminance = index_of(picture, prefix + "Y");
  if (luminance < 0) return std::nullopt;
  ColourChannels colours = grey_of(luminance);
  const std::array<int, 2> chroma = {index_of(picture, prefix + "RY"), index_of(picture, prefix + "BY")};
  if (chroma[0] >= 0 && chroma[1] >= 0) colours.chroma = chroma;
  return colours;
}

std::string prefix_of(const PictureChannel& channel) {
  const std::size_t dot = channel.name.rfind('.');
  return dot == std::string::npos ? "" : channel.name.substr(0, dot + 1);
}

// Joins names by commas, truncated if the list gets too long.
std::string list_of(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) {
    if (list.size() > kLongestList) return list + " ...";
    list += (list.empty() ? "" : ", ") + name;
  }
  return list;
}

// The layers that can be chosen.
std::vector<std::string> layers_of(const Picture& picture) {
  std::vector<std::string> layers;
  for (const PictureChannel& channel : picture.channels) {
    const std::string prefix = prefix_of(channel);
    if (prefix.empty() || !colours_of(picture, prefix)) continue;
    const std::string layer = prefix.substr(0, prefix.size() - 1);
    if (std::find(layers.begin(), layers.end(), layer) == layers.end()) layers.push_back(layer);
  }
  return layers;
}

// A picture with a part's channels but no samples, for functions that need only their names.
Picture names_of(const Imf::Header& header) {
  Picture picture;
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i)
    picture.channels.push_back({i.name(),
                                sample_type_of(i.channel().type),
                                i.channel().xSampling,
                                i.channel().ySampling,
                                i.channel().pLinear,
                                {}});
  return picture;
}

bool is_deep(const Imf::Header& header) { return header.hasType() && Imf::isDeepData(header.type()); }

std::string part_name(const Imf::Header& header) { return header.hasName() ? header.name() : std::string(); }

// "0 depth, 1 beauty (layers key, fill)", of every part.
std::string list_of_parts(std::span<const Imf::Header* const> parts) {
  std::vector<std::string> texts;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    const Imf::Header& header = *parts[part];
    const Picture channels = names_of(header);
    std::string text = fmt::format("{} {}", part, part_name(header));
    if (is_deep(header)) {
      text += " (deep)";
    } else if (!colour_channels(channels, "")) {
      text += " (no colour)";
    } else if (const std::string layers = list_of(layers_of(channels)); !layers.empty()) {
      text += " (layers " + layers + ")";
    }
    texts.push_back(text);
  }
  return list_of(texts);
}

// Finds a part by its name, else by its number from 0.
std::optional<std::size_t> wanted_part(std::span<const Imf::Header* const> parts, const std::string& wanted) {
  for (std::size_t part = 0; part < parts.size(); ++part)
    if (part_name(*parts[part]) == wanted) return part;
  for (std::size_t part = 0; part < parts.size(); ++part)
    if (std::to_string(part) == wanted) return part;
  return std::nullopt;
}

}  // namespace

std::optional<ColourChannels> colour_channels(const Picture& picture, const std::string& layer) {
  if (!layer.empty()) return colours_of(picture, layer + ".");
  if (const auto own = colours_of(picture, "")) return own;
  if (const int grey = only_channel(picture); grey >= 0) return grey_of(grey);
  for (const PictureChannel& channel : picture.channels) {  // in the order of their names
    const std::string prefix = prefix_of(channel);
    if (prefix.empty()) continue;
    if (const auto rgb = triple(picture, prefix)) return ColourChannels{*rgb, {-1, -1}};
  }
  return std::nullopt;
}

tl::unexpected<Error> no_colour(const Picture& picture, const std::string& layer, const std::string& name) {
  std::vector<std::string> channels;
  for (const PictureChannel& channel : picture.channels) channels.push_back(channel.name);
  if (layer.empty())
    return failure(ErrorCode::Unsupported,
                   fmt::format("no colour in the picture; its channels are {}", list_of(channels)), {name});
  const std::string layers = list_of(layers_of(picture));
  return failure(
      ErrorCode::Unsupported,
      layers.empty()
          ? fmt::format("no colour in layer '{}'; the picture has no layers with colour, its channels are {}", layer,
                        list_of(channels))
          : fmt::format("no colour in layer '{}'; the picture's layers with colour are {}", layer, layers),
      {name});
}

Result<ChosenPart> choose_part(std::span<const Imf::Header* const> parts, const std::string& name,
                               const ReadOptions& options) {
  const auto wrong = [&](const std::string& what) {
    return failure(ErrorCode::Unsupported, fmt::format("{}; the file's parts are {}", what, list_of_parts(parts)),
                   {name});
  };
  const std::string& layer = options.layer;
  std::size_t first = 0, end = parts.size();
  if (!options.part.empty()) {
    const auto part = wanted_part(parts, options.part);
    if (!part) return wrong(fmt::format("no part '{}'", options.part));
    if (is_deep(*parts[*part])) return wrong(fmt::format("part '{}' is deep", options.part));
    first = *part;
    end = first + 1;
  }
  for (std::size_t part = first; part < end; ++part) {
    const Imf::Header& header = *parts[part];
    if (is_deep(header)) continue;
    const Picture channels = names_of(header);
    if (colour_channels(channels, layer)) return ChosenPart{static_cast<int>(part), layer};
    // A part may also serve as a layer.
    if (!layer.empty() && part_name(header) == layer && colour_channels(channels, ""))
      return ChosenPart{static_cast<int>(part), ""};
  }
  const std::string where = options.part.empty() ? "any flat part" : "part '" + options.part + "'";
  return wrong(layer.empty() ? "no colour in " + where : fmt::format("no layer '{}' in {}", layer, where));
}

Result<void> check_only_part(const Imf::Header& header, const std::string& name, const ReadOptions& options) {
  const Imf::Header* const only[] = {&header};
  if (options.part.empty() || wanted_part(only, options.part)) return {};
  return failure(ErrorCode::Unsupported,
                 fmt::format("no part '{}'; the file has one part, {}", options.part,
                             header.hasName() ? "0 " + header.name() : "0"),
                 {name});
}

}  // namespace contrejour::inline internal
