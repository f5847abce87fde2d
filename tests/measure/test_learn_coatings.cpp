// SPDX-License-Identifier: Apache-2.0
// Reflectances from ghosts of a simulated sweep, whose lens has other coatings than the file that is believed.
#include <algorithm>
#include <cmath>
#include <string>

#include <doctest/doctest.h>

#include "lens_capture.h"
#include "measure/prescription/channel_coating.h"

using namespace contrejour;
using namespace contrejour::testing;

namespace {

// The Tessar, whose file has one coating everywhere, with another one on each surface, or none.
Prescription coated_tessar() {
  Prescription lens = *find_lens("tessar");
  const auto coat = [&](int surface, double quarter_wave_nm) {
    lens.surfaces[static_cast<std::size_t>(surface - 1)].coating = {"", QuarterWave{1.38, quarter_wave_nm}};
  };
  coat(1, 430.0);
  coat(2, 520.0);
  coat(3, 640.0);
  lens.surfaces[3].coating = {};
  coat(6, 560.0);
  lens.surfaces[7].coating = {};
  return lens;
}

const LensCapture& capture() {
  static const LensCapture all = capture_lens(*configure_lens(coated_tessar(), kStopped), 320, 7);
  return all;
}

// With an optical centre that is off by as much as the light's images leave it uncertain.
LensPhotographs photographs() {
  LensPhotographs all = capture().photographs(*find_lens("tessar"), kStopped);
  all.geometry.centre_px.x += 1.5;
  return all;
}

bool warns_of(const LearntCoatings& learnt, const std::string& text) {
  return std::ranges::any_of(learnt.warnings, [&](const std::string& w) { return w.find(text) != std::string::npos; });
}

}  // namespace

TEST_CASE("learn coatings: reflectances that the ghosts determine, of coatings that differ from the file's [slow]") {
  CoatingFitOptions options;
  options.max_rounds = 4;
  const auto learnt = learn_coatings(photographs(), options);
  REQUIRE_MESSAGE(learnt.has_value(), learnt.error().to_string());
  const LensState truth = *configure_lens(coated_tessar(), kStopped), lens = *configure_lens(learnt->lens, kStopped);
  const auto bands = spectral_bands(16, IlluminantD65{}, ColourSpace::AcesCg);
  CHECK(learnt->unknowns == 6);
  CHECK(learnt->surfaces.size() == 6);
  double worst = 0.0;
  for (const LearntReflectance& of : learnt->surfaces) {
    const auto at = static_cast<std::size_t>(of.surface - 1);
    const Rgb real = channel_reflectance(truth.surfaces[at], bands),
              file = channel_reflectance(lens.surfaces[at], bands);
    for (std::size_t c = 0; c < 3; ++c) {
      CAPTURE(of.surface);
      CAPTURE(c);
      CHECK(of.determined[c]);
      worst = std::max(worst, std::abs(of.reflectance[c] / real[c] - 1.0));
      CHECK(std::abs(file[c] / of.reflectance[c] - 1.0) < 0.025);  // the file says what was learnt
    }
  }
  MESSAGE("largest relative error of a reflectance: ", worst);
  CHECK(worst < 0.1);
  CHECK(learnt->rank == std::array<int, 3>{6, 6, 6});
  CHECK(learnt->warnings.empty());
}

// Forty ghosts overlap, and the file's green reflectances are off by up to a factor of 90.
TEST_CASE("learn coatings: a lens of many surfaces, whose file has quite other coatings [slow]") {
  const Prescription file = *find_lens("planar-50");
  Prescription real = file;
  const LensState written = *configure_lens(file, kStopped);
  const std::vector<double> quarter_waves_nm{430, 520, 640, 0, 560, 480, 600, 0, 500, 450};  // 0: not coated
  std::vector<std::size_t> coated;
  for (std::size_t k = 0; k < real.surfaces.size(); ++k) {
    const SurfaceState& surface = written.surfaces[k];
    if (surface.kind != SurfaceKind::Refracting || is_air(surface.before) == is_air(surface.after)) continue;
    const double quarter_wave_nm = quarter_waves_nm[coated.size() % quarter_waves_nm.size()];
    real.surfaces[k].coating = quarter_wave_nm > 0.0 ? Coating{"", QuarterWave{1.38, quarter_wave_nm}} : Coating{};
    coated.push_back(k);
  }
  const LensState truth = *configure_lens(real, kStopped);
  const auto learnt = learn_coatings(capture_lens(truth, 320, 9).photographs(file, kStopped));
  REQUIRE_MESSAGE(learnt.has_value(), learnt.error().to_string());
  const auto bands = spectral_bands(16, IlluminantD65{}, ColourSpace::AcesCg);
  REQUIRE(learnt->surfaces.size() == coated.size());
  std::size_t good = 0, determined = 0;
  double worst_error = 0.0;  // in standard errors
  for (const LearntReflectance& of : learnt->surfaces) {
    const Rgb reflectances = channel_reflectance(truth.surfaces[static_cast<std::size_t>(of.surface - 1)], bands);
    for (std::size_t c = 0; c < 3; ++c) {
      const double off = std::abs(of.reflectance[c] / reflectances[c] - 1.0);
      good += off < 0.1 ? 1 : 0;
      determined += of.determined[c] ? 1 : 0;
      worst_error = std::max(worst_error, off / of.relative_error[c]);
    }
  }
  MESSAGE(good, " of ", 3 * coated.size(), " reflectances within 10 per cent, ", worst_error, " standard errors");
  CHECK(determined == 3 * coated.size());
  CHECK(good + 4 >= 3 * coated.size());
  CHECK(worst_error < 5.0);
}

TEST_CASE("learn coatings: few ghosts leave reflectances open, and the warning names their surfaces [slow]") {
  CoatingFitOptions options;
  options.max_rounds = 1;
  options.max_ghosts = 2;  // no odd cycle: only products are known
  const auto learnt = learn_coatings(photographs(), options);
  REQUIRE_MESSAGE(learnt.has_value(), learnt.error().to_string());
  CHECK(learnt->rank[1] <= 2);
  CHECK(warns_of(*learnt, "after round 1"));
  CHECK(std::ranges::count_if(learnt->surfaces, [](const auto& s) { return s.determined[1]; }) == 0);
  for (const GhostEnergy& energy : learnt->ghosts) {
    CHECK(warns_of(*learnt, std::to_string(energy.ghost.i)));
    CHECK(warns_of(*learnt, std::to_string(energy.ghost.j)));
  }
}

TEST_CASE("learn coatings: the same bits for any number of threads [slow]") {
  CoatingFitOptions options;
  options.max_rounds = 1;
  options.max_width = 80;
  options.max_ghosts = 6;
  const auto one = learn_coatings(photographs(), options, {.threads = 1});
  const auto three = learn_coatings(photographs(), options, {.threads = 3});
  REQUIRE(one.has_value());
  REQUIRE(three.has_value());
  CHECK(write_lens_toml(one->lens) == write_lens_toml(three->lens));
}

TEST_CASE("learn coatings: what cannot be is refused") {
  CoatingFitOptions options;
  options.max_ghosts = 0;
  CHECK(!learn_coatings(photographs(), options));
  LensPhotographs dark;
  dark.lens = *find_lens("tessar");
  CHECK(!learn_coatings(dark));
}

namespace {

// The largest error of the reflectance, at an angle of incidence and over the visible, of a coating that has only a
// real one's means at normal incidence. Relative; reflectances below a hundredth count as that.
double worst_at_angle(const SurfaceState& real, double angle_deg) {
  const auto bands = spectral_bands(16, IlluminantD65{}, ColourSpace::Rec709);
  const Coating learnt = channel_coating(real, channel_reflectance(real, bands), bands);
  double worst = 0.0;
  for (double lambda_nm = 460.0; lambda_nm <= 620.0; lambda_nm += 20.0) {
    const double before = refractive_index(real.before, lambda_nm), after = refractive_index(real.after, lambda_nm);
    const auto at = [&](const Coating& coating) {
      return reflectance(coating, before, after, std::cos(rad_from_deg(angle_deg)), lambda_nm);
    };
    worst = std::max(worst, std::abs(at(learnt) - at(real.coating)) / std::max(at(real.coating), 0.01));
  }
  return worst;
}

}  // namespace

TEST_CASE("learn coatings: a coating that is known by three means reflects as films do at an angle") {
  SurfaceState surface = configure_lens(coated_tessar(), {})->surfaces[1];
  REQUIRE(is_air(surface.after));
  std::swap(surface.before, surface.after);
  for (const double lambda0_nm : {430.0, 520.0, 640.0}) {
    CAPTURE(lambda0_nm);
    surface.coating = {"", QuarterWave{1.38, lambda0_nm}};
    CHECK(worst_at_angle(surface, 0.0) < 0.025);
    CHECK(worst_at_angle(surface, 45.0) < 0.12);
  }
  surface.coating = {};
  CHECK(worst_at_angle(surface, 60.0) < 0.01);
  for (const CoatingDesign several : {CoatingDesign::VCoat, CoatingDesign::WCoat, CoatingDesign::QuarterHalfQuarter}) {
    surface.coating = {"", DesignedCoating{several, 550.0}};
    CHECK(worst_at_angle(surface, 40.0) < 0.4);
  }
}
