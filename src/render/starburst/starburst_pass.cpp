// SPDX-License-Identifier: Apache-2.0
#include "render/starburst/starburst_pass.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/tasks.h"
#include "contrejour/expert/check_lens.h"
#include "contrejour/expert/lens_starburst.h"
#include "diffraction/starburst_core.h"
#include "diffraction/starburst_rings.h"
#include "render/planning/statistics.h"
#include "render/radiometry/direct_light.h"
#include "render/starburst/area_spread.h"
#include "render/starburst/glare.h"
#include "render/starburst/kept_starbursts.h"
#include "render/starburst/lens_pattern.h"
#include "render/starburst/light_groups.h"

namespace contrejour::inline internal {
namespace {

constexpr int kBands = 120;  // every 3.3 nm; hullin2011 3.3 finds 5 nm fine enough
constexpr std::size_t kWorthLayingOut = 3;  // lights, from which on the starburst is laid out once
constexpr double kMaxLaidOut = 8388608.0;  // pixels of a frame: 200 MB
constexpr double kFarthest_diagonals = 4.0;  // lights farther from the frame's middle draw no starburst
constexpr int kSamplesForDirt = 128;  // across a pupil that serves only to find the transmittance of dirt

// The image that a light's own image is added to.
using ImageOfLight = std::function<Image&(std::size_t light)>;

struct LightImageTargets {
  ImageOfLight starburst, glare;
  bool has_placed = false;  // LightImageRequest
};

Error invalid(std::string message) { return {ErrorCode::InvalidArgument, std::move(message), {}}; }

double distance_to_farthest_corner(const Frame& frame, Vec2 from_px) {
  return length(Vec2{std::max(std::abs(from_px.x), std::abs(frame.width - from_px.x)),
                     std::max(std::abs(from_px.y), std::abs(frame.height - from_px.y))});
}

// The fraction of a light outside the frame that gets through, relative to the light where its flux is measured
// (docs/physics/radiometry.md).
double fraction_outside(const GhostMeter& meter, const LensState& lens, const Frame& frame, const LightSource& light) {
  const double flux_mm2 = meter.direct_flux(light);
  if (!(flux_mm2 > 0.0)) return 0.0;
  const double measured_mm2 = meter.direct_flux(measured_source(lens, frame, light));
  const LightSource on_axis({0.0, 0.0, 1.0}, light.distance_mm);
  return flux_mm2 / (measured_mm2 > 0.0 ? measured_mm2 : meter.direct_flux(on_axis));
}

bool is_outside(const Frame& frame, Vec2 sensor_mm) {
  const Vec2 uv = frame.uv_from_sensor(sensor_mm);
  return std::max(std::abs(uv.x - 0.5), std::abs(uv.y - 0.5)) > 0.5;
}

// The position of each light's image, and the flux of its starburst. Lights without any are left out.
std::vector<ImagedLight> image_lights(const FrameRequest& request, const Context& context) {
  const auto& [lens, lights, settings, cache, layers] = request;
  const Frame& frame = settings.frame;
  const double farthest_px = kFarthest_diagonals * std::hypot(frame.full_width, frame.full_height);
  const Vec2 middle_px = frame.pixel_from_sensor({});
  std::vector<Vec2> sensor_mm(lights.size());
  parallel_for(lights.size(), context, [&](std::size_t k) {
    sensor_mm[k] = chief_ray_image_point(lens, lights[k].source(), lens.design_wavelength_nm);
  });
  std::optional<GhostMeter> meter;
  if (std::any_of(sensor_mm.begin(), sensor_mm.end(), [&](Vec2 p) { return is_outside(frame, p); }))
    meter.emplace(lens, lens.design_wavelength_nm);
  std::vector<double> fraction(lights.size(), 1.0);
  parallel_for(lights.size(), context, [&](std::size_t k) {
    const double from_middle_px = length(frame.pixel_from_sensor(sensor_mm[k]) - middle_px);
    if (!(from_middle_px < farthest_px))
      fraction[k] = 0.0;
    else if (is_outside(frame, sensor_mm[k]))
      fraction[k] = fraction_outside(*meter, lens, frame, lights[k].source());
  });
  std::vector<ImagedLight> imaged;
  for (std::size_t k = 0; k < lights.size(); ++k) {
    ImagedLight light{k, frame.pixel_from_sensor(sensor_mm[k]), lights[k].value};
    for (double& value : light.flux) value *= fraction[k];
    if (light.flux != Rgb{}) imaged.push_back(light);
  }
  return imaged;
}

std::vector<SpectralBand> bands_of(const Light& light, const FrameSettings& settings) {
  if (settings.lambda_nm.empty()) return spectral_bands(kBands, light.spectrum, settings.colour_space);
  std::vector<SpectralBand> bands;
  for (const double lambda_nm : settings.lambda_nm) bands.push_back({lambda_nm, {1.0, 1.0, 1.0}});
  return bands;
}

// The starburst of the brightest light of a group that gets through.
Result<Starburst> starburst_of(const LightGroup& group, const FrameRequest& frame, KeptStarbursts& kept,
                               const Context& context) {
  const auto& [lens, lights, settings, cache, layers] = frame;
  const std::vector<SpectralBand> bands = bands_of(lights[group.front().light], settings);
  LensStarburstSettings drawn{settings.frame.pixel_pitch_mm, 1.0};
  for (const ImagedLight& light : group)
    drawn.radius_px = std::max(drawn.radius_px, 1.0 + distance_to_farthest_corner(settings.frame, light.centre_px));
  for (const ImagedLight& light : group) {
    const LightSource source(lights[light.light].direction, lights[light.light].distance_mm);
    auto starburst =
        kept.get({source, bands, drawn}, [&] { return lens_starburst(lens, source, bands, drawn, context); });
    if (!starburst || starburst->rings() != nullptr) return starburst;
  }
  return Starburst();
}

// With many lights it is faster to lay the starburst out once.
Result<void> draw_group(const ImageOfLight& image_of, const LightGroup& group, const Starburst& starburst,
                        const Frame& frame, const Context& context) {
  StarburstImage starburst_image;
  const bool lays_out =
      group.size() >= kWorthLayingOut && static_cast<double>(frame.width) * frame.height <= kMaxLaidOut;
  if (lays_out) {
    const auto laid = lay_out(starburst, frame.width, frame.height, context);
    if (!laid) return tl::unexpected(laid.error());
    starburst_image = *laid;
  }
  for (const ImagedLight& light : group) {
    Image& image = image_of(light.light);
    if (lays_out)
      add_starburst(image, starburst_image, light.centre_px, light.flux, context);
    else
      add_starburst(image, starburst, light.centre_px, light.flux, context);
    if (context.cancelled()) return interrupted();
  }
  return {};
}

Result<void> draw_groups(const ImageOfLight& image_of, const std::vector<LightGroup>& groups, const FrameRequest& frame,
                         KeptStarbursts& kept, const Context& context) {
  Context quiet = context;
  quiet.progress = {};
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto starburst = starburst_of(groups[g], frame, kept, quiet);
    if (!starburst) return tl::unexpected(starburst.error());
    const auto drawn = draw_group(image_of, groups[g], *starburst, frame.settings.frame, quiet);
    if (!drawn) return drawn;
    if (context.progress) context.progress(static_cast<double>(g + 1) / static_cast<double>(groups.size()));
  }
  return {};
}

// Lights that are points, and extended lights.
struct SortedLights {
  std::vector<ImagedLight> points, areas;
};

SortedLights sorted_by_size(const std::vector<ImagedLight>& imaged, std::span<const Light> lights) {
  SortedLights sorted;
  for (const ImagedLight& light : imaged)
    (lights[light.light].is_point() ? sorted.points : sorted.areas).push_back(light);
  return sorted;
}

void multiply_flux(std::vector<ImagedLight>& lights, double factor) {
  for (ImagedLight& light : lights)
    for (double& value : light.flux) value *= factor;
}

// Lights that go into one image, in their order.
struct LightsOfImage {
  Image* image;
  std::vector<ImagedLight> lights;
};

std::vector<LightsOfImage> by_image(const std::vector<ImagedLight>& imaged, const ImageOfLight& image_of) {
  std::vector<LightsOfImage> all;
  for (const ImagedLight& light : imaged) {
    Image* const image = &image_of(light.light);
    const auto found = std::ranges::find(all, image, &LightsOfImage::image);
    (found != all.end() ? *found : all.emplace_back(LightsOfImage{image, {}})).lights.push_back(light);
  }
  return all;
}

Result<void> spread_areas(const ImageOfLight& image_of, const std::vector<ImagedLight>& areas, const LensState& lens,
                          std::span<const Light> lights, const Frame& frame, const AddPointSpread& add_point,
                          const Context& context) {
  for (const LightsOfImage& some : by_image(areas, image_of))
    if (auto ok = add_area_spread(*some.image, some.lights, areas.size(), lens, lights, frame, add_point, context); !ok)
      return ok;
  return {};
}

// The flux that glare scatters is taken from the light's own image, so that both together sum to its value.
double starburst_gain(const FrameSettings& settings) {
  return settings.starburst.gain * (1.0 - settings.glare.fraction);
}

Result<void> draw_starbursts(const ImageOfLight& image_of, SortedLights imaged, const FrameRequest& frame,
                             const Context& context) {
  const auto& [lens, lights, settings, cache, layers] = frame;
  const auto kept = cache.section<KeptStarbursts>(KeptStarbursts::key_of(lens));
  multiply_flux(imaged.points, starburst_gain(settings));
  multiply_flux(imaged.areas, starburst_gain(settings));
  const auto groups = group_lights(lights, imaged.points, settings.frame);
  if (auto drawn = draw_groups(image_of, groups, frame, *kept, context); !drawn) return drawn;
  Context quiet = context;
  quiet.progress = {};
  // The callback is called repeatedly for one light, with pixels of several pitches: its pattern is kept.
  std::optional<std::size_t> known;
  StarburstSource source;
  const auto add_point = [&](Image& part, std::size_t light, const PointSpread& spread, Vec2 centre_px,
                             const Rgb& flux) -> Result<void> {
    const std::vector<SpectralBand> bands = bands_of(lights[light], settings);
    const LensStarburstSettings drawn{spread.pixel_pitch_mm, spread.radius_px};
    const auto make = [&]() -> Result<Starburst> {
      if (known != light) {
        auto made = lens_pattern(lens, lights[light].source(), bands, drawn, quiet);
        if (!made) return tl::unexpected(made.error());
        source = *std::move(made);
        known = light;
      }
      return source.at(spread.pixel_pitch_mm, spread.radius_px, quiet);
    };
    const auto starburst = kept->get({lights[light].source(), bands, drawn}, make);
    if (!starburst) return tl::unexpected(starburst.error());
    add_starburst(part, *starburst, centre_px, flux, quiet);
    return {};
  };
  return spread_areas(image_of, imaged.areas, lens, lights, settings.frame, add_point, quiet);
}

// Removes the light that dirt blocks, which is not scattered.
Result<void> take_dirt_off(std::vector<ImagedLight>& imaged, const LensState& lens, std::span<const Light> lights,
                           const Frame& frame, const Context& context) {
  std::vector<ImagedLight> left;
  for (LightGroup& group : group_lights(lights, imaged, frame)) {
    const auto pupil =
        exit_pupil(lens, lights[group.front().light].source(), lens.design_wavelength_nm, kSamplesForDirt, context);
    if (!pupil) return tl::unexpected(pupil.error());
    multiply_flux(group, pupil->open_fraction);
    left.insert(left.end(), group.begin(), group.end());
  }
  imaged = std::move(left);
  return {};
}

Result<void> draw_glare(const ImageOfLight& image_of, std::vector<ImagedLight> imaged, const FrameRequest& frame,
                        const Context& context) {
  const auto& [lens, lights, settings, cache, layers] = frame;
  if (lens.dirt.any())
    if (auto ok = take_dirt_off(imaged, lens, lights, settings.frame, context); !ok) return ok;
  multiply_flux(imaged, settings.glare.fraction);
  const double r0_mm = std::abs(lens.focal_length_mm) * std::tan(settings.glare.width_rad);
  const SortedLights sorted = sorted_by_size(imaged, lights);
  for (const LightsOfImage& some : by_image(sorted.points, image_of))
    add_glare(*some.image, some.lights, r0_mm / settings.frame.pixel_pitch_mm, context);
  const auto add_point = [&](Image& part, std::size_t light, const PointSpread& spread, Vec2 centre_px,
                             const Rgb& flux) -> Result<void> {
    const ImagedLight point{light, centre_px, flux};
    add_glare(part, {&point, 1}, r0_mm / spread.pixel_pitch_mm, context);
    return {};
  };
  return spread_areas(image_of, sorted.areas, lens, lights, settings.frame, add_point, context);
}

void remove_part(Image& image, const Image& left_out, const Context& context) {
  if (image.pixels.empty()) return;
  parallel_for(static_cast<std::size_t>(image.height), context, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < image.channels; ++c) image.at(x, y, c) *= 1.0F - left_out.at(x, y);
  });
}

void add_to(Image& image, const Image& other, const Context& context) {
  parallel_for(static_cast<std::size_t>(image.height), context, [&](std::size_t row) {
    const auto to = image.row(static_cast<int>(row));
    const auto from = other.row(static_cast<int>(row));
    for (std::size_t k = 0; k < to.size(); ++k) to[k] += from[k];
  });
}

Result<void> check_left_out(const Image& left_out, const Frame& frame) {
  if (left_out.width != frame.width || left_out.height != frame.height || left_out.channels != 1 ||
      left_out.pixels.size() != left_out.index(0, left_out.height))
    return tl::unexpected(invalid(fmt::format(
        "what a starburst leaves out must be one channel of {} x {} pixels, as the frame", frame.width, frame.height)));
  const bool in_range = std::all_of(left_out.pixels.begin(), left_out.pixels.end(),
                                    [](float fraction) { return fraction >= 0.0F && fraction <= 1.0F; });
  if (!in_range) return tl::unexpected(invalid("what a starburst leaves out of a pixel must be a share from 0 to 1"));
  return {};
}

Result<void> check_imaged(std::span<const Light> lights, const FrameSettings& settings) {
  const double gain = settings.starburst.gain;
  for (std::size_t k = 0; k < lights.size(); ++k) {
    if (auto good = check_light(lights[k], settings.colour_space); !good)
      return tl::unexpected(invalid(fmt::format("imaged light {}: {}", k + 1, good.error().message)));
    const Rgb& value = lights[k].value;
    const double largest = std::max({std::abs(value[0]), std::abs(value[1]), std::abs(value[2])});
    if (!(largest * gain <= kMaxLightValue))
      return tl::unexpected(invalid(
          fmt::format("imaged light {}: its value of {:.4g} times the starburst's gain, {:.4g}, is beyond {:.0e}",
                      k + 1, largest, gain, kMaxLightValue)));
  }
  return {};
}

// Adds starbursts and glare to images, with the times by phase.
Result<void> draw_into(const LightImageTargets& targets, RenderStatistics& statistics, const FrameRequest& frame,
                       const Context& context) {
  Clock::time_point start = Clock::now();
  Context quiet = context;
  quiet.progress = {};
  const auto imaged = image_lights(frame, quiet);
  if (frame.settings.starburst.on && !context.cancelled()) {
    SortedLights sorted = sorted_by_size(imaged, frame.lights);
    if (targets.has_placed) sorted.points.clear();
    auto drawn = draw_starbursts(targets.starburst, std::move(sorted), frame, context);
    if (!drawn) return drawn;
    count_last(statistics, "starburst", ms_since(start));
    start = Clock::now();
  }
  if (frame.settings.glare.fraction > 0.0 && !context.cancelled()) {
    if (auto drawn = draw_glare(targets.glare, imaged, frame, quiet); !drawn) return drawn;
    count_last(statistics, "glare", ms_since(start));
  }
  if (context.cancelled()) return interrupted();
  return {};
}

}  // namespace

Result<void> check_light_images(std::span<const Light> lights, const FrameSettings& settings) {
  const StarburstOptions& starburst = settings.starburst;
  const GlareOptions& glare = settings.glare;
  if (!(starburst.gain >= 0.0) || !std::isfinite(starburst.gain))
    return tl::unexpected(invalid(fmt::format("a starburst's gain must be 0 or more, not {}", starburst.gain)));
  if (!(glare.fraction >= 0.0 && glare.fraction <= 1.0))
    return tl::unexpected(invalid(fmt::format("glare is a share of the light from 0 to 1, not {}", glare.fraction)));
  if (!(glare.width_rad > 0.0 && glare.width_rad < 0.5 * std::numbers::pi))
    return tl::unexpected(invalid(fmt::format("glare cannot be {} radians wide", glare.width_rad)));
  if (auto usable = check_imaged(starburst.lights ? std::span<const Light>(*starburst.lights) : lights, settings);
      !usable)
    return usable;
  for (const double lambda_nm : settings.lambda_nm)
    if (!is_wavelength(lambda_nm))
      return tl::unexpected(invalid(fmt::format("no light has a wavelength of {} nm", lambda_nm)));
  return starburst.left_out ? check_left_out(*starburst.left_out, settings.frame) : Result<void>();
}

Result<std::vector<PlacedStarburst>> place_starbursts(const FrameRequest& frame, const Context& context) {
  Context quiet = context;
  quiet.progress = {};
  std::vector<ImagedLight> points = sorted_by_size(image_lights(frame, quiet), frame.lights).points;
  std::vector<PlacedStarburst> placed;
  if (points.size() > kMostPlacedStarbursts) return placed;
  multiply_flux(points, starburst_gain(frame.settings));
  const auto kept = frame.cache.section<KeptStarbursts>(KeptStarbursts::key_of(frame.lens));
  std::size_t bytes = 0;
  for (const LightGroup& group : group_lights(frame.lights, points, frame.settings.frame)) {
    const auto pattern = starburst_of(group, frame, *kept, quiet);
    if (!pattern) return tl::unexpected(pattern.error());
    if (context.cancelled()) return interrupted();
    if (pattern->rings() == nullptr) continue;
    bytes += pattern->rings()->bytes();
    if (bytes > KeptStarbursts::kMostBytes) return std::vector<PlacedStarburst>();
    for (const ImagedLight& light : group)
      if (is_drawable(light.centre_px)) placed.push_back({*pattern, light.centre_px, light.flux});
  }
  return placed;
}

Result<void> add_light_images(Image& image, RenderStatistics& statistics, const LightImageRequest& request,
                              const Context& context) {
  const FrameRequest& frame = request.frame;
  const FrameSettings& settings = frame.settings;
  const Image* const left_out = settings.starburst.left_out.get();
  Image apart;
  if (left_out != nullptr) apart = Image(settings.frame.width, settings.frame.height);
  Image& drawn_into = left_out != nullptr ? apart : image;
  const ImageOfLight same = [&](std::size_t) -> Image& { return drawn_into; };
  auto drawn = draw_into({same, same, request.has_placed}, statistics, frame, context);
  if (!drawn || left_out == nullptr) return drawn;
  Context quiet = context;
  quiet.progress = {};
  remove_part(apart, *left_out, quiet);
  add_to(image, apart, quiet);
  return {};
}

Result<LightImages> draw_light_images(RenderStatistics& statistics, const FrameRequest& frame,
                                      std::span<const std::size_t> layer_of_light, const Context& context) {
  const FrameSettings& settings = frame.settings;
  const bool is_by_light = !layer_of_light.empty();
  const std::size_t count = is_by_light ? *std::ranges::max_element(layer_of_light) + 1 : 1;
  LightImages images{std::vector<Image>(count), std::vector<Image>(is_by_light ? 0 : 1)};
  const auto target = [&](std::vector<Image>& layers) -> ImageOfLight {
    return [&, of = &layers](std::size_t light) -> Image& {
      Image& image = (*of)[is_by_light ? layer_of_light[light] : 0];
      if (image.pixels.empty()) image = Image(settings.frame.width, settings.frame.height);
      return image;
    };
  };
  const LightImageTargets targets{target(images.starburst), target(is_by_light ? images.starburst : images.glare)};
  if (auto drawn = draw_into(targets, statistics, frame, context); !drawn) return tl::unexpected(drawn.error());
  Context quiet = context;
  quiet.progress = {};
  if (const Image* const left_out = settings.starburst.left_out.get())
    for (std::vector<Image>* const layers : {&images.starburst, &images.glare})
      for (Image& image : *layers) remove_part(image, *left_out, quiet);
  return images;
}

}  // namespace contrejour::inline internal
