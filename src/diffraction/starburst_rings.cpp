// Rings of a starburst: hullin2011 3.3, one power spectrum scaled by wavelength.
#include "diffraction/starburst_rings.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "base/tasks.h"
#include "base/units.h"
#include "contrejour/starburst.h"
#include "diffraction/band_sum.h"
#include "diffraction/edge_waves.h"
#include "diffraction/power_grid.h"

namespace contrejour {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kFlatRho = 0.05;        // the pattern is flat to 1 per cent within
constexpr double kPixelsPerAngle = 0.7;  // directions are as close as that at an octave's outer radius,
constexpr double kRhoPerAngle = 0.2;     // or as close as this where the pattern itself is smoother than pixels
constexpr std::size_t kFewestAngles = 96;
constexpr double kSampleRho = 0.45;      // fringes are 1 apart at least: samples of an average stand closer
// From spectrum to edge waves, in samples across: where aliases of the edges are below 1 per cent, and with dirt, which
// only the spectrum has, where they are 10.
constexpr double kTailEnd = 0.2, kTailEndWithDirt = 0.35;
constexpr double kTailFade = 0.625;  // of that, where it begins
constexpr double kCleanWithin = 2e-3;  // relative: as much as edges' samples may be off
constexpr std::size_t kBlock = kDirectionsAtOnce;

constexpr int kRowsPerStep = 4;  // between which edge waves are interpolated

double row_ratio(double rows) { return std::exp2(rows / kRowsPerOctave); }

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

// An edge's samples hold their open share s as amplitude, so as power s^2 for s. The mean of s - s^2 is 1/6.
double power_lost_at_edges(const IrisOpening& outline, double across) {
  return 1.0 + outline.perimeter() * (2.0 / across) / (6.0 * outline.area());
}

// Mean amplitude over the opening: 1 where nothing but the opening's own edges dims the mask.
double mean_amplitude(const PupilMask& mask, const IrisOpening& outline, double pupil_radius_mm) {
  double sum = 0.0;
  for (const float a : mask.amplitude) sum += a;
  const double per_sample = mask.grid.pitch_mm / pupil_radius_mm;
  return sum * per_sample * per_sample / outline.area();
}

double tail_end_of(const PupilMask& mask, const IrisOpening* outline, double pupil_radius_mm) {
  if (outline == nullptr) return 1.0;  // all there is
  const bool clean = std::abs(mean_amplitude(mask, *outline, pupil_radius_mm) - 1.0) < kCleanWithin;
  return clean ? kTailEnd : kTailEndWithDirt;
}

// The pattern at one wavelength, as density over rho.
class Pattern {
 public:
  Pattern(const PupilMask& mask, const IrisOpening* outline, double pupil_radius_mm, const Context& context)
      : across_(2.0 * pupil_radius_mm / mask.grid.pitch_mm),
        power_mm2_(mask.open_area_mm2() * (outline ? power_lost_at_edges(*outline, across_) : 1.0)),
        grid_(mask, pupil_radius_mm, tail_end_of(mask, outline, pupil_radius_mm) * across_, power_mm2_,
              outline != nullptr, context) {
    tail_end_ = grid_.up_to();
    tail_start_ = outline ? tail_end_ * kTailFade : tail_end_;  // a picture has no other tail to fade to
    if (!outline) return;
    edges_.emplace(*outline);
    // |F|^2 in stop radii, over 4 for d^2 rho = 4 d^2 f, over the mask's power; the edges' part by the mean amplitude.
    const double mean = mean_amplitude(mask, *outline, pupil_radius_mm);
    tail_scale_ = mean * mean * pupil_radius_mm * pupil_radius_mm / (4.0 * power_mm2_);
  }

  // Averages over rows and directions about the radii from first_rho on, row by row; out is [row * stride].
  void sample(double angle_rad, double window_rad, double first_rho, int rows, float* out, std::size_t stride) const {
    int row = 0;
    for (; row < rows; ++row) {
      const double rho = first_rho * row_ratio(row);
      const double t = (rho - tail_start_) / (tail_end_ - tail_start_);
      if (rho >= tail_end_) break;
      double value = spectrum_average(angle_rad, window_rad, rho);
      if (t > 0.0) value += t * (tail_density(angle_rad, window_rad, rho) - value);
      out[static_cast<std::size_t>(row) * stride] = static_cast<float>(value);
    }
    if (row >= rows) return;
    const double first_tail_rho = first_rho * row_ratio(row);
    float* const tail = out + static_cast<std::size_t>(row) * stride;
    if (edges_)
      sample_edges(angle_rad, window_rad, first_tail_rho, rows - row, tail, stride);
    else
      sample_beyond(angle_rad, window_rad, first_tail_rho, rows - row, tail, stride);
  }

 private:
  [[nodiscard]] double spectrum_average(double angle_rad, double window_rad, double rho) const {
    const double height = rho * (row_ratio(1.0) - 1.0), width = rho * window_rad;
    const int down = std::max(1, static_cast<int>(std::ceil(height / kSampleRho)));
    const int across = std::max(1, static_cast<int>(std::ceil(width / kSampleRho)));
    double sum = 0.0;
    for (int j = 0; j < across; ++j) {
      const double angle = angle_rad + window_rad * ((j + 0.5) / across - 0.5);
      double x = std::cos(angle), y = std::sin(angle);
      if (x < 0.0) x = -x, y = -y;
      for (int i = 0; i < down; ++i) {
        const double r = std::min(rho + height * ((i + 0.5) / down - 0.5), grid_.up_to());
        sum += grid_.density(r * x, r * y);
      }
    }
    return sum / (down * across);
  }

  [[nodiscard]] double tail_density(double angle_rad, double window_rad, double rho) const {
    return edges_ ? tail_scale_ * edges_->along(angle_rad, window_rad).power(kPi * rho) : 0.0;
  }

  // Edge waves times rho^3 change so slowly that every few rows will do.
  void sample_edges(double angle_rad, double window_rad, double first_rho, int rows, float* out,
                    std::size_t stride) const {
    const EdgeWaves::Direction direction = edges_->along(angle_rad, window_rad);
    const auto scaled = [&](double rho) { return tail_scale_ * rho * rho * rho * direction.power(kPi * rho); };
    double here = scaled(first_rho);
    for (int begin = 0; begin < rows; begin += kRowsPerStep) {
      const double next = scaled(first_rho * row_ratio(begin + kRowsPerStep));
      for (int i = 0; i < std::min(kRowsPerStep, rows - begin); ++i) {
        const double rho = first_rho * row_ratio(begin + i);
        const double value = here + (next - here) * i / kRowsPerStep;
        out[static_cast<std::size_t>(begin + i) * stride] = static_cast<float>(value / (rho * rho * rho));
      }
      here = next;
    }
  }

  // Of a picture: the mean over the last third of what its samples say, going on as rho^-3.
  void sample_beyond(double angle_rad, double window_rad, double first_rho, int rows, float* out,
                     std::size_t stride) const {
    double sum = 0.0;
    int count = 0;
    for (double rho = tail_end_; rho > 0.7 * tail_end_; rho /= row_ratio(1.0), ++count)
      sum += spectrum_average(angle_rad, window_rad, rho) * rho * rho * rho;
    for (int i = 0; i < rows; ++i)
      out[static_cast<std::size_t>(i) * stride] =
          static_cast<float>(sum / count / std::pow(first_rho * row_ratio(i), 3));
  }

  double across_, power_mm2_;
  PowerGrid grid_;
  std::optional<EdgeWaves> edges_;
  double tail_start_ = 0, tail_end_ = 0, tail_scale_ = 0;
};

struct Ring {
  std::size_t octave, first_angle;
};

// One block of directions of one octave.
void fill(StarburstOctave& octave, std::size_t first_angle, double first_px, double rho_per_px, const Pattern& pattern,
          const Shifts& shifts) {
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
  const Pattern pattern(mask, outline, settings.pupil_radius_mm, steps);
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
