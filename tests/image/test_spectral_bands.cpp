// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <doctest/doctest.h>

#include "contrejour/expert/colour.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

const Spectrum kLights[] = {IlluminantD65{}, IlluminantA{},   EqualEnergy{},    BlackBody{500},
                            BlackBody{1000}, BlackBody{1900}, BlackBody{100000}};
constexpr ColourSpace kSpaces[] = {ColourSpace::Rec709, ColourSpace::AcesCg};

double smooth(double lambda_nm) { return 1.5 + std::cos((lambda_nm - 400) / 60); }

// The channel's mean of a function by direct sums in steps of 0.1 nm; shares no code with the bands.
Rgb channel_mean(const Spectrum& light, ColourSpace space) {
  Rgb with{}, without{};
  for (int i = 0; i <= 4700; ++i) {
    const double nm = 360 + 0.1 * i;
    const Rgb matching = rgb_from_xyz(colour_matching(nm), space);
    for (std::size_t c = 0; c < 3; ++c) {
      with[c] += spectral_power(light, nm) * matching[c] * smooth(nm);
      without[c] += spectral_power(light, nm) * matching[c];
    }
  }
  return {with[0] / without[0], with[1] / without[1], with[2] / without[2]};
}

double worst_error(int count, const Spectrum& light, ColourSpace space) {
  const Rgb expected = channel_mean(light, space);
  Rgb found{};
  for (const SpectralBand& band : spectral_bands(count, light, space))
    for (std::size_t c = 0; c < 3; ++c) found[c] += band.weight[c] * smooth(band.lambda_nm);
  double worst = 0;
  for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(found[c] - expected[c]));
  return worst;
}

}  // namespace

TEST_CASE("each channel's weights sum to exactly 1 for any number of bands, light and space") {
  for (const ColourSpace space : kSpaces)
    for (const Spectrum& light : kLights)
      for (int count = 1; count <= 64; ++count) {
        CAPTURE(count);
        CAPTURE(light.index());
        const auto bands = spectral_bands(count, light, space);
        REQUIRE(bands.size() == static_cast<std::size_t>(count));
        Rgb sum{};
        double last_nm = 0;
        for (const SpectralBand& band : bands) {
          REQUIRE(band.lambda_nm > std::max(last_nm, 359.999));
          REQUIRE(band.lambda_nm <= 830);
          last_nm = band.lambda_nm;
          for (std::size_t c = 0; c < 3; ++c) {
            REQUIRE(std::abs(band.weight[c]) < 5);
            sum[c] += band.weight[c];
          }
        }
        for (const double total : sum) REQUIRE(total == 1);
      }
}

TEST_CASE("bands converge to the integral over the light's spectrum") {
  for (const ColourSpace space : kSpaces)
    for (const Spectrum& light : {Spectrum(IlluminantD65{}), Spectrum(IlluminantA{}), Spectrum(BlackBody{10000})}) {
      CAPTURE(light.index());
      const double at_8 = worst_error(8, light, space), at_32 = worst_error(32, light, space),
                   at_128 = worst_error(128, light, space);
      MESSAGE("largest error with 8, 32 and 128 bands: ", at_8, " ", at_32, " ", at_128);
      CHECK(at_32 < at_8 / 4);  // second order would be 16; the bands' edges move between peaks of D65 at small N
      CHECK(at_128 < at_32 / 8);
      CHECK(at_128 < 5e-4);
    }
}

TEST_CASE("one band stands at the light's visible centroid") {
  double moment = 0, total = 0;
  for (int nm = 360; nm <= 830; ++nm) {
    const Xyz m = colour_matching(nm);
    const double s = spectral_power(IlluminantD65{}, nm) * (m[0] + m[1] + m[2]);
    moment += s * nm;
    total += s;
  }
  const auto bands = spectral_bands(1, IlluminantD65{}, ColourSpace::Rec709);
  CHECK(bands[0].lambda_nm == test::approx(moment / total).epsilon(1e-5));
  CHECK(bands[0].weight == Rgb{1, 1, 1});
}

TEST_CASE("thousands of bands are as good as few") {
  // The sums above interpolate power and observer separately, the bands their product: the two differ by 2e-5.
  CHECK(worst_error(5000, IlluminantD65{}, ColourSpace::Rec709) < 4e-5);
}
