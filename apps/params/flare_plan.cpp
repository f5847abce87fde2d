#include "params/flare_plan.h"

#include <cmath>
#include <utility>

#include "contrejour/spectrum_file.h"
#include "contrejour/trace.h"
#include "params/settings.h"

namespace contrejour::params {
namespace {

Result<Frame> frame_of(const Picture& picture, const LensState& lens, const Values& values) {
  const PixelWindow& whole = picture.display_window;
  if (whole.width < 1 || whole.height < 1) {
    return failure(ErrorCode::Unsupported, "the display window has no pixels; nothing says where the axis is");
  }
  if (static_cast<double>(whole.width) * whole.height > kMaxPixels) {
    return failure(ErrorCode::Unsupported, "the display window is larger than 2^28 pixels");
  }
  Frame frame = whole_frame(values, lens, {whole.width, whole.height});
  frame.width = picture.data_window.width;
  frame.height = picture.data_window.height;
  frame.origin_x = picture.data_window.x - whole.x;
  frame.origin_y = picture.data_window.y - whole.y;
  return frame;
}

Light light_of(const DetectedLight& area, const Spectrum& spectrum, const Frame& frame, const LensState& lens,
               const Values& values) {
  const double gain = values.number("gain");
  Light light;
  light.distance_mm = *parse_distance_mm(*values.text("light-distance"));
  light.direction = direction_to_land_at(lens, frame.sensor_from_pixel(area.centroid_px), lens.design_wavelength_nm,
                                         light.distance_mm);
  light.value = {area.flux[0] * gain, area.flux[1] * gain, area.flux[2] * gain};
  light.spectrum = spectrum;
  return light;
}

}  // namespace

Result<FlarePlan> plan_flare(const Picture& picture, const LensState& lens, const Values& values) {
  FlarePlan plan;
  const auto named = colour_space_of(picture);
  plan.space_is_guessed = !named && !values.given("colour-space");
  plan.space = colour_space(values, named.value_or(ColourSpace::Rec709));
  auto frame = frame_of(picture, lens, values);
  if (!frame) return tl::unexpected(frame.error());
  plan.frame = *frame;
  const auto spectrum = find_spectrum(*values.text("spectrum"));
  if (!spectrum) return tl::unexpected(spectrum.error());
  const DetectionSettings detection = detection_settings(values);
  auto found = detect_lights(picture.rgb, detection);
  if (!found) return tl::unexpected(found.error());
  plan.found = std::move(*found);
  if (values.is_on("starburst") || values.number("glare") > 0.0)
    plan.already_there =
        std::make_shared<const Image>(light_shares(picture.rgb, plan.found.threshold, detection.softness));
  for (const DetectedLight& area : plan.found.lights) {
    plan.lights.push_back(light_of(area, *spectrum, plan.frame, lens, values));
  }
  return plan;
}

void add_flare(Image& rgb, const Image& flare) {
  for (std::size_t k = 0; k < rgb.pixels.size(); ++k) {
    if (std::isfinite(rgb.pixels[k]) && flare.pixels[k] != 0.0F) rgb.pixels[k] += flare.pixels[k];
  }
}

}  // namespace contrejour::params
