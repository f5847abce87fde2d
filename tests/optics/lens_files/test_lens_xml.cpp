// SPDX-License-Identifier: Apache-2.0
// XML lenses of OpenLensFlare and the LensFlareFramework.
#include <cmath>
#include <map>

#include "contrejour/expert/first_order.h"
#include "optics/lens_files/reader_checks.h"
#include "shared_data.h"
#include "support/approx.h"

namespace contrejour::test::lens_xml {
namespace {

std::string element(const std::string& type, const std::string& height, const std::string& thickness,
                    const std::string& radius, const std::string& n, const std::string& lambda) {
  return "<element><type>" + type + "</type><height>" + height + "</height>\n<thickness>" + thickness +
         "</thickness><radius> " + radius + "\n</radius><refractiveIndex>" + n +
         "</refractiveIndex><abbeNumber>58.5</abbeNumber><coatingLambda>" + lambda +
         "</coatingLambda><coatingIor>1.38</coatingIor></element>\n";
}

// Elements begin on lines 6, 9, 12 and so on.
const std::string kSample =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<opticalSystem><name>a &amp; b</name><fnumber>22</fnumber>\n"
    "<effectiveFocalLength>100</effectiveFocalLength><fieldOfView>60</fieldOfView>\n"
    "<filmWidth>53</filmWidth><filmHeight>40.2</filmHeight><!-- a comment -->\n"
    "<elements>\n" +
    element("lensSpherical", "14", "5", "40", "1.6", "620.0") +
    element("lensSpherical", "14", "2", "-90", "1.7", "620.0") +
    element("lensSpherical", "14", "3", "200.0", "1.0", "620.0") + element("apertureStop", "10", "3", "0", "1", "0") +
    element("lensSpherical", "12", "4", "0", "1.5", "0") + element("lensSpherical", "12", "80", "-50", "1", "480") +
    element("sensor", "18", "0.001", "0", "1", "0") + "</elements></opticalSystem>\n";

std::string edited(std::string_view from, std::string_view to) { return replaced(kSample, from, to); }
void check_refused(const std::string& text, int line, const std::string& words) {
  check_refused_by(read_lens_xml, text, line, words);
}

}  // namespace

TEST_CASE("an OpenLensFlare lens in every detail") {
  CHECK(looks_like_lens_xml(kSample));
  const Prescription lens = read_or_fail(read_lens_xml, kSample);
  CHECK(lens.name == "a & b");
  CHECK(lens.sensor_width_mm == 53.0);
  CHECK(lens.sensor_height_mm == 40.2);
  CHECK(lens.stated.focal_length_mm == 100.0);
  CHECK(lens.stated.back_focal_distance_mm == 80.0);
  REQUIRE(lens.surfaces.size() == 6);
  const auto& s = lens.surfaces;
  CHECK(s[0].curvature_per_mm == 1.0 / 40.0);
  CHECK(s[0].thickness_mm == 5.0);
  CHECK(s[0].semi_diameter_mm == 14.0);
  CHECK(s[0].source_line == 6);
  CHECK(s[0].glass_after == Glass{"", AbbeGlass{1.6, 58.5}});
  CHECK(s[0].coating == Coating{"", QuarterWave{1.38, 620.0}});
  CHECK(s[1].coating == Coating{});  // cement
  CHECK(is_air(s[2].glass_after));
  CHECK(s[3].kind == SurfaceKind::Stop);
  CHECK(s[4].coating == Coating{});
  CHECK(s[5].coating == Coating{"", QuarterWave{1.38, 480.0}});
  CHECK(lens.f_number < 10.0);  // <fnumber> is the setting, not the widest
  REQUIRE(lens.warnings.size() == 1);
  CHECK(lens.warnings[0].find("(line 9)") != std::string::npos);
  check_round_trip(lens);
}

TEST_CASE("OpenLensFlare's heights: as surfaces fit") {
  const std::string half = "<elements>";
  const auto multiplied = [&](std::string text) {
    return replaced(text, half, "<heightMultiplier>0.5</heightMultiplier><elements>");
  };
  // Semi-diameters though the multiplier says diameters.
  const Prescription semi = read_or_fail(read_lens_xml, multiplied(kSample));
  CHECK(semi.surfaces[0].semi_diameter_mm == 14.0);
  CHECK(semi.warnings.at(0).find("heightMultiplier of 0.5 (line 5) is not followed") != std::string::npos);
  // Diameters: as semi-diameters the first surface would cross the second.
  std::string doubled = kSample;
  for (const char* height : {"14", "14", "14", "10", "12", "12"}) {
    const std::string from = std::string("<height>") + height + "</height>";
    doubled = replaced(doubled, from, "<height>" + std::to_string(2 * std::stoi(height)) + "</height>");
  }
  const Prescription full = read_or_fail(read_lens_xml, multiplied(doubled));
  CHECK(full.surfaces[0].semi_diameter_mm == 14.0);
  CHECK(full.surfaces[3].semi_diameter_mm == 10.0);
  CHECK(full.warnings.size() == 1);  // films alone
  CHECK(read_or_fail(read_lens_xml, doubled).warnings.at(0).find("taken for diameters") != std::string::npos);
}

TEST_CASE("what is wrong with an OpenLensFlare lens, and where") {
  check_refused(edited(" 40\n", " forty\n"), 7, "<radius> 'forty' is no number");
  check_refused(edited("<thickness>5</thickness>", ""), 6, "without <thickness>");
  check_refused(edited("lensSpherical", "mirror"), 6, "element type 'mirror' is not known");
  check_refused(edited("lensSpherical", "lensAspherical"), 6, "nowhere said");
  check_refused(edited("apertureStop", "lensSpherical"), 6, "not all of the lens");  // which states 100 mm
  check_refused(edited("lensSpherical", "sensor"), 9, "behind the sensor");
  check_refused(edited("</elements>", "</element>"), 27, "not valid XML");
  check_refused("<a/>", 0, "it is a <a>");
  check_refused("<opticalSystem/>", 1, "no <element>");
  check_refused("<", 1, "not valid XML");
  std::string deep;
  for (int k = 0; k < 200'000; ++k) deep += "<a>";
  check_refused(deep, 1, "not valid XML");
  std::string many = "<opticalSystem><elements>";
  for (int k = 0; k < 201; ++k) many += element("lensSpherical", "1", "1", "40", "1.6", "0");
  check_refused(many + "</elements></opticalSystem>", 601, "more than 200 surfaces");
}

namespace {

// Semi-diameter of the first surface.
double front_mm(const std::string& file) {
  for (const auto& [name, semi_mm] :
       {std::pair("heliar", 14.5), {"canon", 38.0}, {"angenieux", 27.0}, {"itoh", 82.0}, {"nikon", 32.2}})
    if (file.find(name) != std::string::npos) return semi_mm;
  return 0.0;
}

}  // namespace

TEST_CASE("XML samples: focal lengths and focus as computed by another program") {
  // Focal length, back focal distance, as another program computes them; the Nikon's names say 80 to 200 mm.
  const std::map<std::string, std::pair<double, double>> kLenses = {
      {"bodonyi-LensFlareFramework/Assets/Lenses/canon-zoom-short.xml", {72.12, 52.45}},
      {"bodonyi-LensFlareFramework/Assets/Lenses/canon-zoom-mid.xml", {134.95, 52.43}},
      {"bodonyi-LensFlareFramework/Assets/Lenses/canon-zoom-long.xml", {193.91, 52.42}},
      {"bodonyi-LensFlareFramework/Assets/Lenses/double-gauss-angenieux.xml", {49.99, 27.90}},
      {"bodonyi-LensFlareFramework/Assets/Lenses/heliar-tronnier.xml", {99.24, 81.32}},
      {"bodonyi-LensFlareFramework/Assets/Lenses/itoh-zoom-short.xml", {99.92, 149.46}},
      {"bodonyi-LensFlareFramework/Assets/Lenses/itoh-zoom-mid.xml", {118.57, 165.77}},
      {"bodonyi-LensFlareFramework/Assets/Lenses/itoh-zoom-long.xml", {145.73, 189.53}},
      {"bodonyi-LensFlareFramework/Assets/Lenses/nikon-zoom-short.xml", {57.2, 28.73}},
      {"bodonyi-LensFlareFramework/Assets/Lenses/nikon-zoom-mid.xml", {93.0, 33.74}},
      {"bodonyi-LensFlareFramework/Assets/Lenses/nikon-zoom-long.xml", {143.1, 28.74}},
      {"OpenLensFlare/heliar-tronnier.xml", {99.24, 81.32}},
      {"OpenLensFlare/canon-zoom-mid.xml", {134.95, 52.43}},
      {"OpenLensFlare/itoh-zoom-mid.xml", {118.57, 165.77}},
      {"OpenLensFlare/nikon-zoom-mid.xml", {93.0, 33.74}}};
  for (const auto& [file, figures] : kLenses) {
    const auto path = shared_data("lenses/" + file);
    if (!path) return;
    CAPTURE(file);
    const auto lens = read_lens(*path);
    REQUIRE_MESSAGE(lens.has_value(), (lens ? "" : lens.error().to_string()));
    const auto state = configure_lens(*lens);
    REQUIRE_MESSAGE(state.has_value(), (state ? "" : state.error().to_string()));
    const FirstOrder computed = first_order(*state, kLineD_nm);
    CHECK(computed.focal_length_mm == test::approx(figures.first).epsilon(6e-4));
    CHECK(computed.back_focal_distance_mm == test::approx(figures.second).epsilon(6e-4));
    CHECK(lens->surfaces[0].semi_diameter_mm == test::approx(front_mm(file)).epsilon(1e-6));
    check_round_trip(*lens);
  }
}

}  // namespace contrejour::test::lens_xml
