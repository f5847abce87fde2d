// SPDX-License-Identifier: Apache-2.0
// Calls every function that reads or writes a file, with invalid names and contents.
#include <filesystem>

#include <unistd.h>

#include "contrejour/expert/coating_file.h"
#include "contrejour/expert/glass_catalogue.h"
#include "contrejour/expert/key_values.h"
#include "contrejour/expert/output_file.h"
#include "contrejour/expert/spectrum_file.h"
#include "contrejour/expert/write_lens.h"
#include "contrejour/image_io.h"
#include "robustness/strange.h"

using namespace contrejour;
using namespace contrejour::test;
namespace fs = std::filesystem;

TEST_CASE("files that are none are errors") {
  const std::vector<fs::path> names = {"", ".", "/", "/nowhere/at/all.exr", std::string(5000, 'x'), "/dev/null"};
  for (const fs::path& name : names) {
    CAPTURE(name.string().substr(0, 40));
    CHECK_FALSE(read_picture(name).has_value());
    CHECK_FALSE(read_lens(name).has_value());
    CHECK_FALSE(find_lens(name.string()).has_value());
    CHECK_FALSE(read_spectrum(name).has_value());
    use(find_spectrum(name.string()));
    CHECK_FALSE(read_measured_coating(name).has_value());
    CHECK_FALSE(read_glass_file(name).has_value());
    use(read_key_values(name, "page"));
    GlassCatalogue catalogue;
    if (name != "/" && name != ".") use(catalogue.add_path(name));
    if (name == "/dev/null") continue;
    CHECK_FALSE(OutputFile::create(name).has_value());
    CHECK_FALSE(write_picture(name, Picture{}).has_value());
    CHECK_FALSE(write_exr(name, Image(2, 2)).has_value());
    CHECK_FALSE(write_preview_png(name, Image(2, 2)).has_value());
  }
  const std::vector<std::string> texts = {"",      std::string(3, '\0'), "\xff\xfe\xfd", std::string(100000, '['),
                                          "1,2\n", "\x76\x2f\x31\x01",   "\x89PNG"};
  for (const std::string& text : texts) {
    use(read_picture(std::as_bytes(std::span(text)), "x"));
    CHECK_FALSE(read_lens_toml(text, "x").has_value());
    CHECK_FALSE(read_spectrum(text, "x").has_value());
    CHECK_FALSE(read_measured_coating(text, "x").has_value());
    CHECK_FALSE(read_agf(text, "x", "").has_value());
    CHECK_FALSE(read_glass_yaml(text, "x", "", "").has_value());
    use(read_key_values(text, "x", ""));
    use(parse_spectrum(text));
    use(glass_of_code(text));
    use(find_lens(text));
  }
}

TEST_CASE("what cannot be written is an error") {
  const fs::path folder = fs::temp_directory_path() / ("contrejour-walk-" + std::to_string(getpid()));
  fs::create_directories(folder);
  const fs::path exr = folder / "a.exr", png = folder / "a.png";
  Picture broken = picture_of(Image(4, 4));
  std::vector<Picture> pictures = {Picture{}, broken, broken, broken, broken, picture_of(Image{}), broken, broken};
  pictures[1].rgb_source = {0, 1, 99};
  pictures[2].rgb_source = {-1, -1, -1};
  pictures[3].channels[1].samples.resize(3);
  pictures[4].data_window = {0, 0, 1 << 30, 1 << 30};
  pictures[6].chroma_source = {1, 99};
  pictures[7].chroma_source = {1, 2};
  Image lying;
  lying.width = lying.height = 100;
  pictures.push_back(picture_of(lying));
  for (const Picture& picture : pictures) {
    CHECK_FALSE(write_picture(exr, picture).has_value());
    CHECK_FALSE(write_picture(png, picture).has_value());
    use(colour_space_of(picture));
    use(pixel_aspect_of(picture));
    use(attribute_names(picture));
    use(text_attribute(picture, ""));
  }
  CHECK_FALSE(write_exr(exr, lying).has_value());
  CHECK_FALSE(write_preview_png(png, lying).has_value());
  Picture picture = picture_of(Image(4, 4));
  for (const double v : kStrange) set_pixel_aspect(picture, v);
  CHECK(pixel_aspect_of(picture) == 1.0);
  set_text_attribute(picture, "", "no name");
  set_text_attribute(picture, std::string(1000, 'n'), std::string(100, '\0'));
  use(write_picture(exr, picture));
  PreviewSettings settings;
  for (const double v : kStrange) {
    settings.exposure_stops = v;
    use(write_preview_png(png, Image(4, 4), settings));
  }
  use(write_key_values({}));
  use(write_spectrum(TabulatedSpectrum{}));
  CHECK_FALSE(write_lens_zmx({}).has_value());
  CHECK_FALSE(write_lens_seq({}).has_value());
  use(write_lens_toml({}));
  CHECK(commit_all({}).has_value());
  fs::remove_all(folder);
}
