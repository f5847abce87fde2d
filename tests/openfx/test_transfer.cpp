// SPDX-License-Identifier: Apache-2.0
// The curves of coded pixels against the values that their makers publish.
#include <doctest/doctest.h>

#include "openfx/transfer.h"
#include "scenes.h"
#include "support/approx.h"

using namespace contrejour::openfx;

TEST_CASE("openfx: 18 per cent grey in each curve") {
  // ACES S-2016-001; ARRI's tables (400/1023 and 0.278396); Sony's summary (420/1023).
  CHECK(coded_from(0.18, TransferCurve::AcesCct) == test::approx(0.4135884).epsilon(1e-6));
  CHECK(coded_from(0.18, TransferCurve::LogC3) == test::approx(400.0 / 1023.0).epsilon(1e-3));
  CHECK(coded_from(0.18, TransferCurve::LogC4) == test::approx(0.278396).epsilon(1e-5));
  CHECK(coded_from(0.18, TransferCurve::SLog3) == test::approx(420.0 / 1023.0).epsilon(1e-6));
  CHECK(linear_from(0.5, TransferCurve::Srgb) == test::approx(0.2140411).epsilon(1e-6));
  CHECK(linear_from(0.5, TransferCurve::Gamma22) == test::approx(0.2176376).epsilon(1e-6));
  CHECK(linear_from(0.5, TransferCurve::Gamma24) == test::approx(0.1894646).epsilon(1e-6));
}

TEST_CASE("openfx: each curve and its inverse") {
  for (int curve = 0; curve < static_cast<int>(transfer_menu().size()); ++curve)
    for (const double linear : {-0.01, 0.0, 0.001, 0.0078, 0.02, 0.18, 1.0, 12.0})
      CHECK(linear_from(coded_from(linear, static_cast<TransferCurve>(curve)), static_cast<TransferCurve>(curve)) ==
            test::approx(linear).epsilon(1e-4));
}

TEST_CASE("openfx: light adds in scene-linear, whatever the pixels are coded as [slow]") {
  const TestHost host;
  Scene scene(host, context::kFilter);
  scene.effect().set("light1On", {1.0});
  scene.effect().set("detect", {0.0});
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) scene.source.set(x, y, 1, 0.5F);
  REQUIRE(scene.render() == contrejour::openfx::status::kOk);
  const double flare = static_cast<double>(scene.output.at(9, 9, 1)) - 0.5;
  REQUIRE(flare > 1e-4);
  scene.effect().choose("transfer", "gamma 2.4");
  REQUIRE(scene.render() == contrejour::openfx::status::kOk);
  const double decoded = std::pow(static_cast<double>(scene.output.at(9, 9, 1)), 2.4);
  CHECK(decoded - std::pow(0.5, 2.4) == test::approx(flare).epsilon(1e-3));
}
