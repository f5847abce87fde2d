// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/flicker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <limits>
#include <tuple>
#include <utility>

#include "contrejour/expert/metrics.h"
#include "contrejour/expert/settings.h"
#include "contrejour/expert/trace.h"
#include "contrejour/renderer.h"

namespace contrejour::cli {
namespace {

constexpr Vec2 kFirstLight_uv{0.70, 0.33};  // bodonyi2023's light
constexpr double kHeading_rad = 0.3;        // of the light's motion, along neither rows nor columns
constexpr double kLightRadius_rad = kSunRadius_rad;
constexpr double kDust_per_cm2 = 20.0;
constexpr double kUnlimited = std::numeric_limits<double>::infinity();
constexpr double kPeakQuantile = 0.999;  // of a frame's samples: the peak that errors are relative to

// The three last frames of one renderer.
class Film {
 public:
  void add(Image image) {
    images_.push_back(std::move(image));
    if (images_.size() > 3) images_.pop_front();
  }
  [[nodiscard]] bool is_full() const { return images_.size() == 3; }
  [[nodiscard]] std::size_t samples() const { return images_.front().pixels.size(); }
  // With samples clipped at a peak, as compare() clips them, or at infinity.
  [[nodiscard]] double second_difference(std::size_t k, double peak) const {
    const auto at = [&](std::size_t frame) { return std::clamp<double>(images_[frame].pixels[k], -peak, peak); };
    return at(2) - 2.0 * at(1) + at(0);
  }
  [[nodiscard]] double peak() const { return quantile_of_samples(images_[1], kPeakQuantile); }
  [[nodiscard]] std::array<double, 3> sum() const {
    std::array<double, 3> sum{};
    for (std::size_t k = 0; k < samples(); ++k) sum[k % 3] += images_[1].pixels[k];
    return sum;
  }

 private:
  std::deque<Image> images_;
};

double largest_ratio(const std::array<double, 3>& part, const std::array<double, 3>& whole) {
  double largest = 0.0;
  for (std::size_t c = 0; c < 3; ++c) largest = std::max(largest, std::abs(part[c] / whole[c]));
  return largest;
}

// Adds the second differences at one time to the figures. frame: the middle one of the three.
void add_time(int frame, const Film& rendered, const Film& fine, Flicker& flicker, double& squares_over_time) {
  double own = 0.0, exact = 0.0, between = 0.0, unclipped = 0.0, largest = 0.0;
  std::array<double, 3> flux{}, fine_flux{};
  const double peak = fine.peak(), count = static_cast<double>(rendered.samples());
  for (std::size_t k = 0; k < rendered.samples(); ++k) {
    const double a = rendered.second_difference(k, peak), b = fine.second_difference(k, peak);
    own += a * a;
    exact += b * b;
    between += (a - b) * (a - b);
    const double whole_a = rendered.second_difference(k, kUnlimited), whole_b = fine.second_difference(k, kUnlimited);
    unclipped += (whole_a - whole_b) * (whole_a - whole_b);
    largest = std::max(largest, std::abs(whole_a - whole_b));
    flux[k % 3] += whole_a;
    fine_flux[k % 3] += whole_b;
  }
  const auto rms = [&](double squares) { return std::sqrt(squares / count) / peak; };
  flicker.rendered = std::max(flicker.rendered, rms(own));
  flicker.fine = std::max(flicker.fine, rms(exact));
  if (rms(between) > flicker.difference) flicker.worst_frame = frame;
  flicker.difference = std::max(flicker.difference, rms(between));
  flicker.unclipped = std::max(flicker.unclipped, rms(unclipped));
  flicker.pixel_difference = std::max(flicker.pixel_difference, largest / peak);
  flicker.flux = std::max(flicker.flux, largest_ratio(flux, fine.sum()));
  flicker.fine_flux = std::max(flicker.fine_flux, largest_ratio(fine_flux, fine.sum()));
  squares_over_time += between / (count * peak * peak);
}

Result<LensState> lens_of(const PaperSystem& system, const FlickerCase& effects) {
  const auto prescription = find_lens(std::string(system.lens));
  if (!prescription) return tl::unexpected(prescription.error());
  LensSettings settings;
  settings.f_number = system.f_number;
  if (system.focal_length_mm > 0.0) settings.focal_length_mm = system.focal_length_mm;
  if (effects.dirt) settings.dirt.dust_per_cm2 = kDust_per_cm2;
  return configure_lens(*prescription, settings);
}

Result<Renderer> renderer_at(double error, const LensState& lens) {
  auto renderer = Renderer::create(AdaptiveOptions{error});
  if (!renderer) return renderer;
  if (const auto set = renderer->set_lens(lens); !set) return tl::unexpected(set.error());
  return renderer;
}

}  // namespace

std::span<const FlickerCase> flicker_cases() {
  static constexpr std::array kCases{FlickerCase{.name = "none"}, FlickerCase{.name = "ringing", .ringing = true},
                                     FlickerCase{.name = "size", .size = true},
                                     FlickerCase{.name = "dirt", .dirt = true},
                                     FlickerCase{.name = "all", .ringing = true, .size = true, .dirt = true}};
  return kCases;
}

Result<Flicker> measure_flicker(const PaperSystem& system, const FlickerCase& effects, const FlickerFrames& frames,
                                const params::Values& values, const Context& context) {
  const auto lens = lens_of(system, effects);
  if (!lens) return tl::unexpected(lens.error());
  const double error = params::adaptive_options(values).error;
  auto renderer = renderer_at(error, *lens), fine_renderer = renderer_at(kFineError, *lens);
  if (!renderer) return tl::unexpected(renderer.error());
  if (!fine_renderer) return tl::unexpected(fine_renderer.error());
  const Frame frame = params::whole_frame(values, *lens, *params::parse_size(*values.text("size")));
  FrameSettings settings = params::frame_settings(values, frame, ColourSpace::Rec709);
  if (effects.ringing) settings.ringing.mode = RingingMode::Fresnel;
  FrameSettings fine_settings = settings;
  fine_settings.area_error = kFineError;

  Flicker flicker{.system = std::string(system.name), .effects = effects.name, .frames = frames.count};
  Film rendered, fine;
  double squares = 0.0;
  for (int k = frames.first; k < frames.first + frames.count; ++k) {
    const Vec2 moved = Vec2{std::cos(kHeading_rad), std::sin(kHeading_rad)} * (kStep_px * k);
    const Vec2 at = Vec2{kFirstLight_uv.x * frame.width, kFirstLight_uv.y * frame.height} + moved;
    Light light;
    light.direction = direction_for_image_point(*lens, frame.sensor_from_pixel(at), lens->design_wavelength_nm);
    if (effects.size) light.radius_rad = kLightRadius_rad;
    for (auto [session, of, film] :
         {std::tuple(&*renderer, &settings, &rendered), std::tuple(&*fine_renderer, &fine_settings, &fine)}) {
      auto flare = session->render({&light, 1}, *of, context);
      if (!flare) return tl::unexpected(flare.error());
      film->add(std::move(flare->image));
    }
    if (rendered.is_full()) add_time(k - 1, rendered, fine, flicker, squares);
  }
  flicker.mean_difference = std::sqrt(squares / std::max(1, frames.count - 2));
  return flicker;
}

}  // namespace contrejour::cli
