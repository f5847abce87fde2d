// SPDX-License-Identifier: Apache-2.0
#include "flare_fit_cache.h"

#include <cmath>
#include <fstream>
#include <random>
#include <span>
#include <string>

#include "contrejour/light.h"
#include "contrejour/render.h"

namespace contrejour {
namespace {

namespace fs = std::filesystem;

constexpr double kPartOfField = 0.95;  // of the largest angle at which the light is in the picture
constexpr double kRadians = 0.017453292519943295;

// Another program that shares the folder sees a whole file or none.
void write_numbers(const fs::path& file, std::span<const float> numbers) {
  const fs::path whole = file.string() + "." + std::to_string(std::random_device{}());
  {
    std::ofstream out(whole, std::ios::binary);
    out.write(reinterpret_cast<const char*>(numbers.data()), static_cast<std::streamsize>(numbers.size_bytes()));
  }
  std::error_code error;
  fs::rename(whole, file, error);
}

// Fills the numbers from a file; false if it does not hold exactly as many.
bool read_numbers(const fs::path& file, std::span<float> numbers) {
  std::error_code error;
  if (fs::file_size(file, error) != numbers.size_bytes() || error) return false;
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(numbers.data()), static_cast<std::streamsize>(numbers.size_bytes()));
  return in.good();
}

// A station as one list: rate, variance, valid, and the light's position and flux (no flux: no light).
Pixels numbers_of(const CapturedImage& picture, const std::optional<DirectFlux>& direct) {
  Pixels all;
  for (const Image* image : {&picture.rate, &picture.variance, &picture.valid})
    all.insert(all.end(), image->pixels.begin(), image->pixels.end());
  const DirectFlux light = direct.value_or(DirectFlux{});
  for (const double v : {light.position_px.x, light.position_px.y, light.rate[0], light.rate[1], light.rate[2]})
    all.push_back(static_cast<float>(v));
  return all;
}

void unpack(const Pixels& numbers, CapturedImage& picture, std::optional<DirectFlux>& direct) {
  auto at = numbers.begin();
  for (Image* image : {&picture.rate, &picture.variance, &picture.valid}) {
    const auto end = at + static_cast<std::ptrdiff_t>(image->pixels.size());
    std::copy(at, end, image->pixels.begin());
    at = end;
  }
  const auto next = [&] { return static_cast<double>(*at++); };
  DirectFlux light;
  light.position_px.x = next();
  light.position_px.y = next();
  for (double& rate : light.rate) rate = next();
  if (light.rate[1] > 0.0) direct = light;
}

// Simulates a station, or reads it.
Result<void> add_station(const LensState& lens, const fs::path& folder, std::size_t k, SimulatedCapture& capture) {
  const fs::path file = folder / ("station-" + std::to_string(k));
  const int width = capture.settings.width / 2, height = capture.settings.height / 2;
  CapturedImage picture{Image(width, height), Image(width, height), Image(width, height), {}, BayerPattern::Rggb};
  std::optional<DirectFlux> direct;
  Pixels numbers(numbers_of(picture, direct).size());
  if (!folder.empty() && read_numbers(file, numbers)) {
    unpack(numbers, picture, direct);
  } else {
    if (!(capture.settings.light_rate > 0.0)) {
      const Result<double> light = automatic_light_rate(lens, capture.settings);
      if (!light) return tl::unexpected(light.error());
      capture.settings.light_rate = *light;
    }
    const Result<SweepStation> station = simulate_station(lens, capture.settings, k);
    if (!station) return tl::unexpected(station.error());
    Result<CapturedImage> merged = merge_exposures(station->exposures, station->background);
    if (!merged) return tl::unexpected(merged.error());
    picture = std::move(*merged);
    if (const auto flux = direct_flux(station->direct)) direct = *flux;
    if (!folder.empty()) write_numbers(file, numbers_of(picture, direct));
  }
  if (direct) capture.lights.push_back({capture.settings.angles_deg[k] * kRadians, direct->position_px});
  capture.direct.push_back(direct);
  capture.pictures.push_back(std::move(picture));
  return {};
}

}  // namespace

Result<SimulatedCapture> simulated_capture(const LensState& lens, int stations, int raw_width, const fs::path& folder) {
  SimulatedCapture capture;
  SweepSettings& s = capture.settings;
  s.width = raw_width;
  s.height = 2 * static_cast<int>(0.5 * raw_width * lens.sensor_height_mm / lens.sensor_width_mm);
  s.angles_deg = even_angles_deg(kPartOfField * largest_angle_deg(lens), stations);
  Pixels light(1);
  if (!folder.empty()) {
    fs::create_directories(folder);
    if (read_numbers(folder / "light", light)) s.light_rate = static_cast<double>(light[0]);
  }
  for (std::size_t k = 0; k < s.angles_deg.size(); ++k) {
    if (Result<void> ok = add_station(lens, folder, k, capture); !ok) return tl::unexpected(ok.error());
    light[0] = static_cast<float>(s.light_rate);
    if (k == 0 && !folder.empty()) write_numbers(folder / "light", light);
  }
  return capture;
}

std::vector<DrawnGhost> drawn_ghosts(const LensState& lens, const Frame& frame, double s, const fs::path& folder) {
  Light light;
  light.direction = direction_from_angles(std::atan(s), 0.0);
  light.radius_rad = SweepSettings{}.source_radius_rad;
  FrameSettings settings;
  settings.frame = frame;
  settings.starburst.on = false;
  settings.glare.fraction = 0.0;
  if (!folder.empty()) fs::create_directories(folder);
  std::vector<DrawnGhost> ghosts;
  for (const Ghost& ghost : enumerate_ghosts(lens, GhostScope::All)) {
    const fs::path file = folder / ("ghost-" + std::to_string(ghost.i) + "-" + std::to_string(ghost.j));
    Image picture(frame.width, frame.height);
    if (folder.empty() || !read_numbers(file, picture.pixels)) {
      settings.selection = SelectList{{ghost}};
      Result<Flare> flare = render(AdaptiveOptions{}, lens, std::span(&light, 1), settings);
      if (!flare) continue;
      picture = std::move(flare->image);
      if (!folder.empty()) write_numbers(file, picture.pixels);
    }
    ghosts.push_back({ghost, std::move(picture)});
  }
  return ghosts;
}

}  // namespace contrejour
