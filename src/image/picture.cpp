// SPDX-License-Identifier: Apache-2.0
// Functions of pictures, and the choice of the format.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

#include <ImfChromaticitiesAttribute.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include "base/lower_extension.h"
#include "image/formats.h"
#include "image/luminance_chroma.h"
#include "image/picture_header.h"
#include "image/rgb_spaces.h"
#include "image/samples.h"

namespace contrejour::inline internal {
namespace {

constexpr double kMaxPixelAspect = 10.0;  // anamorphic plates have 2; the minimum is its inverse
constexpr double kChromaticityTolerance = 2e-3;  // files round chromaticities to three or four digits

template <class Action>
void change_header(Picture& picture, Action action) {
  auto changed = picture.header ? std::make_shared<PictureHeader>(*picture.header) : std::make_shared<PictureHeader>();
  action(changed->header);
  picture.header = std::move(changed);
}

bool near(const Imath::V2f& a, const std::array<double, 2>& b) {
  return std::abs(a.x - b[0]) < kChromaticityTolerance && std::abs(a.y - b[1]) < kChromaticityTolerance;
}

bool near(const Imf::Chromaticities& a, const Primaries& b) {
  return near(a.red, b.red) && near(a.green, b.green) && near(a.blue, b.blue) && near(a.white, b.white);
}

Imath::V2f vector_of(const std::array<double, 2>& xy) { return {static_cast<float>(xy[0]), static_cast<float>(xy[1])}; }

bool starts_with(std::span<const std::byte> bytes, std::initializer_list<unsigned char> magic) {
  return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin(),
                                                    [](unsigned char a, std::byte b) { return std::byte{a} == b; });
}

enum class Format { OpenExr, Png };

// Recognises a format by its first bytes.
Result<Format> format_of(std::span<const std::byte> bytes, const std::string& name) {
  if (bytes.empty()) return failure(ErrorCode::Parse, "the file is empty", {name});
  if (starts_with(bytes, {0x76, 0x2f, 0x31, 0x01})) return Format::OpenExr;
  if (starts_with(bytes, {0x89, 'P', 'N', 'G'})) return Format::Png;
  return failure(ErrorCode::Parse, "neither an OpenEXR nor a PNG file; convert it to one of these", {name});
}

// Reads no more than the first bytes of a file that is no picture: a device may be endless.
Result<std::vector<std::byte>> read_bytes(const std::filesystem::path& file, std::uint64_t max_bytes) {
  const SourcePosition position{file.string()};
  std::error_code error;
  if (std::filesystem::is_directory(file, error))
    return failure(ErrorCode::Io, "this is a folder; give a picture's name", position);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return failure(ErrorCode::Io, std::string("cannot open: ") + std::strerror(errno), position);
  // Reads in pieces: a pipe has no size, and that of a file may be wrong (/dev/zero).
  constexpr std::size_t kPiece = std::size_t{1} << 20, kMagic = 4;
  const std::uintmax_t expected = std::filesystem::file_size(file, error);
  std::vector<std::byte> bytes;
  if (!error && expected <= max_bytes) bytes.reserve(static_cast<std::size_t>(expected) + 1);
  bytes.resize(kMagic);
  stream.read(reinterpret_cast<char*>(bytes.data()), kMagic);
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  if (const auto format = format_of(bytes, position.file); !format) return tl::unexpected(format.error());
  while (stream) {
    const std::size_t have = bytes.size();
    const std::size_t step = bytes.capacity() > have ? std::min(kPiece, bytes.capacity() - have) : kPiece;
    bytes.resize(have + step);
    stream.read(reinterpret_cast<char*>(bytes.data() + have), static_cast<std::streamsize>(step));
    bytes.resize(have + static_cast<std::size_t>(stream.gcount()));
    if (bytes.size() > max_bytes)
      return failure(ErrorCode::Unsupported, fmt::format("the file is larger than {} bytes", max_bytes), position);
  }
  if (stream.bad()) return failure(ErrorCode::Io, "cannot read", position);
  return bytes;
}

// Checks what the writers rely on: the image fills the window, and each channel has its samples, or is one of the
// image's.
Result<void> check_picture(const Picture& picture) {
  const PixelWindow& window = picture.data_window;
  const auto wrong = [](const char* what) { return failure(ErrorCode::InvalidArgument, what); };
  if (window.width < 1 || window.height < 1 || picture.rgb.channels != 3 || picture.rgb.width != window.width ||
      picture.rgb.height != window.height || picture.rgb.pixels.size() != 3 * sample_count(window, 1, 1))
    return wrong("the picture is empty or its image does not fill its window");
  for (const int source : picture.rgb_source)
    if (source < 0 || static_cast<std::size_t>(source) >= picture.channels.size())
      return wrong("the picture has no channels for its colours");
  for (std::size_t k = 0; k < picture.channels.size(); ++k) {
    const PictureChannel& channel = picture.channels[k];
    if (channel.x_sampling < 1 || channel.y_sampling < 1) return wrong("a channel's sampling must be 1 or more");
    const std::size_t bytes = sample_count(window, channel.x_sampling, channel.y_sampling) * size_of(channel.type);
    const bool is_colour = rgb_component(picture, k) >= 0;
    if (is_colour && channel.x_sampling * channel.y_sampling != 1) return wrong("a colour channel is subsampled");
    if (channel.samples.size() != bytes && !(is_colour && channel.samples.empty()))
      return wrong("a channel does not fill the picture's window");
  }
  if (!is_luminance_chroma(picture)) return {};
  for (const int source : picture.chroma_source)
    if (source < 0 || static_cast<std::size_t>(source) >= picture.channels.size() || source == picture.rgb_source[0])
      return wrong("the picture has no channels for its chroma");
  const bool is_one = picture.rgb_source[0] == picture.rgb_source[1] && picture.rgb_source[0] == picture.rgb_source[2];
  const PictureChannel& luminance = picture.channels[static_cast<std::size_t>(picture.rgb_source[0])];
  if (!is_one || luminance.samples.empty() || !has_chroma_sizes(picture))
    return wrong("the picture's chroma has not half the size of its luminance");
  return {};
}

}  // namespace

Imf::Header header_of(const Picture& picture) { return picture.header ? picture.header->header : Imf::Header(); }

Imf::Header without_attribute(const Imf::Header& header, const std::string& name) {
  if (header.find(name) == header.end()) return header;
  Imf::Header rest;
  for (auto i = header.begin(); i != header.end(); ++i)
    if (name != i.name()) rest.insert(i.name(), i.attribute());
  return rest;
}

}  // namespace contrejour::inline internal

namespace contrejour {

Result<Picture> read_picture(std::span<const std::byte> bytes, const std::string& name, const ReadOptions& options) {
  const auto format = format_of(bytes, name);
  if (!format) return tl::unexpected(format.error());
  if (*format == Format::OpenExr) return read_exr(bytes, name, options);
  if (!options.layer.empty() || !options.part.empty())
    return failure(ErrorCode::Unsupported, "a PNG has neither layers nor parts", {name});
  return read_png(bytes, name, options.limits);
}

Result<Picture> read_picture(const std::filesystem::path& file, const ReadOptions& options) {
  try {
    const Result<std::vector<std::byte>> bytes = read_bytes(file, options.limits.max_bytes);
    if (!bytes) return tl::unexpected(bytes.error());
    return read_picture(*bytes, file.string(), options);
  } catch (const std::exception& e) {
    return failure(ErrorCode::Io, std::string("cannot read: ") + e.what(), {file.string()});
  }
}

Picture picture_of(const Image& image, SampleType type) {
  Picture picture;
  if (image.width < 1 || image.height < 1 || image.channels < 1 || image.pixels.size() != image.index(0, image.height))
    return picture;
  picture.data_window = picture.display_window = {0, 0, image.width, image.height};
  picture.rgb = Image(image.width, image.height, 3);
  const std::size_t channels = static_cast<std::size_t>(image.channels);
  const std::size_t count = picture.rgb.pixels.size() / 3;
  const bool grey = channels < 3;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < 3; ++c) picture.rgb.pixels[3 * i + c] = image.pixels[i * channels + (grey ? 0 : c)];
  if (grey) {
    picture.channels.push_back({"Y", type, 1, 1, false, {}});
    picture.rgb_source = {0, 0, 0};
    return picture;
  }
  for (const char* name : {"R", "G", "B"}) picture.channels.push_back({name, type, 1, 1, false, {}});
  picture.rgb_source = {0, 1, 2};
  if (channels > 3) {
    PictureChannel alpha{"A", type, 1, 1, false, std::vector<std::byte>(count * size_of(type))};
    for (std::size_t i = 0; i < count; ++i)
      encode_sample(type, Coding::Linear, image.pixels[i * channels + 3], alpha.samples.data() + i * size_of(type));
    picture.channels.push_back(std::move(alpha));
  }
  return picture;
}

std::optional<ColourSpace> colour_space_of(const Picture& picture) {
  if (!picture.header || !Imf::hasChromaticities(picture.header->header)) return ColourSpace::Rec709;
  const Imf::Chromaticities& found = Imf::chromaticities(picture.header->header);
  for (const ColourSpace space : {ColourSpace::Rec709, ColourSpace::AcesCg})
    if (near(found, primaries_of(space))) return space;
  return std::nullopt;
}

void set_colour_space(Picture& picture, ColourSpace space) {
  const Primaries& p = primaries_of(space);
  change_header(picture, [&](Imf::Header& header) {
    Imf::addChromaticities(header, {vector_of(p.red), vector_of(p.green), vector_of(p.blue), vector_of(p.white)});
  });
}

double pixel_aspect_of(const Picture& picture) {
  const double aspect = picture.header ? static_cast<double>(picture.header->header.pixelAspectRatio()) : 1.0;
  return aspect >= 1.0 / kMaxPixelAspect && aspect <= kMaxPixelAspect ? aspect : 1.0;
}

void set_pixel_aspect(Picture& picture, double aspect) {
  if (!(aspect >= 1.0 / kMaxPixelAspect && aspect <= kMaxPixelAspect)) return;
  change_header(picture, [&](Imf::Header& header) { header.pixelAspectRatio() = static_cast<float>(aspect); });
}

std::optional<std::string> text_attribute(const Picture& picture, const std::string& name) {
  if (!picture.header) return std::nullopt;
  const auto* found = picture.header->header.findTypedAttribute<Imf::StringAttribute>(name);
  return found == nullptr ? std::nullopt : std::optional(found->value());
}

void set_text_attribute(Picture& picture, const std::string& name, const std::string& text) {
  constexpr std::size_t kLongestName = 255;
  if (name.empty() || name.size() > kLongestName || name.find('\0') != std::string::npos) return;
  change_header(picture, [&](Imf::Header& header) {
    header = without_attribute(header, name);
    header.insert(name, Imf::StringAttribute(text));
  });
}

std::vector<std::string> attribute_names(const Picture& picture) {
  std::vector<std::string> names;
  if (!picture.header) return names;
  for (auto i = picture.header->header.begin(); i != picture.header->header.end(); ++i) names.emplace_back(i.name());
  return names;
}

Result<void> write_picture(const std::filesystem::path& file, const Picture& picture, const Context& context) {
  return write_whole(file, [&](OutputFile& out) { return write_picture(out, picture, context); });
}

Result<void> write_picture(OutputFile& file, const Picture& picture, const Context& context) {
  const std::string extension = lower_extension(file.destination());
  const SourcePosition position{file.destination().string()};
  if (auto sound = check_picture(picture); !sound) {
    sound.error().position = position;
    return sound;
  }
  try {
    if (extension == ".exr") return write_picture_exr(file, picture, context);
    if (extension == ".png") return write_picture_png(file, picture, context);
  } catch (const std::exception& e) {
    return failure(ErrorCode::Io, std::string("cannot write: ") + e.what(), position);
  }
  return failure(ErrorCode::InvalidArgument, fmt::format("cannot write pictures as '{}'; use .exr or .png", extension),
                 position);
}

Result<void> write_exr(const std::filesystem::path& file, const Image& image, SampleType type, const Context& context) {
  if (image.width <= 0 || image.height <= 0 || image.pixels.size() != image.index(0, image.height))
    return failure(ErrorCode::InvalidArgument, "the image is empty", {file.string()});
  try {
    const Picture picture = picture_of(image, type);
    return write_whole(file, [&](OutputFile& out) { return write_picture_exr(out, picture, context); });
  } catch (const std::exception& e) {
    return failure(ErrorCode::Io, std::string("cannot write: ") + e.what(), {file.string()});
  }
}

}  // namespace contrejour
