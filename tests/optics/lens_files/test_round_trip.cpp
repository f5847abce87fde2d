// SPDX-License-Identifier: Apache-2.0
// read(write(x)) == x, bit for bit, for random lenses.
#include "optics/lens_files/sample_lens.h"

#include <cmath>
#include <filesystem>
#include <random>
#include <regex>

#include "base/text_file.h"
#include "contrejour/lens.h"

namespace contrejour::test::round_trip {
namespace {

void check_same(const Prescription& a, const Prescription& b) {
  CHECK(a.name == b.name);
  CHECK(a.source == b.source);
  CHECK(a.f_number == b.f_number);
  CHECK(a.sensor_width_mm == b.sensor_width_mm);
  CHECK(a.sensor_distance_mm == b.sensor_distance_mm);
  CHECK(a.sensor_height_mm == b.sensor_height_mm);
  CHECK(a.stated.focal_length_mm == b.stated.focal_length_mm);
  CHECK(a.stated.back_focal_distance_mm == b.stated.back_focal_distance_mm);
  CHECK(a.stated.wavelength_nm == b.stated.wavelength_nm);
  CHECK(a.stated.tolerance == b.stated.tolerance);
  REQUIRE(a.surfaces.size() == b.surfaces.size());
  for (std::size_t i = 0; i < a.surfaces.size(); ++i) {
    const Surface &s = a.surfaces[i], &t = b.surfaces[i];
    CHECK(s.kind == t.kind);
    CHECK(s.curvature_per_mm == t.curvature_per_mm);
    CHECK(s.thickness_mm == t.thickness_mm);
    CHECK(s.semi_diameter_mm == t.semi_diameter_mm);
    CHECK(s.glass_after == t.glass_after);
    CHECK(s.coating == t.coating);
    CHECK(s.shape == t.shape);
    CHECK(s.pose == t.pose);
  }
  REQUIRE(a.zoom.size() == b.zoom.size());
  for (std::size_t z = 0; z < a.zoom.size(); ++z) {
    CHECK(a.zoom[z].focal_length_mm == b.zoom[z].focal_length_mm);
    CHECK(a.zoom[z].thickness_mm == b.zoom[z].thickness_mm);
  }
}

class RandomLens {
 public:
  explicit RandomLens(unsigned seed) : random_(seed) {}

  Prescription make() {
    Prescription lens;
    lens.name = text();
    lens.source = text();
    lens.f_number = real(0.8, 32.0);
    lens.sensor_width_mm = real(1.0, 100.0);
    if (one_in(3)) lens.sensor_distance_mm = real(0.5, 90.0);
    lens.sensor_height_mm = real(1.0, 100.0);
    if (one_in(2)) lens.stated.focal_length_mm = real(-300.0, -1.0);
    if (one_in(2)) lens.stated.back_focal_distance_mm = real(1.0, 300.0);
    lens.stated.wavelength_nm = real(400.0, 700.0);
    lens.stated.tolerance = real(0.001, 0.1);
    add_surfaces(lens);
    add_zoom(lens);
    return lens;
  }

 private:
  double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  bool one_in(int n) { return whole(1, n) == 1; }

  std::string text() {
    static const char* const kPieces[] = {"a", "Ü", "\"", "\\", "\n", "\t", "'", "#", "]", "\x7f", "\x01", "光", " = "};
    std::string out = "x";
    for (int k = whole(0, 8); k > 0; --k) out += kPieces[whole(0, 12)];
    return out;
  }

  Glass glass() {
    // Few names, so that some clash, and reserved names.
    static const char* const kNames[] = {"", "BK7", "N-SK16", "two words", "air", "1.5"};
    const std::string name = kNames[whole(0, 5)];
    switch (whole(0, 2)) {
      case 0: return {name, ConstantIndex{real(1.1, 3.9)}};
      case 1: return {name, AbbeGlass{real(1.4, 2.0), real(20.0, 90.0)}};
      default:
        return {name, Sellmeier{{real(1.0, 1.5), real(0.0, 0.3), real(0.5, 1.0)}, {0.007, real(0.0, 0.03), 100.0}}};
    }
  }

  Coating coating() {
    static const char* const kNames[] = {"", "front", "none", "quarter-wave", "c d"};
    const std::string name = kNames[whole(0, 4)];
    switch (whole(0, 5)) {
      case 0: return {};
      case 4: return {name, DesignedCoating{static_cast<CoatingDesign>(whole(0, 3)), real(380.0, 800.0), 4}};
      case 5:
        return {name,
                MeasuredCoating{{real(380.0, 500.0), 600.0}, {0.0, real(1.0, 90.0)}, {0.1, real(0.0, 1.0), 0.0, 1.0}}};
      case 1: return {name, QuarterWave{real(1.2, 2.5), real(380.0, 800.0)}};
      case 2: return {name, HullinFresnelAR{real(1.2, 2.5), real(380.0, 800.0)}};
      default: {
        FilmStack stack;
        for (int k = whole(1, 6); k > 0; --k) {
          const FilmMaterial number(real(0.05, 4.0), one_in(2) ? 0.0 : real(0.0, 3.0));
          stack.layers.push_back({one_in(3) ? film_material("TiO2") : number, real(0.0, 300.0)});
        }
        return {name, stack};
      }
    }
  }

  // A shape whose sag is small compared with that of the curvature.
  SurfaceShape shape() {
    SurfaceShape s;
    if (one_in(2)) return s;
    if (one_in(2)) s.conic = real(-3.0, 1.0);
    s.kind = static_cast<ShapeKind>(whole(0, 2));
    if (s.kind != ShapeKind::Biconic) {
      for (int k = whole(0, SurfaceShape::kHighestPower); k > 0; --k)
        s.powers.push_back(one_in(3) ? 0.0 : real(-0.01, 0.01) * std::pow(0.1, static_cast<double>(s.powers.size())));
    }
    if (s.kind == ShapeKind::Revolution) return s;
    if (!one_in(3)) s.curvature_x_per_mm = one_in(2) ? real(-0.1, 0.1) : 1.0 / real(10.0, 1000.0);
    if (s.kind == ShapeKind::Biconic && one_in(2)) s.conic_x = real(-3.0, 1.0);
    if (one_in(2)) s.rotation_rad = one_in(2) ? real(-3.0, 3.0) : 30.0 * 3.14159265358979323846 / 180.0;
    return s;
  }

  void add_surfaces(Prescription& lens) {
    const int count = whole(2, 30);
    const int stop = whole(0, count - 1);
    for (int k = 0; k < count; ++k) {
      Surface s;
      s.semi_diameter_mm = real(0.5, 5.0);
      s.thickness_mm = k + 1 == count ? 0.0 : real(6.0, 20.0);  // wide enough for any two sags
      if (k == stop) {
        s.kind = SurfaceKind::Stop;
        s.glass_after = lens.surfaces.empty() ? air() : lens.surfaces.back().glass_after;
      } else {
        // Radii as people write them, curvatures as programs do, and planes.
        const double radius_mm = (one_in(2) ? 1.0 : -1.0) * real(10.0, 1000.0);
        s.curvature_per_mm = one_in(8) ? 0.0 : one_in(2) ? 1.0 / radius_mm : real(-0.1, 0.1);
        s.glass_after = one_in(2) ? air() : glass();
        s.coating = coating();
        s.shape = shape();
        if (one_in(4)) s.pose.shift_mm = {real(-0.1, 0.1), one_in(2) ? 0.0 : real(-0.1, 0.1), real(-0.1, 0.1)};
        if (one_in(4)) s.pose.axis = normalized({real(-0.02, 0.02), real(-0.02, 0.02), 1.0});
      }
      if (k + 1 == count || (k + 2 == count && stop == count - 1)) s.glass_after = air();
      lens.surfaces.push_back(s);
    }
  }

  void add_zoom(Prescription& lens) {
    if (one_in(2) || lens.surfaces.size() < 3) return;
    double focal_mm = real(10.0, 20.0);
    for (int z = whole(2, 5); z > 0; --z) {
      focal_mm += real(1.0, 10.0);
      lens.zoom.push_back({focal_mm, {{0, real(6.0, 20.0)}, {1, real(6.0, 20.0)}}, 0});
    }
  }

  std::mt19937 random_;
};

TEST_CASE("a lens written and read again is the same") {
  for (unsigned seed = 0; seed < 500; ++seed) {
    CAPTURE(seed);
    const Prescription lens = RandomLens(seed).make();
    const std::string text = write_lens_toml(lens);
    const auto again = read_lens_toml(text, "x.toml");
    if (!again) {
      FAIL(again.error().to_string() << "\n" << text);
    }
    check_same(lens, *again);
    CHECK(write_lens_toml(*again) == text);
  }
}

TEST_CASE("every bundled lens too") {
  for (const BundledLens& bundled : bundled_lenses()) {
    CAPTURE(bundled.name);
    const auto lens = read_lens_toml(bundled.toml, "x.toml");
    REQUIRE(lens.has_value());
    const auto again = read_lens_toml(write_lens_toml(*lens), "y.toml");
    REQUIRE(again.has_value());
    check_same(*lens, *again);
  }
}

// The numbers in a text, including TOML's inf: first character and length.
std::vector<std::pair<std::size_t, std::size_t>> numbers_in(const std::string& text) {
  static const std::regex kNumber("-?[0-9][0-9.]*(e-?[0-9]+)?|inf");
  std::vector<std::pair<std::size_t, std::size_t>> positions;
  for (std::sregex_iterator at(text.begin(), text.end(), kNumber), end; at != end; ++at)
    positions.emplace_back(at->position(), at->length());
  return positions;
}

TEST_CASE("whatever stands for a number in a lens file, what is read is written as the same") {
  const std::filesystem::path seeds = std::filesystem::path(CONTREJOUR_SOURCE_DIR) / "fuzz/corpus/lens_toml";
  int read = 0;
  for (const char* name : {"every_key", "formulas", "shapes", "zoom", "heliar"}) {
    const std::string text = *read_text_file(seeds / (std::string(name) + ".toml"), 1U << 20U, "");
    for (const auto& [at, length] : numbers_in(text)) {
      for (const char* value : {"-0.0", "0", "inf", "-inf", "nan", "1e-9", "-1e-300", "1e9", "-1", "0.1e1",
                                "0.30000000000000004", "9223372036854775807"}) {
        const std::string changed = std::string(text).replace(at, length, value);
        const auto lens = read_lens_toml(changed, "x.toml");
        if (!lens) continue;
        ++read;
        CAPTURE(changed);
        const std::string written = write_lens_toml(*lens);
        const auto again = read_lens_toml(written, "y.toml");
        REQUIRE(again.has_value());
        REQUIRE(write_lens_toml(*again) == written);
      }
    }
  }
  CHECK(read > 500);
}

TEST_CASE("radii are written with the digits they were typed with") {
  Prescription lens = *read_lens_toml(kSampleLens, "x.toml");
  lens.surfaces[0].curvature_per_mm = 1.0 / 30.81;
  CHECK(write_lens_toml(lens).find("radius_mm = 30.81,") != std::string::npos);
}

}  // namespace
}  // namespace contrejour::test::round_trip
