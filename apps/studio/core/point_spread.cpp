// SPDX-License-Identifier: Apache-2.0
#include "studio/core/point_spread.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "contrejour/expert/ghost.h"
#include "contrejour/expert/lens_starburst.h"
#include "contrejour/expert/requests.h"
#include "contrejour/expert/source_renderer.h"

namespace contrejour::studio {
namespace {

constexpr double kDecades = 6.0;
constexpr double kFarthestImage_mm = 1e3;  // from the axis: pixels are counted in 32 bits
constexpr double kMillimetresPerNanometre = 1e-6, kMicrometresPerMillimetre = 1e3;
constexpr std::chrono::milliseconds kRestBeforeSpread{80};
constexpr int kSpreadThreads = 1;  // the picture comes first

std::uint32_t packed_rgb(std::uint32_t r, std::uint32_t g, std::uint32_t b) {
  return r | g << 8U | b << 16U | 0xFF000000U;
}

int pixels_over(double length_mm, double pitch_mm) {
  return std::max(kSpreadSide, static_cast<int>(std::ceil(length_mm / pitch_mm)));
}

// The mask's amplitude squared, scaled to its brightest; a mask may have more samples than the picture has pixels.
std::vector<std::uint32_t> picture_of_mask(const PupilMask& mask) {
  std::vector<std::uint32_t> codes(static_cast<std::size_t>(kPupilSide) * kPupilSide, packed_rgb(0, 0, 0));
  if (!mask.is_complete()) return codes;
  const float brightest = *std::max_element(mask.amplitude.begin(), mask.amplitude.end());
  if (!(brightest > 0)) return codes;
  for (int y = 0; y < kPupilSide; ++y)
    for (int x = 0; x < kPupilSide; ++x) {
      const auto sx = static_cast<std::size_t>(x * mask.grid.side / kPupilSide),
                 sy = static_cast<std::size_t>(y * mask.grid.side / kPupilSide);
      const float level = mask.amplitude[sy * static_cast<std::size_t>(mask.grid.side) + sx] / brightest;
      const auto code = static_cast<std::uint32_t>(std::lround(255 * std::clamp(level, 0.0F, 1.0F)));
      codes[static_cast<std::size_t>(y * kPupilSide + x)] = packed_rgb(code, code, code);
    }
  return codes;
}

Result<PointSpreadAnswer> answer_of(const PointSpreadOrder& order, const Context& context) {
  const auto request = picture_request(order.values, *order.lens);
  if (!request) return tl::unexpected(request.error());
  if (order.light >= request->lights.size()) return invalid_argument("the picture has no such light");
  const auto pupil = exit_pupil(*order.lens, request->lights[order.light].source(), order.lens->design_wavelength_nm,
                                2 * kPupilSide - 2, context);
  if (!pupil) return tl::unexpected(pupil.error());
  const auto spread = point_spread(order, context);
  if (!spread) return tl::unexpected(spread.error());
  const double width_um = kSpreadSide * spread_pitch_mm(*order.lens) * kMicrometresPerMillimetre;
  return PointSpreadAnswer{
      picture_of_mask(pupil->mask), logarithmic(*spread), pupil->open_fraction, pupil->radius, width_um, {}};
}

}  // namespace

double spread_pitch_mm(const LensState& lens) {
  return 0.5 * lens.design_wavelength_nm * kMillimetresPerNanometre * lens.f_number;
}

Result<Image> point_spread(const PointSpreadOrder& order, const Context& context) {
  auto request = picture_request(order.values, *order.lens);
  if (!request) return tl::unexpected(request.error());
  if (order.light >= request->lights.size()) return invalid_argument("the picture has no such light");
  Light light = request->lights[order.light];
  light.radius_rad = 0;
  light.shape = nullptr;
  FrameSettings settings = request->settings;
  settings.starburst.on = true;
  settings.ghosts = {};
  settings.ghosts.gain = 0;
  const auto ghosts = enumerate_ghosts(*order.lens, settings.scope);
  if (!ghosts.empty()) settings.selection = SelectList{{ghosts.front()}};
  settings.starburst.gain = 1;
  settings.glare = {};
  const Vec2 image_mm = chief_ray_image_point(*order.lens, light.source(), order.lens->design_wavelength_nm);
  if (!(std::hypot(image_mm.x, image_mm.y) < kFarthestImage_mm)) return invalid_argument("the light has no image");
  // A window about the image in a picture that has such pixels over the whole sensor.
  Frame& frame = settings.frame;
  frame = {};
  frame.width = frame.height = kSpreadSide;
  frame.pixel_pitch_mm = spread_pitch_mm(*order.lens);
  frame.full_width = pixels_over(order.lens->sensor_width_mm, frame.pixel_pitch_mm);
  frame.full_height = pixels_over(order.lens->sensor_height_mm, frame.pixel_pitch_mm);
  const Vec2 at = frame.pixel_from_sensor(image_mm);
  frame.origin_x = static_cast<int>(std::floor(at.x)) - kSpreadSide / 2;
  frame.origin_y = static_cast<int>(std::floor(at.y)) - kSpreadSide / 2;
  auto renderer = renderer_of(order.values, FlareSource(*order.lens));
  if (!renderer) return tl::unexpected(renderer.error());
  auto flare = render(*renderer, {&light, 1}, settings, context);
  if (!flare) return tl::unexpected(flare.error());
  return std::move(flare->image);
}

std::vector<std::uint32_t> logarithmic(const Image& rgb) {
  float brightest = 0;
  for (const float v : rgb.pixels) brightest = std::fmax(brightest, v);
  const auto code = [&](float v) {
    if (!(v > 0) || !(brightest > 0)) return 0U;
    const double part = 1 + std::log10(static_cast<double>(v / brightest)) / kDecades;
    return static_cast<std::uint32_t>(std::lround(255 * std::clamp(part, 0.0, 1.0)));
  };
  std::vector<std::uint32_t> codes;
  codes.reserve(rgb.pixels.size() / 3);
  for (std::size_t k = 0; k + 2 < rgb.pixels.size(); k += 3)
    codes.push_back(packed_rgb(code(rgb.pixels[k]), code(rgb.pixels[k + 1]), code(rgb.pixels[k + 2])));
  return codes;
}

PointSpreadJob::Work point_spread_work() {
  return [](const PointSpreadOrder& order, PointSpreadJob::Control& control) {
    if (!control.rests_for(kRestBeforeSpread)) return;
    auto answer = answer_of(order, control.context(kSpreadThreads));
    if (control.is_outdated()) return;
    if (!answer) answer = PointSpreadAnswer{{}, {}, 0, 0, 0, answer.error().to_string()};
    control.publish(std::move(*answer));
  };
}

}  // namespace contrejour::studio
