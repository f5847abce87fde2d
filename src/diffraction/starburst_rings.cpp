// Rings of a starburst: hullin2011 3.3, one power spectrum scaled by wavelength.
#include "diffraction/starburst_rings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

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
constexpr double kMostAngles = 32768;  // 0.7 pixels apart 7300 pixels from the centre; 50 MB an octave
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

constexpr double kLargestRadius_px = 1e6;
constexpr int kMostSamples = 4096;  // the spectrum of as many takes 1 GB

bool is_positive(double value) { return value > 0.0 && std::isfinite(value); }

tl::unexpected<Error> invalid(const std::string& message) { return failure(ErrorCode::InvalidArgument, message); }

std::optional<std::string> problem_with(std::span<const SpectralBand> bands, const StarburstSettings& settings) {
  const std::pair<double, const char*> lengths[] = {{settings.distance_mm, "distance of the exit pupil, in mm,"},
                                                    {settings.pupil_radius_mm, "radius of the exit pupil, in mm,"},
                                                    {settings.pixel_pitch_mm, "pixel pitch, in mm,"},
                                                    {settings.radius_px, "radius of a starburst, in pixels,"}};
  for (const auto& [value, name] : lengths)
    if (!is_positive(value)) return fmt::format("the {} must be positive, not {}", name, value);
  if (settings.radius_px > kLargestRadius_px)
    return fmt::format("a starburst of {} pixels is too large; {} are the limit", settings.radius_px,
                       kLargestRadius_px);
  if (settings.samples_across < 16 || settings.samples_across > kMostSamples)
    return fmt::format("{} samples across the pupil are out of range; choose 16 to {}", settings.samples_across,
                       kMostSamples);
  if (bands.empty()) return "a starburst needs the light's wavelengths; there are none";
  for (const SpectralBand& band : bands)
    if (!is_positive(band.lambda_nm) || !std::isfinite(band.weight[0] + band.weight[1] + band.weight[2]))
      return fmt::format("a band at {} nm, or its weight, is no number that light can have", band.lambda_nm);
  return std::nullopt;
}

std::optional<std::string> problem_with(const PupilMask& mask, const PupilOutline* outline) {
  if (!mask.real()) return "a starburst takes a mask without phase";
  const auto side = static_cast<std::size_t>(std::max(mask.grid.side, 0));
  if (mask.grid.side < 2 || mask.grid.side > kMostSamples || mask.amplitude.size() != side * side)
    return fmt::format("a mask of {} samples a side with {} samples is no square of 2 to {}", mask.grid.side,
                       mask.amplitude.size(), kMostSamples);
  if (!is_positive(mask.grid.pitch_mm))
    return fmt::format("a mask's samples cannot be {} mm apart", mask.grid.pitch_mm);
  if (!std::isfinite(mask.open_area_mm2())) return "a mask's amplitudes must be finite";
  if (outline && !outline->opening.closed() && !is_positive(outline->area_mm2()))
    return "the outline of the pupil has no area";
  if (outline && outline->dirt && !is_positive(outline->dirt->power_mm2))
    return "dirt that lets nothing through leaves no starburst";
  return std::nullopt;
}

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

Result<Starburst> make_starburst(const PupilMask& mask, const PupilOutline* outline,
                                 std::span<const SpectralBand> bands, const StarburstSettings& settings,
                                 const Context& context) {
  if (context.cancelled()) return interrupted();
  if (const auto problem = problem_with(bands, settings)) return invalid(*problem);
  if (const auto problem = problem_with(mask, outline)) return invalid(*problem);
  if (!(mask.open_area_mm2() > 0.0) || (outline && outline->opening.closed())) return Starburst();
  Context steps = context;
  steps.progress = {};
  const Shifts shifts = shifts_of(bands);
  const StarburstPattern pattern(mask, outline, settings.pupil_radius_mm, steps);
  if (context.cancelled()) return interrupted();

  // rho = x / (lambda N), N = distance / (2 pupil radius): hullin2011 eq. 2.
  const double rho_per_px =
      settings.pixel_pitch_mm * 2.0 * settings.pupil_radius_mm / (mm_from_nm(shifts.lambda_nm) * settings.distance_mm);
  auto rings = std::make_shared<StarburstRings>();
  rings->radius_px = settings.radius_px;
  // So many octaves that the innermost is flat, and the last ends where the starburst does.
  const double flat_px = std::min({0.5, kFlatRho / rho_per_px, 0.5 * settings.radius_px});
  const double octaves = std::max(1.0, std::ceil(std::log2(settings.radius_px / flat_px)));
  rings->first_px = settings.radius_px * std::exp2(-octaves);
  std::vector<Ring> blocks;
  for (double o = 1.0; o <= octaves; ++o) {
    const double outer_px = rings->first_px * std::exp2(o);
    const double finest = std::min(kPi * outer_px / kPixelsPerAngle, kPi * outer_px * rho_per_px / kRhoPerAngle);
    StarburstOctave octave;
    const auto enough = static_cast<std::size_t>(std::ceil(std::min(finest, kMostAngles) / kBlock)) * kBlock;
    octave.angles = std::max(kFewestAngles, enough);
    octave.rgb0.resize((kRowsPerOctave + 1) * octave.angles * 4);
    for (std::size_t a = 0; a < octave.angles; a += kBlock) blocks.push_back({rings->octaves.size(), a});
    rings->octaves.push_back(std::move(octave));
  }
  const bool finished = parallel_for(blocks.size(), context, [&](std::size_t b) {
    const Ring ring = blocks[b];
    fill(rings->octaves[ring.octave], ring.first_angle, rings->first_px * std::exp2(static_cast<double>(ring.octave)),
         rho_per_px, pattern, shifts);
  });
  if (!finished) return interrupted();
  return Starburst(std::move(rings));
}

Result<Starburst> make_starburst(const IrisOpening& opening, std::span<const SpectralBand> bands,
                                 const StarburstSettings& settings, const Context& context) {
  if (const auto problem = problem_with(bands, settings)) return invalid(*problem);
  if (opening.closed()) return Starburst();
  Context steps = context;
  steps.progress = {};
  const double radius_mm = settings.pupil_radius_mm;
  const PupilMask mask = make_mask(grid_over(radius_mm, settings.samples_across), opening, radius_mm, steps);
  const PupilOutline outline{opening, {radius_mm, 0.0}, {0.0, radius_mm}};
  return make_starburst(mask, &outline, bands, settings, context);
}

}  // namespace contrejour
