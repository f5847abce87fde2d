// SPDX-License-Identifier: Apache-2.0
// The guarantee of image_io.h: samples that were not changed are written back bit for bit.
#include <cmath>
#include <limits>
#include <random>

#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineInputPart.h>
#include <ImfDeepScanLineOutputPart.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfTiledInputPart.h>
#include <ImfTiledOutputFile.h>
#include <ImfTiledOutputPart.h>

#include "contrejour/expert/metrics.h"
#include "shared_data.h"
#include "support/approx.h"
#include "test_pictures.h"

using namespace contrejour;
using namespace contrejour::test;

namespace {

struct Given {
  std::string name;
  Imf::PixelType type;
  int sampling = 1;
};

// Random bits in every sample: NaNs with payloads, infinities, denormals, large integers.
class GivenFile {
 public:
  GivenFile(Imf::Header header, const std::vector<Given>& channels) : header_(std::move(header)) {
    std::mt19937 random(7);
    const Imath::Box2i window = header_.dataWindow();
    const int width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
    for (const Given& given : channels) {
      header_.channels().insert(given.name, Imf::Channel(given.type, given.sampling, given.sampling));
      const std::size_t size = given.type == Imf::HALF ? 2 : 4;
      const auto count = static_cast<std::size_t>((width / given.sampling) * (height / given.sampling));
      data_.emplace_back(count * size);
      for (std::byte& b : data_.back()) b = static_cast<std::byte>(random());
      frame_buffer_.insert(
          given.name, Imf::Slice::Make(given.type, data_.back().data(), window, 0, 0, given.sampling, given.sampling));
    }
  }

  void write(const std::filesystem::path& file) const {
    const Imath::Box2i window = header_.dataWindow();
    if (header_.hasTileDescription()) {
      Imf::TiledOutputFile out(file.c_str(), header_);
      out.setFrameBuffer(frame_buffer_);
      out.writeTiles(0, out.numXTiles() - 1, 0, out.numYTiles() - 1);
    } else {
      Imf::OutputFile out(file.c_str(), header_);
      out.setFrameBuffer(frame_buffer_);
      out.writePixels(window.max.y - window.min.y + 1);
    }
  }

  void write_part(Imf::MultiPartOutputFile& file, int part) const {
    const Imath::Box2i window = header_.dataWindow();
    Imf::OutputPart out(file, part);
    out.setFrameBuffer(frame_buffer_);
    out.writePixels(window.max.y - window.min.y + 1);
  }

  [[nodiscard]] const Imf::Header& header() const { return header_; }
  [[nodiscard]] const std::vector<std::byte>& data(std::size_t i) const { return data_[i]; }

 private:
  Imf::Header header_;
  std::vector<std::vector<std::byte>> data_;
  Imf::FrameBuffer frame_buffer_;
};

const std::vector<Given> kMixed = {{"R", Imf::HALF},         {"G", Imf::FLOAT},        {"B", Imf::HALF},
                                   {"A", Imf::HALF},         {"Z", Imf::FLOAT},        {"id", Imf::UINT},
                                   {"diffuse.R", Imf::HALF}, {"diffuse.G", Imf::HALF}, {"diffuse.B", Imf::HALF},
                                   {"mask.half", Imf::HALF}, {"chroma", Imf::HALF, 2}};

Imf::Header windowed_header(Imf::Compression compression) {
  Imf::Header header({{-10, 5}, {300, 200}}, {{-8, -16}, {55, 33}}, 1.5F, {0.25F, -1}, 2.5F);
  header.compression() = compression;
  header.lineOrder() = Imf::DECREASING_Y;
  header.insert("shot", Imf::StringAttribute("A001_C003"));
  header.insert("take", Imf::IntAttribute(17));
  Imf::addOwner(header, "a studio");
  return header;
}

void check_round_trip(const GivenFile& given) {
  const ScratchFolder folder;
  given.write(folder / "in.exr");
  const Picture in = must_read(folder / "in.exr");
  must_write(folder / "out.exr", in);
  const Picture out = must_read(folder / "out.exr");
  check_same_channels(in, out);
  CHECK(in.data_window == out.data_window);
  CHECK(in.display_window == out.display_window);
  CHECK(attribute_names(in) == attribute_names(out));
  CHECK(text_attribute(out, "shot") == "A001_C003");
  CHECK(folder.file_count() == 2);  // no temporary is left
}

}  // namespace

TEST_CASE("every bit comes back: mixed types, NaNs, windows, extra channels, attributes, lossless codecs") {
  for (const Imf::Compression compression :
       {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
    CAPTURE(static_cast<int>(compression));
    const GivenFile given(windowed_header(compression), kMixed);
    check_round_trip(given);
    const ScratchFolder folder;
    given.write(folder / "in.exr");
    const Picture in = must_read(folder / "in.exr");
    CHECK(in.data_window == PixelWindow{-8, -16, 64, 50});
    CHECK(in.display_window == PixelWindow{-10, 5, 311, 196});
    for (std::size_t i = 0; i < kMixed.size(); ++i) {
      CAPTURE(kMixed[i].name);
      CHECK(channel(in, kMixed[i].name).samples == given.data(i));
    }
    CHECK(channel(in, "chroma").x_sampling == 2);
  }
}

TEST_CASE("an unchanged picture is the same file, when OpenEXR wrote it the same way") {
  const ScratchFolder folder;
  GivenFile(windowed_header(Imf::ZIP_COMPRESSION), kMixed).write(folder / "in.exr");
  must_write(folder / "out.exr", must_read(folder / "in.exr"));
  CHECK(bytes_of(folder / "in.exr") == bytes_of(folder / "out.exr"));
}

TEST_CASE("tiles stay tiles, every bit and attribute") {
  Imf::Header header = windowed_header(Imf::ZIP_COMPRESSION);
  header.lineOrder() = Imf::RANDOM_Y;
  header.setTileDescription(Imf::TileDescription(24, 16, Imf::ONE_LEVEL));
  const std::vector<Given> channels(kMixed.begin(), kMixed.end() - 1);  // tiles have no subsampling
  check_round_trip(GivenFile(header, channels));
}

TEST_CASE("lossy codecs read as they are and are written without loss") {
  for (const Imf::Compression compression : {Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION,
                                             Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION}) {
    CAPTURE(static_cast<int>(compression));
    check_round_trip(
        GivenFile(windowed_header(compression),
                  {{"R", Imf::HALF}, {"G", Imf::HALF}, {"B", Imf::HALF}, {"A", Imf::HALF}, {"Z", Imf::FLOAT}}));
  }
}

TEST_CASE("a changed pixel changes its own samples and no others") {
  const ScratchFolder folder;
  GivenFile(windowed_header(Imf::PIZ_COMPRESSION), kMixed).write(folder / "in.exr");
  const Picture in = must_read(folder / "in.exr");
  Picture changed = in;
  changed.rgb.at(3, 4, 0) = 0.5F;
  changed.rgb.at(3, 4, 1) = 0.1F;
  changed.rgb.at(5, 4, 2) = 1e9F;  // beyond half: the largest half, not infinity
  must_write(folder / "out.exr", changed);
  const Picture out = must_read(folder / "out.exr");
  CHECK(out.rgb.at(3, 4, 0) == 0.5F);
  CHECK(out.rgb.at(3, 4, 1) == 0.1F);
  CHECK(out.rgb.at(5, 4, 2) == 65504.0F);
  Picture expected = in;
  const auto set_half = [&](const char* name, std::size_t pixel, std::uint16_t bits) {
    for (PictureChannel& c : expected.channels)
      if (c.name == name) std::memcpy(c.samples.data() + 2 * pixel, &bits, 2);
  };
  set_half("R", 4 * 64 + 3, 0x3800);
  set_half("B", 4 * 64 + 5, 0x7bff);
  const float tenth = 0.1F;
  for (PictureChannel& c : expected.channels)
    if (c.name == "G") std::memcpy(c.samples.data() + 4 * (4 * 64 + 3), &tenth, 4);
  check_same_channels(expected, out);
}

TEST_CASE("grey pictures, layers, integer colours") {
  const ScratchFolder folder;
  Imf::Header header = windowed_header(Imf::ZIP_COMPRESSION);
  GivenFile(header, {{"Y", Imf::HALF}, {"A", Imf::HALF}}).write(folder / "grey.exr");
  Picture grey = must_read(folder / "grey.exr");
  CHECK(grey.rgb_source == std::array<int, 3>{1, 1, 1});
  grey.rgb.at(0, 0, 0) = grey.rgb.at(0, 0, 1) = grey.rgb.at(0, 0, 2) = 2;
  grey.rgb.at(1, 0, 0) = 0;
  grey.rgb.at(1, 0, 1) = 1;
  grey.rgb.at(1, 0, 2) = 0;
  must_write(folder / "grey2.exr", grey);
  const Picture back = must_read(folder / "grey2.exr");
  CHECK(back.channels.size() == 2);
  CHECK(back.rgb.at(0, 0, 1) == 2);
  CHECK(back.rgb.at(1, 0, 0) == test::approx(0.7152).epsilon(1e-3));

  GivenFile(header, {{"key.R", Imf::FLOAT},
                     {"key.G", Imf::FLOAT},
                     {"key.B", Imf::FLOAT},
                     {"fill.R", Imf::UINT},
                     {"fill.G", Imf::UINT},
                     {"fill.B", Imf::UINT}})
      .write(folder / "layers.exr");
  CHECK(must_read(folder / "layers.exr").rgb_source[0] == 2);  // fill.B, fill.G, fill.R, key...
  const Picture key = must_read(folder / "layers.exr", {"key", {}});
  CHECK(key.channels[static_cast<std::size_t>(key.rgb_source[0])].name == "key.R");
  CHECK_FALSE(read_picture(folder / "layers.exr", {"rim", {}}).has_value());
  check_round_trip(GivenFile(header, {{"R", Imf::UINT}, {"G", Imf::UINT}, {"B", Imf::UINT}}));

  GivenFile(header, {{"Z", Imf::FLOAT}}).write(folder / "depth.exr");
  const auto depth = read_picture(folder / "depth.exr");
  REQUIRE_FALSE(depth.has_value());
  CHECK(depth.error().code == ErrorCode::Unsupported);
  CHECK(depth.error().message.find("Z") != std::string::npos);
}

namespace {

// A colourful picture of smooth colours around edges, written by OpenEXR's own luminance and chroma writer.
std::vector<Imf::Rgba> colourful(int width, int height) {
  std::vector<Imf::Rgba> pixels;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float u = static_cast<float>(x) / static_cast<float>(width),
                  v = static_cast<float>(y) / static_cast<float>(height);
      const float level = x > width / 2 ? 2.0F : 0.1F;
      pixels.emplace_back(level * (0.2F + u), level * (0.5F + 0.3F * v), level * (0.8F - 0.5F * u), 1.0F - 0.5F * v);
    }
  }
  return pixels;
}

void write_luminance_chroma(const std::filesystem::path& file, int width, int height,
                            const Imf::Chromaticities* primaries = nullptr) {
  Imf::Header header(width, height);
  header.compression() = Imf::PIZ_COMPRESSION;
  header.insert("shot", Imf::StringAttribute("A001_C003"));
  if (primaries != nullptr) Imf::addChromaticities(header, *primaries);
  Imf::RgbaOutputFile out(file.c_str(), header, Imf::WRITE_YCA);
  out.setYCRounding(10, 10);
  const std::vector<Imf::Rgba> pixels = colourful(width, height);
  out.setFrameBuffer(pixels.data(), 1, static_cast<std::size_t>(width));
  out.writePixels(height);
}

// The picture as programs see it that use OpenEXR alone.
Image rgb_by_openexr(const std::filesystem::path& file) {
  Imf::RgbaInputFile in(file.c_str());
  const Imath::Box2i window = in.dataWindow();
  Image rgb(window.max.x + 1, window.max.y + 1, 3);
  std::vector<Imf::Rgba> pixels(rgb.pixels.size() / 3);
  in.setFrameBuffer(pixels.data(), 1, static_cast<std::size_t>(rgb.width));
  in.readPixels(0, window.max.y);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    rgb.pixels[3 * i] = pixels[i].r;
    rgb.pixels[3 * i + 1] = pixels[i].g;
    rgb.pixels[3 * i + 2] = pixels[i].b;
  }
  return rgb;
}

// A soft orange ghost around (40, 24), 12 pixels wide.
void add_ghost(Picture& picture) {
  for (int y = 0; y < picture.rgb.height; ++y) {
    for (int x = 0; x < picture.rgb.width; ++x) {
      const float dx = static_cast<float>(x - 40) / 12, dy = static_cast<float>(y - 24) / 12;
      const float level = std::max(0.0F, 1 - dx * dx - dy * dy);
      picture.rgb.at(x, y, 0) += 0.8F * level;
      picture.rgb.at(x, y, 1) += 0.4F * level;
      picture.rgb.at(x, y, 2) += 0.1F * level;
    }
  }
}

}  // namespace

TEST_CASE("luminance and chroma are read as OpenEXR reads them, and come back as they were") {
  const ScratchFolder folder;
  write_luminance_chroma(folder / "yc.exr", 96, 64);
  const Picture picture = must_read(folder / "yc.exr");
  CHECK(picture.rgb.pixels == rgb_by_openexr(folder / "yc.exr").pixels);
  CHECK(picture.rgb.at(9, 9, 1) == test::approx(0.1 * (0.5 + 0.3 * 9 / 64)).epsilon(2e-2));
  must_write(folder / "out.exr", picture);
  const Picture out = must_read(folder / "out.exr");
  check_same_channels(picture, out);
  CHECK(out.channels.size() == 4);  // A, BY, RY, Y
  CHECK(channel(out, "RY").x_sampling == 2);
  CHECK(attribute_names(picture) == attribute_names(out));
  CHECK(Imf::RgbaInputFile((folder / "out.exr").c_str()).compression() == Imf::PIZ_COMPRESSION);
  must_write(folder / "out.png", picture);
  CHECK(must_read(folder / "out.png").channels.size() == 4);
}

TEST_CASE("what is added to luminance and chroma is there for other programs, and beyond its reach every bit is kept") {
  const Imf::Chromaticities aces({0.713F, 0.293F}, {0.165F, 0.830F}, {0.128F, 0.044F}, {0.32168F, 0.33767F});
  for (const Imf::Chromaticities* primaries : {static_cast<const Imf::Chromaticities*>(nullptr), &aces}) {
    const ScratchFolder folder;
    write_luminance_chroma(folder / "yc.exr", 96, 64, primaries);
    Picture picture = must_read(folder / "yc.exr");
    const Picture before = picture;
    add_ghost(picture);
    must_write(folder / "out.exr", picture);
    const Image wanted = picture.rgb, got = rgb_by_openexr(folder / "out.exr");
    const auto comparison = compare(wanted, got);
    REQUIRE(comparison.has_value());
    CHECK(comparison->psnr_db.value_or(200) > 50);
    for (const double ratio : comparison->flux_ratio) CHECK(ratio == test::approx(1).epsilon(2e-3));
    const Picture after = must_read(folder / "out.exr");
    CHECK(channel(after, "A").samples == channel(before, "A").samples);
    int kept = 0;
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 96; ++x) {
        const int dx = std::max(std::abs(x - 40) - 12, 0), dy = std::max(std::abs(y - 24) - 12, 0);
        const auto same = [&](const char* name, std::size_t at) {
          return std::memcmp(channel(before, name).samples.data() + 2 * at,
                             channel(after, name).samples.data() + 2 * at, 2) == 0;
        };
        if (dx > 0 || dy > 0) CHECK(same("Y", static_cast<std::size_t>(y * 96 + x)));
        if (x % 2 != 0 || y % 2 != 0 || std::max(dx, dy) <= 13) continue;
        const auto at = static_cast<std::size_t>(y / 2 * 48 + x / 2);
        CHECK(same("RY", at));
        CHECK(same("BY", at));
        ++kept;
      }
    }
    CHECK(kept > 600);
  }
}

TEST_CASE("a light on black luminance and chroma has its colour") {
  const ScratchFolder folder;
  std::vector<Imf::Rgba> pixels(96 * 64, Imf::Rgba(0, 0, 0, 1));
  {
    Imf::RgbaOutputFile out((folder / "yc.exr").c_str(), 96, 64, Imf::WRITE_YC);
    out.setFrameBuffer(pixels.data(), 1, 96);
    out.writePixels(64);
  }
  Picture picture = must_read(folder / "yc.exr");
  add_ghost(picture);
  picture.rgb.at(80, 10, 0) = std::numeric_limits<float>::infinity();
  must_write(folder / "out.exr", picture);
  const Image got = rgb_by_openexr(folder / "out.exr");
  CHECK(got.at(40, 24, 0) == test::approx(0.8).epsilon(0.01));
  CHECK(got.at(40, 24, 1) == test::approx(0.4).epsilon(0.01));
  CHECK(got.at(40, 24, 2) == test::approx(0.1).epsilon(0.05));
  CHECK(got.at(5, 60, 0) == 0);
}

TEST_CASE("luminance and chroma in a layer and in one of several parts") {
  const ScratchFolder folder;
  write_luminance_chroma(folder / "yc.exr", 96, 64);
  Picture layer = must_read(folder / "yc.exr");
  for (PictureChannel& c : layer.channels) c.name = "key." + c.name;
  must_write(folder / "layer.exr", layer);
  CHECK(must_read(folder / "layer.exr", {"key", {}}).rgb.pixels == layer.rgb.pixels);

  Imf::InputFile in((folder / "yc.exr").c_str());
  Imf::Header first = in.header(), second = in.header();
  first.setName("depth");
  first.setType(Imf::SCANLINEIMAGE);
  first.channels() = Imf::ChannelList();
  first.channels().insert("Z", Imf::Channel(Imf::FLOAT));
  second.setName("beauty");
  second.setType(Imf::SCANLINEIMAGE);
  const Imf::Header headers[] = {first, second};
  {
    Imf::MultiPartOutputFile out((folder / "parts.exr").c_str(), headers, 2);
    std::vector<float> z(96 * 64, 3.0F);
    Imf::FrameBuffer frame_buffer;
    frame_buffer.insert("Z", Imf::Slice::Make(Imf::FLOAT, z.data(), first.dataWindow()));
    Imf::OutputPart depth(out, 0), beauty(out, 1);
    depth.setFrameBuffer(frame_buffer);
    depth.writePixels(64);
    beauty.copyPixels(in);
  }
  Picture part = must_read(folder / "parts.exr");
  CHECK(part.rgb.pixels == layer.rgb.pixels);
  add_ghost(part);
  must_write(folder / "out.exr", part);
  const auto comparison = compare(part.rgb, must_read(folder / "out.exr", {"", {}, "beauty"}).rgb);
  REQUIRE(comparison.has_value());
  CHECK(comparison->psnr_db.value_or(200) > 50);
}

TEST_CASE("new images, colour space and text") {
  const ScratchFolder folder;
  Image image(3, 2, 4);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = 0.1F * static_cast<float>(i);
  REQUIRE(write_exr(folder / "new.exr", image).has_value());
  const Picture read = must_read(folder / "new.exr");
  CHECK(read.rgb.at(2, 1, 2) == image.at(2, 1, 2));
  CHECK(channel(read, "A").type == SampleType::Float);
  CHECK(colour_space_of(read) == ColourSpace::Rec709);

  Picture aces = picture_of(image, SampleType::Half);
  set_colour_space(aces, ColourSpace::AcesCg);
  set_text_attribute(aces, "comments", "made by a test");
  aces.data_window.x = 100;
  must_write(folder / "aces.exr", aces);
  const Picture back = must_read(folder / "aces.exr");
  CHECK(colour_space_of(back) == ColourSpace::AcesCg);
  CHECK(text_attribute(back, "comments") == "made by a test");
  CHECK(back.data_window == PixelWindow{100, 0, 3, 2});
  CHECK(back.rgb.at(1, 1, 0) == test::approx(image.at(1, 1, 0)).epsilon(1e-3));

  REQUIRE(write_exr(folder / "one.exr", Image(4, 4, 1)).has_value());
  CHECK(must_read(folder / "one.exr").channels.size() == 1);
  CHECK_FALSE(write_exr(folder / "none.exr", Image()).has_value());
  CHECK_FALSE(write_picture(folder / "new.tiff", aces).has_value());
}

namespace {

// A file with a tiled depth part, the picture, and a deep part.
struct Parts {
  Parts() {
    header.setName("beauty");
    header.setType(Imf::SCANLINEIMAGE);
    Imf::Header depth = windowed_header(Imf::PIZ_COMPRESSION), deep(8, 4);
    depth.setName("depth");
    depth.setType(Imf::TILEDIMAGE);
    depth.setTileDescription({16, 16, Imf::MIPMAP_LEVELS});
    depth.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    deep.setName("deep");
    deep.setType(Imf::DEEPSCANLINE);
    deep.displayWindow() = header.displayWindow();
    deep.pixelAspectRatio() = header.pixelAspectRatio();
    deep.compression() = Imf::ZIPS_COMPRESSION;
    deep.channels().insert("R", Imf::Channel(Imf::HALF));
    headers = {depth, header, deep};
    headers[1].channels() = given.header().channels();
  }

  void write(const std::filesystem::path& file) const {
    Imf::MultiPartOutputFile out(file.c_str(), headers.data(), 3);
    given.write_part(out, 1);
    const Imath::Box2i window = header.dataWindow();
    std::vector<float> z(
        static_cast<std::size_t>((window.max.x - window.min.x + 1) * (window.max.y - window.min.y + 1)));
    for (std::size_t k = 0; k < z.size(); ++k) z[k] = static_cast<float>(k) * 0.5F;
    Imf::FrameBuffer frame_buffer;
    frame_buffer.insert("Z", Imf::Slice::Make(Imf::FLOAT, z.data(), window));
    Imf::TiledOutputPart tiles(out, 0);
    tiles.setFrameBuffer(frame_buffer);
    for (int level = 0; level < tiles.numLevels(); ++level)
      tiles.writeTiles(0, tiles.numXTiles(level) - 1, 0, tiles.numYTiles(level) - 1, level);
    Imf::DeepScanLineOutputPart lines(out, 2);
    std::vector<unsigned int> counts(32, 1);
    half sample = 0.5F;
    std::vector<half*> pointers(32, &sample);
    Imf::DeepFrameBuffer deep_buffer;
    deep_buffer.insertSampleCountSlice(
        Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()), sizeof(unsigned int), 8 * sizeof(unsigned int)));
    deep_buffer.insert("R", Imf::DeepSlice(Imf::HALF, reinterpret_cast<char*>(pointers.data()), sizeof(half*),
                                           8 * sizeof(half*), sizeof(half)));
    lines.setFrameBuffer(deep_buffer);
    lines.writePixels(4);
  }

  Imf::Header header = windowed_header(Imf::ZIP_COMPRESSION);
  GivenFile given{header, kMixed};
  std::vector<Imf::Header> headers;
};

}  // namespace

TEST_CASE("of several parts the first with colour is the picture, and the others come back as they were") {
  const ScratchFolder folder;
  Parts().write(folder / "in.exr");
  Picture picture = must_read(folder / "in.exr");
  CHECK(channel(picture, "G").type == SampleType::Float);
  CHECK(text_attribute(picture, "shot") == "A001_C003");
  must_write(folder / "same.exr", picture);
  check_same_channels(picture, must_read(folder / "same.exr"));
  picture.rgb.at(3, 2, 1) = 7.5F;
  set_text_attribute(picture, "comments", "flared");
  must_write(folder / "out.exr", picture);
  const Picture back = must_read(folder / "out.exr");
  CHECK(back.rgb.at(3, 2, 1) == 7.5F);
  CHECK(text_attribute(back, "comments") == "flared");
  CHECK(channel(back, "Z").samples == channel(picture, "Z").samples);

  Imf::MultiPartInputFile in((folder / "in.exr").c_str()), out((folder / "out.exr").c_str());
  REQUIRE(out.parts() == 3);
  for (const int part : {0, 2}) CHECK(out.header(part).name() == in.header(part).name());
  Imf::TiledInputPart before(in, 0), after(out, 0);
  CHECK(after.numLevels() == before.numLevels());
  for (int level = 0; level < before.numLevels(); ++level) {
    const char *packed_before = nullptr, *packed_after = nullptr;
    int size_before = 0, size_after = 0, dx = 0, dy = 0, lx = level, ly = level;
    before.rawTileData(dx, dy, lx, ly, packed_before, size_before);
    after.rawTileData(dx, dy, lx, ly, packed_after, size_after);
    REQUIRE(size_before == size_after);
    CHECK(std::equal(packed_before, packed_before + size_before, packed_after));
  }
  Imf::DeepScanLineInputPart deep(out, 2);
  CHECK(deep.header().channels().findChannel("R") != nullptr);
}

TEST_CASE("parts and layers by name, files without colour, damaged ones") {
  const ScratchFolder folder;
  Parts parts;
  parts.write(folder / "in.exr");
  CHECK(must_read(folder / "in.exr", {"beauty", {}}).rgb_source == must_read(folder / "in.exr").rgb_source);
  CHECK_FALSE(read_picture(folder / "in.exr", {"depth", {}}).has_value());
  const auto rim = read_picture(folder / "in.exr", {"rim", {}});
  REQUIRE_FALSE(rim.has_value());
  CHECK(rim.error().message.find("0 depth (no colour), 1 beauty (layers diffuse), 2 deep (deep)") != std::string::npos);
  CHECK(rim.error().position.file == (folder / "in.exr").string());

  const std::vector<std::byte> whole = bytes_of(folder / "in.exr");
  for (std::size_t size = 0; size < whole.size(); size += whole.size() / 40 + 1) {
    const auto cut = read_picture(std::span(whole).first(size), "cut");
    if (cut) CHECK_FALSE(cut->rgb.pixels.empty());
  }
  std::mt19937 random(3);
  for (int round = 0; round < 60; ++round) {
    std::vector<std::byte> damaged = whole;
    damaged[random() % std::min<std::size_t>(damaged.size(), 3000)] = static_cast<std::byte>(random());
    const auto read = read_picture(damaged, "damaged");
    if (read) static_cast<void>(write_picture(folder / "damaged.exr", *read));
  }
}

namespace {

// Two parts, each with colours and with a layer of the same name.
void write_two_parts(const std::filesystem::path& file) {
  const std::vector<Given> channels = {{"R", Imf::HALF},     {"G", Imf::HALF},     {"B", Imf::HALF},
                                       {"key.R", Imf::HALF}, {"key.G", Imf::HALF}, {"key.B", Imf::HALF}};
  std::vector<Imf::Header> headers;
  std::vector<GivenFile> given;
  for (const char* name : {"left", "0"}) {
    Imf::Header header = windowed_header(Imf::ZIP_COMPRESSION);
    header.setName(name);
    header.setType(Imf::SCANLINEIMAGE);
    given.emplace_back(header, channels);
    headers.push_back(given.back().header());
  }
  Imf::MultiPartOutputFile out(file.c_str(), headers.data(), 2);
  for (int part = 0; part < 2; ++part) given[static_cast<std::size_t>(part)].write_part(out, part);
}

std::string error_of(const std::filesystem::path& file, const ReadOptions& options) {
  const auto picture = read_picture(file, options);
  REQUIRE_FALSE(picture.has_value());
  CHECK(picture.error().code == ErrorCode::Unsupported);
  CHECK(picture.error().position.file == file.string());
  return picture.error().message;
}

}  // namespace

TEST_CASE("one of several parts by name or number, and its layers; the rest comes back bit for bit") {
  const ScratchFolder folder;
  write_two_parts(folder / "in.exr");
  const auto name_of = [](const Picture& picture) { return text_attribute(picture, "name"); };
  CHECK(name_of(must_read(folder / "in.exr")) == "left");
  CHECK(name_of(must_read(folder / "in.exr", {"", {}, "left"})) == "left");
  CHECK(name_of(must_read(folder / "in.exr", {"", {}, "1"})) == "0");
  CHECK(name_of(must_read(folder / "in.exr", {"", {}, "0"})) == "0");  // a name comes before a number
  CHECK(error_of(folder / "in.exr", {"", {}, "2"}) ==
        "no part '2'; the file's parts are 0 left (layers key), 1 0 (layers key)");
  CHECK(error_of(folder / "in.exr", {"rim", {}, "1"}).find("no layer 'rim' in part '1'") == 0);

  Picture picture = must_read(folder / "in.exr", {"key", {}, "1"});
  CHECK(channel(picture, "key.R").name == picture.channels[static_cast<std::size_t>(picture.rgb_source[0])].name);
  picture.rgb.at(3, 2, 0) = 7.5F;
  must_write(folder / "out.exr", picture);
  const ReadOptions left{"", {}, "left"}, right{"", {}, "1"};
  check_same_channels(must_read(folder / "in.exr", left), must_read(folder / "out.exr", left));
  const Picture before = must_read(folder / "in.exr", right), after = must_read(folder / "out.exr", right);
  for (const char* same : {"R", "G", "B", "key.G", "key.B"})
    CHECK(channel(before, same).samples == channel(after, same).samples);
  CHECK(channel(before, "key.R").samples != channel(after, "key.R").samples);

  GivenFile(windowed_header(Imf::ZIP_COMPRESSION), kMixed).write(folder / "single.exr");
  CHECK(must_read(folder / "single.exr", {"", {}, "0"}).rgb_source[0] >= 0);
  CHECK(error_of(folder / "single.exr", {"", {}, "left"}) == "no part 'left'; the file has one part, 0");
  CHECK(error_of(folder / "single.exr", {"rim", {}}) ==
        "no colour in layer 'rim'; the picture's layers with colour are diffuse");
  must_write(folder / "flat.png", picture_of(Image(4, 4)));
  CHECK(error_of(folder / "flat.png", {"key", {}}).find("neither layers nor parts") != std::string::npos);
}

TEST_CASE("a picture of one channel is grey, whatever its name") {
  const ScratchFolder folder;
  const Imf::Header header = windowed_header(Imf::ZIP_COMPRESSION);
  for (const char* name : {"L", "R", "luminance.550nm"}) {
    GivenFile(header, {{name, Imf::HALF}, {"A", Imf::HALF}}).write(folder / "one.exr");
    Picture picture = must_read(folder / "one.exr");
    CHECK(picture.rgb_source[0] == picture.rgb_source[2]);
    for (int c = 0; c < 3; ++c) picture.rgb.at(2, 1, c) = 3.0F;
    must_write(folder / "two.exr", picture);
    const Picture back = must_read(folder / "two.exr");
    CHECK(back.rgb.at(2, 1, 2) == 3.0F);
    CHECK(channel(back, name).type == SampleType::Half);
    CHECK(channel(back, "A").samples == channel(picture, "A").samples);
  }
}

TEST_CASE("every codec that can be chosen keeps every bit") {
  const ScratchFolder folder;
  Picture picture = picture_of(Image(40, 30));
  std::mt19937 random(3);
  for (float& value : picture.rgb.pixels) value = std::uniform_real_distribution<float>(0.0F, 1.0F)(random);
  const std::vector<std::pair<ExrCompression, Imf::Compression>> codecs{
      {ExrCompression::AsRead, Imf::ZIP_COMPRESSION}, {ExrCompression::None, Imf::NO_COMPRESSION},
      {ExrCompression::Rle, Imf::RLE_COMPRESSION},    {ExrCompression::Zips, Imf::ZIPS_COMPRESSION},
      {ExrCompression::Zip, Imf::ZIP_COMPRESSION},    {ExrCompression::Piz, Imf::PIZ_COMPRESSION}};
  for (const auto& [choice, codec] : codecs) {
    picture.exr_compression = choice;
    must_write(folder / "out.exr", picture);
    CHECK(Imf::InputFile((folder / "out.exr").string().c_str()).header().compression() == codec);
    Picture read = must_read(folder / "out.exr");
    CHECK(read.rgb.pixels == picture.rgb.pixels);
    must_write(folder / "again.exr", read);  // a picture that was read keeps its own
    CHECK(Imf::InputFile((folder / "again.exr").string().c_str()).header().compression() == codec);
  }
}

TEST_CASE("any number of threads write the same file") {
  const ScratchFolder folder;
  Image image(300, 700);
  std::mt19937 random(3);
  for (float& value : image.pixels) value = std::uniform_real_distribution<float>(0.0F, 1.0F)(random);
  std::vector<std::vector<std::byte>> files;
  for (const int threads : {1, 2, 7}) {
    Context context;
    context.threads = threads;
    REQUIRE(write_exr(folder / "flare.exr", image, SampleType::Float, context));
    files.push_back(bytes_of(folder / "flare.exr"));
  }
  CHECK(files[1] == files[0]);
  CHECK(files[2] == files[0]);
}

TEST_CASE("a cancelled write leaves nothing and keeps what was there") {
  const ScratchFolder folder;
  const std::atomic<bool> cancel{true};
  Context context;
  context.cancel = &cancel;
  write_bytes(folder / "out.exr", {std::byte{1}});
  for (const char* name : {"out.exr", "out.png"}) {
    const auto written = write_picture(folder / name, picture_of(Image(64, 64)), context);
    REQUIRE_FALSE(written.has_value());
    CHECK(written.error().code == ErrorCode::Cancelled);
  }
  CHECK(folder.file_count() == 1);
  CHECK(bytes_of(folder / "out.exr").size() == 1);
}

TEST_CASE("the sample photographs come back bit for bit") {
  for (const char* name : {"ScanLines/CandleGlass.exr", "ScanLines/StillLife.exr", "ScanLines/Tree.exr",
                           "MultiResolution/StageEnvLatLong.exr"}) {
    const auto file = shared_data(std::string("hdr/openexr-images/") + name);
    if (!file) continue;
    const ScratchFolder folder;
    const Picture in = must_read(*file);
    must_write(folder / "out.exr", in);
    const Picture out = must_read(folder / "out.exr");
    check_same_channels(in, out);
    CHECK(attribute_names(in) == attribute_names(out));
  }
}
