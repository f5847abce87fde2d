// SPDX-License-Identifier: Apache-2.0
#include "cli/raw_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include <fmt/format.h>

#include "cli/options.h"
#include "contrejour/expert/plate.h"

#if defined(CONTREJOUR_LIBRAW)
#include <libraw/libraw.h>
#endif

namespace contrejour::cli {
namespace {

tl::unexpected<Error> raw_failure(ErrorCode code, const std::string& message, const std::string& file) {
  return failure(code, message, {file, 0, 0});
}

double sample_at(const PictureChannel& channel, std::size_t k) {
  const auto read = [&](auto value) {
    std::memcpy(&value, channel.samples.data() + k * sizeof(value), sizeof(value));
    return value;
  };
  switch (channel.type) {
    case SampleType::UInt16: return read(std::uint16_t{});
    case SampleType::UInt32: return read(std::uint32_t{});
    case SampleType::Float: return static_cast<double>(read(float{}));
    default: return 0.0;
  }
}

Result<RawFrame> frame_of_picture(const std::string& file, const MosaicFormat& format, double time_s) {
  const auto plate = read_plate(file, {});
  if (!plate) return tl::unexpected(plate.error());
  const Picture* const picture = &plate->picture;
  const auto& channels = picture->channels;
  const bool has_type =
      channels.size() == 1 && (channels[0].type == SampleType::UInt16 || channels[0].type == SampleType::UInt32 ||
                               channels[0].type == SampleType::Float);
  if (!has_type) {
    return raw_failure(
        ErrorCode::Unsupported,
        "this is not a mosaic: give a grey PNG or TIFF of 16 bits, or an EXR with one channel of floats or "
        "unsigned integers, whose values are those of the sensor",
        file);
  }
  RawFrame frame{picture->rgb.width,
                 picture->rgb.height,
                 format.pattern,
                 format.black_dn.value_or(0.0),
                 format.white_dn.value_or(65535.0),
                 time_s,
                 {}};
  frame.dn.resize(static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height));
  for (std::size_t k = 0; k < frame.dn.size(); ++k) {
    const double dn = sample_at(channels[0], k);
    frame.dn[k] = static_cast<std::uint16_t>(std::clamp(std::round(std::isfinite(dn) ? dn : 65535.0), 0.0, 65535.0));
  }
  return frame;
}

#if defined(CONTREJOUR_LIBRAW)

constexpr double kTimesAgree = 0.2;

// The colours of a block's pixels in LibRaw's numbers: 0 red, 1 and 3 green, 2 blue.
std::optional<BayerPattern> pattern_of(LibRaw& raw) {
  int block[4];
  for (int k = 0; k < 4; ++k) block[k] = raw.COLOR(k / 2, k % 2) == 3 ? 1 : raw.COLOR(k / 2, k % 2);
  const auto is = [&](int a, int b, int c, int d) {
    return block[0] == a && block[1] == b && block[2] == c && block[3] == d;
  };
  if (is(0, 1, 1, 2)) return BayerPattern::Rggb;
  if (is(2, 1, 1, 0)) return BayerPattern::Bggr;
  if (is(1, 0, 2, 1)) return BayerPattern::Grbg;
  if (is(1, 2, 0, 1)) return BayerPattern::Gbrg;
  return std::nullopt;
}

// A pixel's own black level over the common one: its colour's, and that of a repeated block.
int own_black(LibRaw& raw, int y, int x) {
  const auto* black = raw.imgdata.color.cblack;
  unsigned own = black[raw.COLOR(y, x)];
  const unsigned rows = black[4], columns = black[5];
  if (rows > 0 && columns > 0)
    own += black[6 + static_cast<unsigned>(y) % rows * columns + static_cast<unsigned>(x) % columns];
  return static_cast<int>(own);
}

constexpr int kBlackBlock = 12;  // pixels a side, which blocks of 2, 3, 4 and 6 divide

int least_own_black(LibRaw& raw) {
  int smallest = own_black(raw, 0, 0);
  for (int k = 1; k < kBlackBlock * kBlackBlock; ++k)
    smallest = std::min(smallest, own_black(raw, k / kBlackBlock, k % kBlackBlock));
  return smallest;
}

// The mosaic of the visible area. Pixels with a higher black level of their own are moved to the common one.
RawFrame visible_frame(LibRaw& raw, BayerPattern pattern, const MosaicFormat& format, double time_s) {
  const auto& sizes = raw.imgdata.sizes;
  const auto& colour = raw.imgdata.color;
  const int smallest = least_own_black(raw);
  RawFrame frame;
  frame.width = sizes.width & ~1;
  frame.height = sizes.height & ~1;
  frame.pattern = pattern;
  frame.black_dn = format.black_dn.value_or(static_cast<double>(colour.black) + smallest);
  frame.white_dn = format.white_dn.value_or(colour.maximum);
  frame.time_s = time_s;
  frame.dn.reserve(static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height));
  for (int y = 0; y < frame.height; ++y) {
    const std::size_t row = static_cast<std::size_t>(y + sizes.top_margin) * (sizes.raw_pitch / 2);
    for (int x = 0; x < frame.width; ++x) {
      const int dn = raw.imgdata.rawdata.raw_image[row + static_cast<std::size_t>(x + sizes.left_margin)];
      const int over = format.black_dn ? 0 : own_black(raw, y, x) - smallest;
      frame.dn.push_back(static_cast<std::uint16_t>(std::clamp(dn - over, 0, 65535)));
    }
  }
  return frame;
}

Result<RawFrame> frame_of_raw(const std::string& file, const MosaicFormat& format, double time_s) {
  const auto raw = std::make_unique<LibRaw>();  // half a megabyte
  const auto opened = raw->open_file(file.c_str());
  const auto result = opened == LIBRAW_SUCCESS ? raw->unpack() : opened;
  if (result != LIBRAW_SUCCESS)
    return raw_failure(ErrorCode::Parse, fmt::format("LibRaw cannot read it: {}", libraw_strerror(result)), file);
  const auto pattern = raw->imgdata.rawdata.raw_image != nullptr ? pattern_of(*raw) : std::nullopt;
  if (!pattern) return raw_failure(ErrorCode::Unsupported, "its sensor has no Bayer pattern of 2 x 2 pixels", file);
  const double own_s = static_cast<double>(raw->imgdata.other.shutter);
  if (own_s > 0.0 && std::abs(own_s / time_s - 1.0) > kTimesAgree) {
    return raw_failure(ErrorCode::InvalidArgument,
                       fmt::format("the list says {:g} s, the file {:g} s; correct the list", time_s, own_s), file);
  }
  return visible_frame(*raw, *pattern, format, time_s);
}

#endif

}  // namespace

bool reads_raw_files() {
#if defined(CONTREJOUR_LIBRAW)
  return true;
#else
  return false;
#endif
}

Result<RawFrame> read_raw_frame(const std::string& file, const MosaicFormat& format, double time_s) {
  const std::string ending = lower_extension(file);
  if (ending == ".png" || ending == ".exr" || ending == ".tif" || ending == ".tiff")
    return frame_of_picture(file, format, time_s);
#if defined(CONTREJOUR_LIBRAW)
  return frame_of_raw(file, format, time_s);
#else
  return raw_failure(ErrorCode::Unsupported,
                     "this program is built without LibRaw; convert the photograph to a mosaic in a PNG "
                     "or TIFF of 16 bits (`unprocessed_raw -T`), or build with libraw-dev installed",
                     file);
#endif
}

}  // namespace contrejour::cli
