// SPDX-License-Identifier: Apache-2.0
// Properties that single hosts read differently (the table in docs/openfx.md), and a measured flare in place of a lens.
#include <doctest/doctest.h>

#include <string>

#include "contrejour/expert/flare_source.h"
#include "scenes.h"

using namespace contrejour;
using namespace contrejour::openfx;

TEST_CASE("openfx: whole frames, doubled fields, and no integer pixels, whatever the host's name") {
  for (const char* const name :
       {"org.contrejour.TestHost", "MLT", "fr.inria.Natron", "DaVinciResolveLite", "uk.co.thefoundry.nuke",
        "com.vegascreativesoftware.vegas", "com.sony.Catalyst.Edit"}) {
    CAPTURE(name);
    const TestHost host({.name = name});
    const auto described = host.describe(context::kFilter);
    const PropertySetStruct& effect = described->properties;
    CHECK(effect.get<int>(name::kSupportsTiles) == 0);
    CHECK(effect.get<int>(name::kHostFrameThreading) == 0);
    const bool is_mlt = std::string(name) == "MLT";  // which would prefer halves, and cut 16 bits down to them
    REQUIRE(effect.count(name::kSupportedPixelDepths) == (is_mlt ? 1 : 2));
    CHECK(effect.get<std::string>(name::kSupportedPixelDepths, 0) == value::kFloat);
    if (!is_mlt) CHECK(effect.get<std::string>(name::kSupportedPixelDepths, 1) == value::kHalf);
    CHECK(effect.get<std::string>(name::kNoSpatialAwareness) == "false");
    for (const char* const clip : {clip::kSource, clip::kOutput}) {
      const PropertySetStruct& properties = described->clip(clip)->properties;
      CHECK(properties.get<int>(name::kSupportsTiles) == 0);  // hosts that ask the clip in place of the effect
      CHECK(properties.get<std::string>(name::kClipFieldExtraction) == value::kFieldDoubled);
    }
  }
}

TEST_CASE("openfx: a host that never asks whether a frame is the identity") {
  const TestHost host({.name = "MLT"});
  Scene scene(host, context::kFilter);
  paint_street(scene.source);
  scene.effect().set("gain", {0.0});  // identity, but rendered all the same
  REQUIRE(scene.render() == status::kOk);
  CHECK(scene.output.memory == scene.source.memory);
}

TEST_CASE("openfx: a measured flare in place of a lens file gives the library's picture, bit for bit") {
  const TestHost host;
  Scene scene(host, context::kGenerator);
  ParamStruct& wavelengths = scene.effect().param("wavelengths");
  wavelengths.text = wavelengths.properties.get<std::string>(name::kDefault);
  scene.effect().set_text("lensFile", CONTREJOUR_MEASURED_FLARE);
  REQUIRE(scene.render() == status::kOk);
  CHECK(scene.effect().message.empty());
  const auto flare = read_flare(std::filesystem::path(CONTREJOUR_MEASURED_FLARE));
  REQUIRE(flare.has_value());
  params::Values values;
  REQUIRE(values.set("light-at", kLightAt).has_value());
  const LensState ideal = ideal_lens_of(*flare);
  const Frame frame = params::whole_frame(values, ideal, {kWidth, kHeight});
  const auto lights = params::lights(values, ideal, frame, ColourSpace::Rec709);
  const auto expected = contrejour::render(*flare, *lights, frame);
  REQUIRE(expected.has_value());
  CHECK(sum_of(scene.output) > 0.0);
  CHECK(differing_samples(scene.output, expected->image) == 0);
  // A value that it cannot follow is a message; a lens afterwards is rendered as before.
  scene.effect().set("blades", {6.0});
  REQUIRE(scene.render() == status::kOk);
  CHECK(scene.effect().message.find("blades") != std::string::npos);
  scene.effect().set_text("lensFile", "cooke-triplet");
  REQUIRE(scene.render() == status::kOk);
  CHECK(scene.effect().message.empty());
}

TEST_CASE("openfx: a measured flare on the lights of a source") {
  const TestHost host;
  Scene scene(host, context::kFilter);
  ParamStruct& wavelengths = scene.effect().param("wavelengths");
  wavelengths.text = wavelengths.properties.get<std::string>(name::kDefault);
  paint_street(scene.source);
  scene.effect().set_text("lensFile", CONTREJOUR_MEASURED_FLARE);
  REQUIRE(scene.render() == status::kOk);
  CHECK(scene.effect().message.empty());
  CHECK(sum_of(scene.output) > sum_of(scene.source));
}
