#include "cli/ghost_figures.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <thread>

#include "contrejour/first_order.h"

namespace contrejour::cli {
namespace {

// Flux of the direct image in each band. A light outside the frame, or one whose light does not get through, is
// measured where a renderer measures it (ARCHITECTURE, Radiometry).
std::vector<double> direct_fluxes(const LensState& lens, const FiguresRequest& request) {
  const Frame& frame = request.frame;
  const double lambda_nm = lens.design_wavelength_nm;
  Vec3 direction = normalized(request.light.direction);
  const Vec2 uv = frame.uv_from_sensor(landing_of(lens, direction, lambda_nm));
  const double outside = 2.0 * std::max(std::abs(uv.x - 0.5), std::abs(uv.y - 0.5));
  if (outside > 1.0) {
    const Vec2 edge = Vec2{0.5, 0.5} + (uv - Vec2{0.5, 0.5}) * (1.0 / outside);
    direction = direction_to_land_at(lens, frame.sensor_from_uv(edge), lambda_nm);
  }
  if (direct_flux(lens, direction, lambda_nm) <= 0.0) direction = {0.0, 0.0, 1.0};
  std::vector<double> fluxes;
  for (const SpectralBand& band : request.bands) fluxes.push_back(direct_flux(lens, direction, band.lambda_nm));
  return fluxes;
}

// A parallel bundle at height y leaves at the sensor with height a y and slope c y: it meets the axis -a / c on.
std::optional<double> paraxial_focus_mm(const LensState& lens, Ghost ghost) {
  const Abcd m = abcd_ghost(lens, ghost.i, ghost.j, lens.design_wavelength_nm);
  const double focus = -m.a / m.c;
  return std::isfinite(focus) ? std::optional<double>(focus) : std::nullopt;
}

struct Footprint {
  Vec2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Vec2 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

  void add(Vec2 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
};

GhostFigures figures_of(const LensState& lens, Ghost ghost, const FiguresRequest& request,
                        const std::vector<double>& direct) {
  GhostFigures figures;
  figures.ghost = ghost;
  figures.paraxial_focus_mm = paraxial_focus_mm(lens, ghost);
  Rgb flux{}, whole{};
  Vec2 centroid_mm;
  double weight_sum = 0.0;
  Footprint footprint;
  for (std::size_t k = 0; k < request.bands.size(); ++k) {
    const SpectralBand& band = request.bands[k];
    const GhostMeasure m = measure_ghost(lens, ghost, normalized(request.light.direction), band.lambda_nm);
    for (std::size_t c = 0; c < flux.size(); ++c) {
      flux[c] += band.weight[c] * m.flux_mm2;
      whole[c] += band.weight[c] * direct[k];
    }
    if (m.flux_mm2 <= 0.0) continue;
    const double brightness = luminance(band.weight, ColourSpace::Rec709);
    figures.peak_irradiance += brightness * m.peak_per_mm2;
    centroid_mm = centroid_mm + m.centroid_mm * (brightness * m.flux_mm2);
    weight_sum += brightness * m.flux_mm2;
    footprint.add(request.frame.pixel_from_sensor(m.min_mm));
    footprint.add(request.frame.pixel_from_sensor(m.max_mm));
  }
  for (std::size_t c = 0; c < flux.size(); ++c) figures.rgb[c] = whole[c] != 0.0 ? flux[c] / whole[c] : 0.0;
  figures.relative_flux = luminance(figures.rgb, ColourSpace::Rec709);
  if (weight_sum > 0.0) {
    figures.centroid_px = request.frame.pixel_from_sensor(centroid_mm * (1.0 / weight_sum));
    figures.size_px = footprint.high - footprint.low;
  }
  return figures;
}

// Each ghost by itself, so that the result does not depend on the threads.
class Workers {
 public:
  Workers(std::size_t count, const Context& context) : count_(count), context_(context) {}

  template <class Work>
  bool run(const Work& work) {
    const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
    const unsigned threads = context_.threads > 0 ? static_cast<unsigned>(context_.threads) : cores;
    std::vector<std::thread> others;
    for (unsigned t = 1; t < std::min<std::size_t>(threads, count_); ++t) others.emplace_back([&] { take(work); });
    take(work);
    for (std::thread& other : others) other.join();
    return !context_.cancelled();
  }

 private:
  template <class Work>
  void take(const Work& work) {
    for (std::size_t k = next_++; k < count_ && !context_.cancelled(); k = next_++) {
      work(k);
      const std::lock_guard lock(progress_);
      ++done_;
      if (context_.progress) context_.progress(static_cast<double>(done_) / static_cast<double>(count_));
    }
  }

  std::size_t count_;
  const Context& context_;
  std::atomic<std::size_t> next_{0};
  std::mutex progress_;
  std::size_t done_ = 0;
};

}  // namespace

Result<std::vector<GhostFigures>> ghost_figures(const LensState& lens, const FiguresRequest& request,
                                                const Context& context) {
  const std::vector<Ghost> ghosts = enumerate_ghosts(lens, request.scope);
  const std::vector<double> direct = direct_fluxes(lens, request);
  std::vector<GhostFigures> all(ghosts.size());
  const bool done = Workers(ghosts.size(), context).run([&](std::size_t g) {
    all[g] = figures_of(lens, ghosts[g], request, direct);
  });
  if (!done) return failure(ErrorCode::Cancelled, "interrupted");
  std::stable_sort(all.begin(), all.end(), [](const GhostFigures& a, const GhostFigures& b) {
    return a.relative_flux > b.relative_flux;
  });
  return all;
}

}  // namespace contrejour::cli
