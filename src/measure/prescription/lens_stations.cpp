// SPDX-License-Identifier: Apache-2.0
#include "measure/prescription/lens_stations.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <span>

#include "contrejour/expert/trace.h"
#include "contrejour/render.h"

namespace contrejour::inline internal {
namespace {

// Relative to the brightest pixel of all ghosts; dim ghosts are measured as well.
constexpr double kDrawingError = 0.001;
constexpr double kMaskedRadii = 2.5;  // of the light's image, beyond which its blurred edge is dim
constexpr double kMaskedEdge_px = 2.0;

// A sweep whose pictures say how large they are, and whether they come from a mosaic.
struct SizedSweep {
  FlareSweep sweep;
  std::shared_ptr<std::atomic<bool>> mosaic = std::make_shared<std::atomic<bool>>(false);
  std::shared_ptr<std::atomic<int>> width = std::make_shared<std::atomic<int>>(0);
  std::shared_ptr<std::atomic<int>> height = std::make_shared<std::atomic<int>>(0);
};

SizedSweep sized(const FlareSweep& sweep) {
  SizedSweep all{sweep};
  all.sweep.picture = [inner = sweep.picture, width = all.width, height = all.height,
                       mosaic = all.mosaic](std::size_t k) {
    Result<CapturedImage> picture = inner(k);
    if (picture) {
      if (picture->pattern) mosaic->store(true);
      width->store(picture->rate.width);
      height->store(picture->rate.height);
    }
    return picture;
  };
  return all;
}

// columns: what each channel of the picture adds to those of the other space.
void convert_pixel(FitStation& station, int x, int y, const std::array<Rgb, 3>& columns) {
  Rgb rate{}, variance{};
  bool known = true;
  for (int c = 0; c < 3; ++c) {
    const auto value = static_cast<double>(station.rate.at(x, y, c)),
               weight = static_cast<double>(station.weight.at(x, y, c));
    known = known && weight > 0.0;
    for (std::size_t to = 0; to < 3; ++to) {
      const double factor = columns[static_cast<std::size_t>(c)][to];
      rate[to] += factor * value;
      if (weight > 0.0) variance[to] += factor * factor / weight;
    }
  }
  for (int c = 0; c < 3; ++c) {
    const auto at = static_cast<std::size_t>(c);
    station.rate.at(x, y, c) = static_cast<float>(rate[at]);
    station.weight.at(x, y, c) = known ? static_cast<float>(1.0 / variance[at]) : 0.0F;
  }
}

}  // namespace

Result<LensStations> lens_stations(const LensPhotographs& photographs, const LensState& lens, int max_width,
                                   const Context& context) {
  if (!photographs.sweep.picture) return invalid_argument("a sweep without pictures");
  const SizedSweep with_size = sized(photographs.sweep);
  FlareFitOptions options;
  options.max_width = max_width;
  Result<SweepStations> pictures = reduced_stations(with_size.sweep, photographs.geometry, options, context);
  if (!pictures) return tl::unexpected(pictures.error());
  LensStations stations;
  const TangentFrame& reduced = pictures->stations.front().frame.pixels;
  const double block = std::abs(photographs.geometry.focal_length_px) / reduced.focal_length_px;
  const double pitch_mm = photographs.pixel_pitch_mm > 0.0
                              ? photographs.pixel_pitch_mm
                              : frame_on_sensor(lens, *with_size.width, *with_size.height).pixel_pitch_mm;
  stations.pictures = std::move(*pictures);
  stations.centre_px = reduced.centre_px;
  stations.pixel_pitch_mm = block * pitch_mm;
  stations.full_pitch_mm = pitch_mm;
  stations.source_radius_px = reduced.focal_length_px * std::tan(photographs.source_radius_rad);
  stations.source_radius_rad = photographs.source_radius_rad;
  stations.is_mosaic = *with_size.mosaic;
  stations.spectrum = photographs.spectrum;
  return stations;
}

LensStations in_acescg(LensStations stations) {
  if (stations.space == ColourSpace::AcesCg) return stations;
  std::array<Rgb, 3> of;  // ACEScg of each channel by itself
  for (std::size_t c = 0; c < 3; ++c) {
    Rgb unit{};
    unit[c] = 1.0;
    of[c] = rgb_from_xyz(xyz_from_rgb(unit, stations.space), ColourSpace::AcesCg);
  }
  for (FitStation& station : stations.pictures.stations) {
    for (int y = 0; y < station.rate.height; ++y)
      for (int x = 0; x < station.rate.width; ++x) convert_pixel(station, x, y, of);
  }
  stations.space = ColourSpace::AcesCg;
  return stations;
}

double masked_px(const LensStations& stations) {
  return std::max(stations.pictures.masked_px, kMaskedRadii * stations.source_radius_px + kMaskedEdge_px);
}

Frame frame_of(const LensStations& stations, Vec2 centre_px) {
  const Image& picture = stations.pictures.stations.front().rate;
  Frame frame;
  frame.width = frame.full_width = picture.width;
  frame.height = frame.full_height = picture.height;
  frame.pixel_pitch_mm = stations.pixel_pitch_mm;
  frame.shift_mm = {(0.5 * frame.width - centre_px.x) * frame.pixel_pitch_mm,
                    (centre_px.y - 0.5 * frame.height) * frame.pixel_pitch_mm};
  return frame;
}

Light light_of(const LensStations& stations, std::size_t k, const LensState& lens, const Frame& frame) {
  Light light;
  light.direction = direction_for_image_point(lens, frame.sensor_from_pixel(stations.pictures.lights_px[k]),
                                              lens.design_wavelength_nm);
  light.radius_rad = stations.source_radius_rad;
  light.spectrum = stations.spectrum;
  return light;
}

Result<std::vector<Patch>> ghost_patches(const LensStations& stations, std::size_t k, const LensState& lens,
                                         const Frame& frame, const std::vector<Ghost>& ghosts, const Context& context) {
  const Light light = light_of(stations, k, lens, frame);
  FrameSettings settings;
  settings.frame = frame;
  settings.colour_space = stations.space;
  LayerOptions options;
  options.by = LayersBy::Ghost;
  options.ghosts = ghosts;
  AdaptiveOptions method;
  method.error = kDrawingError;
  Result<LayeredFlare> flare = render_layers(method, lens, std::span(&light, 1), settings, options, context);
  if (!flare) return tl::unexpected(flare.error());
  std::vector<Patch> patches(ghosts.size() + 1);
  for (FlareLayer& layer : flare->layers) {
    const auto at = std::ranges::find_if(ghosts, [&](const Ghost& g) { return layer_name(g) == layer.name; });
    patches[static_cast<std::size_t>(at - ghosts.begin())] = {layer.left, layer.top, std::move(layer.image)};
  }
  return patches;
}

}  // namespace contrejour::inline internal
