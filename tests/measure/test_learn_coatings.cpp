// SPDX-License-Identifier: Apache-2.0
// Reflectances from ghosts of simulated captures, whose lens has other coatings than the file that is believed.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <doctest/doctest.h>

#include "lens_capture.h"
#include "measure/prescription/channel_coating.h"
#include "measure/prescription/lens_numbers.h"

using namespace contrejour;
using namespace contrejour::testing;

TEST_CASE("explore coatings") {
  const char* name = std::getenv("LENS") ? std::getenv("LENS") : "tessar";
  const int width = std::getenv("WIDTH") ? std::atoi(std::getenv("WIDTH")) : 320;
  const int stations = std::getenv("STATIONS") ? std::atoi(std::getenv("STATIONS")) : 9;
  const Prescription believed = *find_lens(name);
  Prescription truth = believed;
  int n = 0;
  for (Surface& s : truth.surfaces) {
    const double nm[] = {430, 520, 640, 480, 700, 560};
    if (s.kind == SurfaceKind::Refracting) s.coating = n % 4 == 3 ? Coating{} : Coating{"", QuarterWave{1.38, nm[n % 6]}};
    ++n;
  }
  for (std::size_t k = 1; k < truth.surfaces.size(); ++k)
    if (!is_air(truth.surfaces[k].glass_after) && !is_air(truth.surfaces[k - 1].glass_after)) truth.surfaces[k].coating = {};
  const LensState lens = *configure_lens(truth);
  const LensCapture capture = capture_lens(lens, width, stations);
  CoatingFitOptions options;
  options.max_width = 320;
  if (std::getenv("ROUNDS")) options.max_rounds = std::atoi(std::getenv("ROUNDS"));
  const auto learnt = learn_coatings(capture.photographs(std::getenv("SAME") ? truth : believed), options);
  std::printf("centre %.3f %.3f true %.3f %.3f\n", capture.geometry.centre_px.x, capture.geometry.centre_px.y, 0.25*width+2.5, 0.25*capture.settings.height-1.5);
  for (const auto& d : capture.direct) std::printf("%.4f ", d->rate[1] * 4 / capture.settings.light_rate);
  std::printf("\n");
  REQUIRE_MESSAGE(learnt.has_value(), learnt.error().to_string());
  const auto bands = spectral_bands(16, IlluminantD65{}, ColourSpace::Rec709);
  const LensState before = *configure_lens(believed);
  for (const LearntReflectance& of : learnt->surfaces) {
    const auto at = static_cast<std::size_t>(of.surface - 1);
    const Rgb t = channel_reflectance(lens.surfaces[at], bands), b = channel_reflectance(before.surfaces[at], bands);
    std::printf("%2d", of.surface);
    for (std::size_t c = 0; c < 3; ++c)
      std::printf("  | %.4f -> %.4f (true %.4f) off %+5.1f%% se %4.1f%% %s", b[c], of.reflectance[c], t[c],
                  100 * (of.reflectance[c] / t[c] - 1), 100 * of.relative_error[c], of.determined[c] ? "" : "OPEN");
    std::printf("\n");
  }
  for (const GhostEnergy& g : learnt->ghosts)
    std::printf("%s  %.3f+-%.3f %.3f+-%.3f %.3f+-%.3f\n", ghost_name(g.ghost).c_str(), g.ratio[0], g.error[0], g.ratio[1], g.error[1], g.ratio[2], g.error[2]);
  for (const auto& w : learnt->warnings) std::printf("W %s\n", w.c_str());
  for (const auto& [a, b] : learnt->alike) std::printf("alike %s %s\n", ghost_name(a).c_str(), ghost_name(b).c_str());
  std::printf("rounds %d rank %d %d %d of %d\n", learnt->rounds, learnt->rank[0], learnt->rank[1], learnt->rank[2], learnt->unknowns);
}

TEST_CASE("explore adjust") {
  const char* name = std::getenv("LENS") ? std::getenv("LENS") : "tessar";
  const int width = std::getenv("WIDTH") ? std::atoi(std::getenv("WIDTH")) : 320;
  const int stations = std::getenv("STATIONS") ? std::atoi(std::getenv("STATIONS")) : 7;
  const Prescription believed = *find_lens(name);
  LensTolerances tolerances;
  AdjustableLens planted = *adjustable_lens(believed, {}, tolerances);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(planted.numbers.size()));
  const auto plant = [&](LearntKind kind, int first, double value) {
    for (std::size_t k = 0; k < planted.numbers.size(); ++k)
      if (planted.numbers[k].kind == kind && (first == 0 || planted.numbers[k].first == first)) { values[static_cast<Eigen::Index>(k)] = value; break; }
  };
  plant(LearntKind::TiltY, 3, 0.001745);
  if (!std::getenv("TILTONLY")) { plant(LearntKind::Gap, 0, 0.1); plant(LearntKind::Focus, 0, 0.2); }
  Prescription truth = planted.prescription(values);
  for (Surface& s : truth.surfaces)
    if (s.kind == SurfaceKind::Refracting) s.coating = {"", QuarterWave{1.38, 480}};
  const LensCapture capture = capture_lens(*configure_lens(truth), width, stations);
  AdjustOptions options;
  options.max_width = 320;
  if (std::getenv("GHOSTS")) options.max_ghosts = std::atoi(std::getenv("GHOSTS"));
  const auto learnt = adjust_lens(capture.photographs(believed), options);
  REQUIRE_MESSAGE(learnt.has_value(), learnt.error().to_string());
  for (std::size_t k = 0; k < learnt->numbers.size(); ++k) {
    const LearntNumber& n = learnt->numbers[k];
    const double scale = n.kind <= LearntKind::TiltY ? 57.29578 : 1.0;
    std::printf("%-40s %+.4f +- %.4f  true %+.4f  tolerance %.3f %s\n", learnt_name(n).c_str(), scale * n.value, scale * n.error, scale * values[static_cast<Eigen::Index>(k)], scale * n.tolerance, n.determined ? "" : "OPEN");
  }
  std::printf("rms %.3f -> %.3f px, %d drawings, centre %.2f %.2f true %.2f %.2f\n", learnt->rms_before_px, learnt->rms_after_px, learnt->drawings, learnt->centre_px.x, learnt->centre_px.y, 0.25*width+2.5, 0.25*capture.settings.height-1.5);
  for (const auto& w : learnt->warnings) std::printf("W %s\n", w.c_str());
}
