// SPDX-License-Identifier: Apache-2.0
// The shortest program that renders a flare with an installed Contrejour; README.md shows the same lines.
#include <cstdio>
#include <numeric>

#include <contrejour/contrejour.h>

int main() {
  using namespace contrejour;
  const Result<Prescription> prescription = find_lens("heliar");
  if (!prescription) {
    std::fprintf(stderr, "%s\n", prescription.error().to_string().c_str());
    return 1;
  }
  const Result<LensState> lens = configure_lens(*prescription, {.f_number = 8.0});
  if (!lens) {
    std::fprintf(stderr, "%s\n", lens.error().to_string().c_str());
    return 1;
  }

  FrameSettings settings;
  settings.frame = frame_on_sensor(*lens, 96, 64);
  const double azimuth_rad = 0.15;
  const double elevation_rad = 0.10;
  const Light light{.direction = direction_from_angles(azimuth_rad, elevation_rad), .value = {1000, 900, 800}};
  const BundleOptions bundle{.grid = {.rays = 32}};
  const Result<Flare> flare = render(bundle, *lens, std::span(&light, 1), settings);
  if (!flare) {
    std::fprintf(stderr, "%s\n", flare.error().to_string().c_str());
    return 1;
  }
  const double flux = std::accumulate(flare->image.pixels.begin(), flare->image.pixels.end(), 0.0);
  std::printf("%s: %d ghosts, flux %.6g of a light of 2700\n", lens->name.c_str(), flare->statistics.ghosts_rendered,
              flux);
  return flux > 0 ? 0 : 1;
}
