// SPDX-License-Identifier: Apache-2.0
// Pictures in files: OpenEXR (flat, scan lines or tiles, any channels; colour is read from the first part that has it,
// other parts are kept as they are) and PNG (8 and 16 bit). A Picture keeps all that its file holds, so that writing it
// back changes only the samples whose rgb value was changed; every other sample keeps its bits, NaN included. In
// luminance-chroma files with chroma of half the size, chroma within 13 pixels of a change is filtered anew.
// docs/formats/images.md says what is kept and what not. Errors: Io, Parse (damaged file), Unsupported (deep, no
// colour, no such layer or part, subsampled colour), Cancelled; position.file is set. No exception leaves. A failed or
// cancelled write leaves no file. Thread-safety: pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/colour.h"
#include "contrejour/export.h"
#include "contrejour/image.h"
#include "contrejour/result.h"

namespace contrejour {

class OutputFile;

// Pixels x in [x, x + width), y in [y, y + height); the origin may be anywhere, also negative.
struct PixelWindow {
  int x = 0, y = 0;
  int width = 0, height = 0;
  friend bool operator==(const PixelWindow&, const PixelWindow&) = default;
};

enum class SampleType { Half, Float, UInt32, UInt8, UInt16 };  // the last two in PNG only, colour coded as sRGB
[[nodiscard]] CONTREJOUR_API std::size_t size_of(SampleType type);

// A channel as stored in its file: native-endian samples, rows from the top, over the data window.
struct PictureChannel {
  std::string name;
  SampleType type = SampleType::Half;
  int x_sampling = 1, y_sampling = 1;  // > 1: pixels per sample
  bool perceptually_linear = false;  // OpenEXR's pLinear, a hint to its lossy codecs
  std::vector<std::byte> samples;
};

inline namespace internal {
struct PictureHeader;  // an OpenEXR file's attributes, kept whole
}

// The codec of an OpenEXR file that is written; all of these are lossless. AsRead: that of the picture's own file if it
// is lossless, else Zip. None and Rle take a fraction of the time of the others, for files of floats that are up to
// half as large again.
enum class ExrCompression { AsRead, None, Rle, Zips, Zip, Piz };

struct Picture {
  Image rgb;  // scene-linear, three channels, over the data window; change this
  PixelWindow data_window;  // where rgb lies
  PixelWindow display_window;
  std::vector<PictureChannel> channels;  // every channel as it was read, those behind rgb included
  std::array<int, 3> rgb_source{-1, -1, -1};  // the channels that r, g, b come from; all the same one for a grey
                                              // picture
  std::array<int, 2> chroma_source{-1, -1};  // chroma of half the size, (R - Y) / Y and (B - Y) / Y; rgb_source is then
                                             // Y
  std::shared_ptr<const PictureHeader> header;  // null: not from an OpenEXR file
  ExrCompression exr_compression = ExrCompression::AsRead;
};

// Limits that a reader checks before it allocates; a larger file is refused.
struct ReadLimits {
  std::uint64_t max_pixels = std::uint64_t{1} << 28;  // in the data window
  std::uint64_t max_bytes = std::uint64_t{8} << 30;  // of all channels, uncompressed; and of the file
};

struct ReadOptions {
  // Colour from LAYER.R, .G, .B, or from the part of this name; empty: R, G, B, else Y, else the only channel there is,
  // else the first layer with R, G, B.
  std::string layer;
  ReadLimits limits;
  // The part to read from a file with several, by its name or its number from 0; empty: the first with that colour.
  std::string part = {};
};

// Reads a picture; the content determines the format, not the name.
[[nodiscard]] CONTREJOUR_API Result<Picture> read_picture(const std::filesystem::path& file,
                                                          const ReadOptions& options = {});
[[nodiscard]] CONTREJOUR_API Result<Picture> read_picture(std::span<const std::byte> bytes, const std::string& name,
                                                          const ReadOptions& options = {});

// Makes a picture from an image with 1 (grey), 3 or 4 (RGB and alpha) channels, both windows at the origin; an invalid
// image gives an empty picture.
[[nodiscard]] CONTREJOUR_API Picture picture_of(const Image& image, SampleType type = SampleType::Float);

// The working space the file's chromaticities name: Rec709 when it has none, nothing when it is another one.
[[nodiscard]] CONTREJOUR_API std::optional<ColourSpace> colour_space_of(const Picture& picture);
CONTREJOUR_API void set_colour_space(Picture& picture, ColourSpace space);  // writes the chromaticities attribute

// Displayed width over height of the pixels; 1 if the file does not state it, or states a value outside 0.1 to 10.
[[nodiscard]] CONTREJOUR_API double pixel_aspect_of(const Picture& picture);
CONTREJOUR_API void set_pixel_aspect(Picture& picture,
                                     double aspect);  // writes the pixelAspectRatio attribute; from 0.1 to 10

// Text attributes of an OpenEXR file, e.g. "comments"; setting replaces one of any type, and does
// nothing for a name that is none (1 to 255 bytes).
[[nodiscard]] CONTREJOUR_API std::optional<std::string> text_attribute(const Picture& picture, const std::string& name);
CONTREJOUR_API void set_text_attribute(Picture& picture, const std::string& name, const std::string& text);
[[nodiscard]] CONTREJOUR_API std::vector<std::string> attribute_names(const Picture& picture);

// Writes by the extension: .exr, or .png as sRGB (colours clipped to 0..1; 8 bit if it came from 8 bit, else 16).
[[nodiscard]] CONTREJOUR_API Result<void> write_picture(const std::filesystem::path& file, const Picture& picture,
                                                        const Context& context = {});
// Into a file that the caller commits (output_file.h), together with others if need be.
[[nodiscard]] CONTREJOUR_API Result<void> write_picture(OutputFile& file, const Picture& picture,
                                                        const Context& context = {});
[[nodiscard]] CONTREJOUR_API Result<void> write_exr(const std::filesystem::path& file, const Image& image,
                                                    SampleType type = SampleType::Float, const Context& context = {});

// An 8-bit sRGB PNG to look at. NaN and negative values show as black.
struct PreviewSettings {
  double exposure_stops = 0;  // values times 2^stops
  bool roll_off_highlights = true;  // bends values above 0.8 towards 1 instead of clipping them
};
[[nodiscard]] CONTREJOUR_API Result<void> write_preview_png(const std::filesystem::path& file, const Image& rgb,
                                                            const PreviewSettings& settings = {},
                                                            const Context& context = {});
[[nodiscard]] CONTREJOUR_API Result<void> write_preview_png(OutputFile& file, const Image& rgb,
                                                            const PreviewSettings& settings = {},
                                                            const Context& context = {});
// As above, but returns the PNG in memory, for embedding.
[[nodiscard]] CONTREJOUR_API Result<std::vector<std::byte>> preview_png(const Image& rgb,
                                                                        const PreviewSettings& settings = {},
                                                                        const Context& context = {});

}  // namespace contrejour
