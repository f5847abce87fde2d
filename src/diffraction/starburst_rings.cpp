// Rings of a starburst: hullin2011 3.3, one power spectrum scaled by wavelength.
#include "diffraction/starburst_rings.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <memory>
#include <numbers>

#include "base/tasks.h"
#include "base/units.h"
#include "contrejour/starburst.h"
#include "diffraction/band_sum.h"
#include "diffraction/starburst_pattern.h"

namespace contrejour {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kFlatRho = 0.05;        // the pattern is flat to 1 per cent within
constexpr double kPixelsPerAngle = 0.7;  // directions are as close as that at an octave's outer radius,
constexpr double kRhoPerAngle = 0.2;     // or as close as this where the pattern itself is smoother than pixels
constexpr std::size_t kFewestAngles = 96;
constexpr std::size_t kBlock = kDirectionsAtOnce;

// What each band adds, by how many rows it moves the pattern outwards.
struct Shifts {
  double lambda_nm = 0;  // not moved
  int first = 0;  // rows
  std::vector<std::array<float, 3>> weight;

  [[nodiscard]] int last() const { return first + static_cast<int>(weight.size()) - 1; }
};

Shifts shifts_of(std::span<const SpectralBand> bands) {
  const auto [low, high] = std::minmax_element(bands.begin(), bands.end(),
                                               [](const auto& a, const auto& b) { return a.lambda_nm < b.lambda_nm; });
  Shifts shifts;
  shifts.lambda_nm = std::sqrt(low->lambda_nm * high->lambda_nm);
  const auto rows_of = [&](double nm) { return kRowsPerOctave * std::log2(nm / shifts.lambda_nm); };
  shifts.first = static_cast<int>(std::floor(rows_of(low->lambda_nm)));
  const int last = static_cast<int>(std::floor(rows_of(high->lambda_nm))) + 1;
  shifts.weight.resize(static_cast<std::size_t>(last - shifts.first + 1));
  for (const SpectralBand& band : bands) {
    const double place = rows_of(band.lambda_nm) - shifts.first;
    const auto k = static_cast<std::size_t>(place);
    const double t = place - static_cast<double>(k);
    for (const std::size_t i : {k, k + 1}) {
      // A pattern twice as wide has a quarter of the density.
      const double spread = std::exp2(-2.0 * (shifts.first + static_cast<double>(i)) / kRowsPerOctave);
      for (std::size_t c = 0; c < 3; ++c)
        shifts.weight[i][c] += static_cast<float>(band.weight[c] * spread * (i == k ? 1.0 - t : t));
    }
  }
  return shifts;
}

struct Ring {
  std::size_t octave, first_angle;
};

// One block of directions of one octave.
void fill(StarburstOctave& octave, std::size_t first_angle, double first_px, double rho_per_px,
          const StarburstPattern& pattern, const Shifts& shifts) {
  // Row r of the result takes row r - shift of the pattern.
  const int lead = shifts.last(), rows = kRowsPerOctave + 1;
  const int source_rows = rows + shifts.last() - shifts.first;
  const std::size_t count = std::min(kBlock, octave.angles - first_angle);
  const double step = kPi / static_cast<double>(octave.angles);
  std::vector<float> source(static_cast<std::size_t>(source_rows) * kBlock);
  for (std::size_t a = 0; a < count; ++a)
    pattern.sample((static_cast<double>(first_angle + a) + 0.5) * step - 0.5 * kPi, step,
                   first_px * row_ratio(-lead) * rho_per_px, source_rows, source.data() + a, kBlock);
  const auto density = static_cast<float>(rho_per_px * rho_per_px);  // per rho^2 -> per square pixel
  DirectionSums sum;
  for (int row = 0; row < rows; ++row) {
    sum_bands(shifts.weight, source.data() + static_cast<std::size_t>(row + lead - shifts.first) * kBlock, sum);
    float* const to = octave.rgb0.data() + (static_cast<std::size_t>(row) * octave.angles + first_angle) * 4;
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t c = 0; c < 3; ++c) to[a * 4 + c] = density * sum[c][a];
  }
}

}  // namespace

Starburst make_starburst(const PupilMask& mask, const IrisOpening* outline, std::span<const SpectralBand> bands,
                         const StarburstSettings& settings, const Context& context) {
  assert(mask.real() && !bands.empty());
  if (!(mask.open_area_mm2() > 0.0) || (outline && outline->closed())) return Starburst();
  Context steps = context;
  steps.progress = {};
  const Shifts shifts = shifts_of(bands);
  const StarburstPattern pattern(mask, outline, settings.pupil_radius_mm, steps);
  if (context.cancelled()) return Starburst();

  // rho = x / (lambda N), N = distance / (2 pupil radius): hullin2011 eq. 2.
  const double rho_per_px =
      settings.pixel_pitch_mm * 2.0 * settings.pupil_radius_mm / (mm_from_nm(shifts.lambda_nm) * settings.distance_mm);
  auto rings = std::make_shared<StarburstRings>();
  rings->radius_px = settings.radius_px;
  // So many octaves that the innermost is flat, and the last ends where the starburst does.
  const double flat_px = std::min(0.5, kFlatRho / rho_per_px);
  const double octaves = std::max(1.0, std::ceil(std::log2(settings.radius_px / flat_px)));
  rings->first_px = settings.radius_px * std::exp2(-octaves);
  std::vector<Ring> blocks;
  for (double o = 1.0; o <= octaves; ++o) {
    const double outer_px = rings->first_px * std::exp2(o);
    const double finest = std::min(kPi * outer_px / kPixelsPerAngle, kPi * outer_px * rho_per_px / kRhoPerAngle);
    StarburstOctave octave;
    octave.angles = std::max(kFewestAngles, static_cast<std::size_t>(std::ceil(finest / kBlock)) * kBlock);
    octave.rgb0.resize((kRowsPerOctave + 1) * octave.angles * 4);
    for (std::size_t a = 0; a < octave.angles; a += kBlock) blocks.push_back({rings->octaves.size(), a});
    rings->octaves.push_back(std::move(octave));
  }
  const bool finished = parallel_for(blocks.size(), context, [&](std::size_t b) {
    const Ring ring = blocks[b];
    fill(rings->octaves[ring.octave], ring.first_angle, rings->first_px * std::exp2(static_cast<double>(ring.octave)),
         rho_per_px, pattern, shifts);
  });
  return finished ? Starburst(std::move(rings)) : Starburst();
}

Starburst make_starburst(const IrisOpening& opening, std::span<const SpectralBand> bands,
                         const StarburstSettings& settings, const Context& context) {
  if (opening.closed()) return Starburst();
  Context steps = context;
  steps.progress = {};
  const PupilMask mask =
      make_mask(grid_over(settings.pupil_radius_mm, settings.samples_across), opening, settings.pupil_radius_mm, steps);
  return make_starburst(mask, &opening, bands, settings, context);
}

}  // namespace contrejour
