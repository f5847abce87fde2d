// SPDX-License-Identifier: Apache-2.0
// The standard's demands on a plug-in, and what hosts get wrong: actions in any order, suites and properties that are
// missing.
#include <doctest/doctest.h>

#include "contrejour/expert/parameter.h"
#include "scenes.h"

using namespace contrejour;
using namespace contrejour::openfx;

TEST_CASE("openfx: the plug-in is what its table says") {
  const TestHost host;
  CHECK(host.load_status() == status::kOk);
  CHECK(std::string(host.plugin().api) == kImageEffectApi);
  CHECK(host.plugin().api_version == 1);
  CHECK(host.plugin().version_major == 1);  // a change orphans saved projects
  CHECK(std::string(host.plugin().identifier) == "org.contrejour.LensFlare");
}

TEST_CASE("openfx: loading many times and describing twice") {
  const TestHost host;
  for (int k = 0; k < 50; ++k) CHECK(host.act(action::kLoad, nullptr) == status::kOk);
  const auto first = host.describe(context::kFilter), second = host.describe(context::kFilter);
  CHECK(first->params.params.size() == second->params.params.size());
  CHECK(first->clips.size() == 2);
  CHECK(first->properties.get<std::string>(name::kSupportedContexts, 0) == context::kFilter);
  CHECK(first->properties.count(name::kSupportedContexts) == 3);
  CHECK(first->properties.get<std::string>(name::kSupportedPixelDepths, 0) == value::kFloat);
  CHECK(first->properties.get<int>(name::kSupportsTiles, 0, 1) == 0);
  CHECK(first->clip(clip::kSource)->properties.get<int>(name::kSupportsTiles, 0, 1) == 0);
  for (int k = 0; k < 50; ++k) CHECK(host.act(action::kUnload, nullptr) == status::kOk);
}

TEST_CASE("openfx: clips of each context") {
  const TestHost host;
  CHECK(host.describe(context::kGenerator)->clip(clip::kSource) == nullptr);
  CHECK(host.describe(context::kGeneral)->clip(clip::kSource)->properties.get<int>(name::kClipOptional) == 1);
  CHECK(host.describe(context::kFilter)->clip(clip::kSource)->properties.get<int>(name::kClipOptional) == 0);
}

TEST_CASE("openfx: unknown actions get the default reply") {
  const TestHost host;
  const Scene scene(host, context::kFilter);
  for (const char* action :
       {"OfxActionBeginInstanceChanged", "OfxImageEffectActionGetFramesNeeded", "OfxImageEffectActionGetTimeDomain",
        "OfxImageEffectActionBeginSequenceRender", "nonsense"})
    CHECK(host.act(action, &scene.effect()) == status::kReplyDefault);
  CHECK(host.act(action::kSyncPrivateData, &scene.effect()) == status::kOk);
  CHECK(host.act(action::kPurgeCaches, &scene.effect()) == status::kOk);
  CHECK(host.act(nullptr, &scene.effect()) == status::kErrValue);
}

TEST_CASE("openfx: instances that are destroyed in any order, and after the plug-in was unloaded") {
  const TestHost host;
  auto first = host.create(context::kFilter, kWidth, kHeight), second = host.create(context::kGenerator, 64, 48);
  host.destroy(*first);
  CHECK(host.render(*first, {.window = kBounds}) == status::kErrBadHandle);
  host.destroy(*first);  // twice
  CHECK(host.act(action::kUnload, nullptr) == status::kOk);
  host.destroy(*second);
  CHECK(host.act(action::kLoad, nullptr) == status::kOk);
}

TEST_CASE("openfx: a host without the suites that everything needs is refused, others are not missed") {
  for (const char* suite : {"OfxPropertySuite1", "OfxParameterSuite1", "OfxImageEffectSuite1"}) {
    const TestHost host({.missing_suites = {suite}});
    CHECK(host.load_status() == status::kErrMissingHostFeature);
  }
  const TestHost host({.missing_suites = {"OfxMultiThreadSuite1", "OfxMessageSuite1", "OfxMessageSuite2",
                                          "OfxInteractSuite1", "OfxDrawSuite1"}});
  const Scene scene(host, context::kGenerator);
  scene.effect().set_text("lensFile", "/nowhere.toml");
  CHECK(scene.render() == status::kOk);  // a fault that nobody can be shown
}

TEST_CASE("openfx: a host that knows little more than version 1.0") {
  const TestHost host(
      {.known_properties = {.refused = {name::kNoSpatialAwareness, name::kPluginDescription, name::kRenderScale,
                                        name::kInteractiveRender, name::kRenderQualityDraft,
                                        name::kImagePixelAspectRatio, name::kClipConnected, name::kDisplayMin,
                                        name::kDigits, name::kProjectOffset}}});
  Scene scene(host, context::kGenerator);
  REQUIRE(scene.render() == status::kOk);
  CHECK(sum_of(scene.output) > 0.0);
}

TEST_CASE("openfx: a host that describes without a context and names itself MLT") {
  const TestHost host({.name = "MLT", .passes_context = false});
  Scene scene(host, context::kFilter);
  CHECK(scene.effect().param("transfer").numbers[0] == 1.0);  // its pixels are coded as sRGB
  paint_street(scene.source);
  CHECK(scene.render() == status::kOk);
  CHECK(sum_of(scene.output) > sum_of(scene.source));
}

TEST_CASE("openfx: nothing to add is the identity") {
  const TestHost host;
  const Scene scene(host, context::kFilter);
  PropertySetStruct in, out;
  in.put<double>(name::kTime, {7.0});
  CHECK(host.act(action::kIsIdentity, &scene.effect(), &in, &out) == status::kReplyDefault);
  scene.effect().set("detect", {0.0});
  CHECK(host.act(action::kIsIdentity, &scene.effect(), &in, &out) == status::kOk);
  CHECK(out.get<std::string>(name::kName) == clip::kSource);
  CHECK(out.get<double>(name::kTime) == 7.0);
  scene.effect().set("light1On", {1.0});
  CHECK(host.act(action::kIsIdentity, &scene.effect(), &in, &out) == status::kReplyDefault);
  scene.effect().set("gain", {0.0});
  CHECK(host.act(action::kIsIdentity, &scene.effect(), &in, &out) == status::kOk);
}

TEST_CASE("openfx: regions are those of the project and the source") {
  const TestHost host;
  Scene scene(host, context::kFilter, {-10, 4, 40, 60});
  PropertySetStruct in, out;
  in.put<double>(name::kTime, {1.0});
  REQUIRE(host.act(action::kGetRegionOfDefinition, &scene.effect(), &in, &out) == status::kOk);
  const double expected[] = {-10.0, 0.0, 64.0, 60.0};
  for (std::size_t k = 0; k < 4; ++k) CHECK(out.get<double>(name::kRegionOfDefinition, k) == expected[k]);
  REQUIRE(host.act(action::kGetRegionsOfInterest, &scene.effect(), &in, &out) == status::kOk);
  const double source[] = {-10.0, 4.0, 40.0, 60.0};
  for (std::size_t k = 0; k < 4; ++k) CHECK(out.get<double>(name::kClipRoiOfSource, k) == source[k]);
  scene.effect().choose("sensorFrame", "source");
  REQUIRE(host.act(action::kGetRegionOfDefinition, &scene.effect(), &in, &out) == status::kOk);
  for (std::size_t k = 0; k < 4; ++k) CHECK(out.get<double>(name::kRegionOfDefinition, k) == source[k]);
}

TEST_CASE("openfx: a file of lights makes frames differ") {
  const TestHost host;
  const Scene scene(host, context::kGenerator);
  PropertySetStruct out;
  CHECK(host.act(action::kGetClipPreferences, &scene.effect(), nullptr, &out) == status::kReplyDefault);
  scene.effect().set_text("lightsFile", "lights.toml");
  CHECK(host.act(action::kGetClipPreferences, &scene.effect(), nullptr, &out) == status::kOk);
  CHECK(out.get<int>(name::kFrameVarying) == 1);
}
