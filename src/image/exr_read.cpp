// OpenEXR -> Picture: docs/formats/images.md.
#include <algorithm>
#include <cstring>
#include <new>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <ImfVersion.h>
#include <fmt/format.h>

#include "image/exr_attributes.h"
#include "image/exr_limits.h"
#include "image/exr_streams.h"
#include "image/formats.h"
#include "image/picture_header.h"
#include "image/samples.h"

namespace contrejour {
namespace {

constexpr std::size_t kVersionOffset = 4, kAttributesOffset = 8;

struct CheckedHeader {
  Imf::Header header;
  std::size_t size = 0;
};

// All that can be known to be wrong before anything of the picture's size is allocated.
Result<CheckedHeader> read_header(std::span<const std::byte> bytes, const std::string& name, std::size_t size,
                                  const ReadLimits& limits) {
  CheckedHeader checked;
  checked.size = size;
  std::uint32_t version_field = 0;
  for (std::size_t i = 0; i < 4; ++i)
    version_field |= std::to_integer<std::uint32_t>(bytes[kVersionOffset + i]) << (8 * i);
  int version = static_cast<int>(version_field);
  MemoryInput stream(bytes, name);
  stream.seekg(kAttributesOffset);
  checked.header.readFrom(stream, version);
  checked.header.sanityCheck(Imf::isTiled(version));
  // The version field decides what an attribute alone does not.
  if (!Imf::isTiled(version)) checked.header = without_attribute(checked.header, "tiles");
  if (checked.header.hasType() && Imf::isDeepData(checked.header.type()))
    return failure(ErrorCode::Unsupported, "deep OpenEXR pictures are not read; flatten it first", {name});
  const Result<void> fits = check_exr_size(checked.header, checked.size, bytes.size(), limits, name);
  if (!fits) return tl::unexpected(fits.error());
  return checked;
}

// All channels of an InputFile or an InputPart.
template <class File>
void read_channels(File& file, Picture& picture) {
  const Imath::Box2i window = file.header().dataWindow();
  Imf::FrameBuffer frame_buffer;
  for (auto i = file.header().channels().begin(); i != file.header().channels().end(); ++i) {
    const Imf::Channel& in = i.channel();
    PictureChannel channel{i.name(), sample_type_of(in.type), in.xSampling, in.ySampling, in.pLinear, {}};
    channel.samples.resize(sample_count(picture.data_window, in.xSampling, in.ySampling) * size_of(channel.type));
    frame_buffer.insert(i.name(),
                        Imf::Slice::Make(in.type, channel.samples.data(), window, 0, 0, in.xSampling, in.ySampling));
    picture.channels.push_back(std::move(channel));
  }
  file.setFrameBuffer(frame_buffer);
  file.readPixels(window.min.y, window.max.y);
}

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

// A picture of one channel is grey, whatever its name, if that is none of what is no light.
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

std::optional<std::array<int, 3>> colour_channels(const Picture& picture, const std::string& layer) {
  const std::string prefix = layer.empty() ? "" : layer + ".";
  if (const auto rgb = triple(picture, prefix)) return rgb;
  if (const int grey = index_of(picture, prefix + "Y"); grey >= 0) return std::array<int, 3>{grey, grey, grey};
  if (!layer.empty()) return std::nullopt;
  if (const int grey = only_channel(picture); grey >= 0) return std::array<int, 3>{grey, grey, grey};
  for (const PictureChannel& channel : picture.channels) {  // in the order of their names
    const std::size_t dot = channel.name.rfind('.');
    if (dot == std::string::npos) continue;
    if (const auto rgb = triple(picture, channel.name.substr(0, dot + 1))) return rgb;
  }
  return std::nullopt;
}

std::string list_of_names(const Picture& picture) {
  std::string list;
  for (const PictureChannel& channel : picture.channels) {
    if (list.size() > 200) return list + " ...";
    list += (list.empty() ? "" : ", ") + channel.name;
  }
  return list;
}

// Luminance and half-size chroma become R, G, B halves, as OpenEXR's own reader makes them.
void convert_luminance_chroma(std::span<const std::byte> bytes, const std::string& name, Picture& picture) {
  MemoryInput stream(bytes, name);
  Imf::RgbaInputFile file(stream);
  const Imath::Box2i window = file.dataWindow();
  const std::size_t count = sample_count(picture.data_window, 1, 1);
  std::vector<Imf::Rgba> pixels(count);
  const auto width = static_cast<std::ptrdiff_t>(picture.data_window.width);
  file.setFrameBuffer(pixels.data() - window.min.x - window.min.y * width, 1, static_cast<std::size_t>(width));
  file.readPixels(window.min.y, window.max.y);
  std::erase_if(picture.channels,
                [](const PictureChannel& c) { return c.name == "Y" || c.name == "RY" || c.name == "BY"; });
  constexpr half Imf::Rgba::* kComponents[] = {&Imf::Rgba::r, &Imf::Rgba::g, &Imf::Rgba::b};
  constexpr const char* kNames[] = {"R", "G", "B"};
  for (std::size_t c = 0; c < 3; ++c) {
    PictureChannel channel{kNames[c], SampleType::Half, 1, 1, false, std::vector<std::byte>(2 * count)};
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint16_t bits = (pixels[i].*kComponents[c]).bits();
      std::memcpy(channel.samples.data() + 2 * i, &bits, sizeof bits);
    }
    picture.channels.push_back(std::move(channel));
  }
}

Result<void> fill_rgb(const std::string& name, const std::string& layer, Picture& picture) {
  const auto found = colour_channels(picture, layer);
  if (!found)
    return failure(ErrorCode::Unsupported,
                   fmt::format("no colour in {}; its channels are {}",
                               layer.empty() ? "the picture" : "layer '" + layer + "'", list_of_names(picture)),
                   {name});
  picture.rgb_source = *found;
  picture.rgb = Image(picture.data_window.width, picture.data_window.height, 3);
  const bool grey = (*found)[0] == (*found)[2];
  for (std::size_t c = 0; c < 3; ++c) {
    const PictureChannel& channel = picture.channels[static_cast<std::size_t>((*found)[c])];
    if (channel.x_sampling != 1 || channel.y_sampling != 1)
      return failure(ErrorCode::Unsupported,
                     fmt::format("colour channel '{}' is subsampled; save it at full size", channel.name), {name});
    if (grey && c > 0) break;
    const std::vector<float> values = decode_samples(channel, Coding::Colour);
    for (std::size_t i = 0; i < values.size(); ++i)
      for (std::size_t to = c; to < (grey ? 3 : c + 1); ++to) picture.rgb.pixels[3 * i + to] = values[i];
  }
  return {};
}

Picture empty_picture(const Imf::Header& header) {
  Picture picture;
  picture.data_window = window_of(header.dataWindow());
  picture.display_window = window_of(header.displayWindow());
  return picture;
}

Result<Picture> read_single(std::span<const std::byte> bytes, const std::string& name, std::size_t header_size,
                            const ReadOptions& options) {
  Result<CheckedHeader> checked = read_header(bytes, name, header_size, options.limits);
  if (!checked) return tl::unexpected(checked.error());
  Picture picture = empty_picture(checked->header);
  MemoryInput stream(bytes, name);
  Imf::InputFile file(stream);
  read_channels(file, picture);
  const bool chroma = index_of(picture, "Y") >= 0 && index_of(picture, "RY") >= 0 && index_of(picture, "BY") >= 0;
  if (options.layer.empty() && chroma && index_of(picture, "R") < 0) convert_luminance_chroma(bytes, name, picture);
  picture.header = std::make_shared<PictureHeader>(PictureHeader{std::move(checked->header)});
  const Result<void> filled = fill_rgb(name, options.layer, picture);
  if (!filled) return tl::unexpected(filled.error());
  return picture;
}

// A picture that has a part's channels, without samples: for what asks only for their names.
Picture names_of(const Imf::Header& header) {
  Picture picture = empty_picture(header);
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i)
    picture.channels.push_back({i.name(),
                                sample_type_of(i.channel().type),
                                i.channel().xSampling,
                                i.channel().ySampling,
                                i.channel().pLinear,
                                {}});
  return picture;
}

struct ChosenPart {
  int part = 0;
  std::string layer;  // of it
};

// The first flat part with colour; with a layer the part of that name, or the first that has it.
Result<ChosenPart> choose_part(const Imf::MultiPartInputFile& file, const std::string& name, const std::string& layer) {
  std::string names;
  for (int part = 0; part < file.parts(); ++part) {
    const Imf::Header& header = file.header(part);
    const std::string own = header.hasName() ? header.name() : std::string();
    if (names.size() < 200) names += (names.empty() ? "" : ", ") + own;
    if (header.hasType() && Imf::isDeepData(header.type())) continue;
    const Picture channels = names_of(header);
    if (!layer.empty() && own == layer && colour_channels(channels, "")) return ChosenPart{part, ""};
    if (colour_channels(channels, layer)) return ChosenPart{part, layer};
  }
  return failure(ErrorCode::Unsupported,
                 fmt::format("no colour in {}; the file's parts are {}",
                             layer.empty() ? "any flat part" : "layer '" + layer + "'", names),
                 {name});
}

Result<Picture> read_part(std::span<const std::byte> bytes, const std::string& name, std::size_t header_size,
                          const ReadOptions& options) {
  MemoryInput stream(bytes, name);
  Imf::MultiPartInputFile file(stream);
  const auto chosen = choose_part(file, name, options.layer);
  if (!chosen) return tl::unexpected(chosen.error());
  const Imf::Header& header = file.header(chosen->part);
  if (const auto fits = check_exr_size(header, header_size, bytes.size(), options.limits, name); !fits)
    return tl::unexpected(fits.error());
  Picture picture = empty_picture(header);
  Imf::InputPart part(file, chosen->part);
  read_channels(part, picture);
  const auto parts = std::make_shared<const PictureParts>(PictureParts{{bytes.begin(), bytes.end()}, chosen->part});
  picture.header = std::make_shared<PictureHeader>(PictureHeader{header, parts});
  const Result<void> filled = fill_rgb(name, chosen->layer, picture);
  if (!filled) return tl::unexpected(filled.error());
  return picture;
}

Result<Picture> read(std::span<const std::byte> bytes, const std::string& name, const ReadOptions& options) {
  const auto size = check_exr_header(bytes, name);
  if (!size) return tl::unexpected(size.error());
  return size->is_multi_part ? read_part(bytes, name, size->bytes, options)
                             : read_single(bytes, name, size->bytes, options);
}

}  // namespace

Result<Picture> read_exr(std::span<const std::byte> bytes, const std::string& name, const ReadOptions& options) {
  try {
    return read(bytes, name, options);
  } catch (const std::bad_alloc&) {
    return failure(ErrorCode::Io, "not enough memory for this picture", {name});
  } catch (const std::exception& e) {
    return failure(ErrorCode::Parse, fmt::format("the OpenEXR file is damaged: {}", e.what()), {name});
  } catch (...) {
    return failure(ErrorCode::Parse, "the OpenEXR file is damaged", {name});
  }
}

}  // namespace contrejour
