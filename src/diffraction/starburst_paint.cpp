// Rings of a starburst onto pixels. Near the centre, where it is finer than a pixel, every piece of a ring is laid onto
// the pixels it covers; farther out each pixel reads the rings. Between the two, one fades into the other.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/tasks.h"
#include "contrejour/starburst.h"
#include "diffraction/ring_reader.h"
#include "diffraction/starburst_rings.h"

namespace contrejour {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLaidWithin = 4.0, kReadFrom = 8.0;  // pixels from the centre
constexpr double kReadFinelyWithin = 16.0;  // pixels: farther out a pixel's middle is its mean
constexpr int kPatchHalf = 10;  // pixels on each side of the centre's that the laid part can reach
constexpr int kPatchSide = 2 * kPatchHalf + 1;
constexpr int kPiecesPerAngle = 4;

double read_share(double r_px) {
  const double t = std::clamp((r_px - kLaidWithin) / (kReadFrom - kLaidWithin), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// The laid part about the centre's pixel.
class CentrePatch {
 public:
  explicit CentrePatch(Vec2 centre_px)
      : left_(static_cast<int>(std::floor(centre_px.x)) - kPatchHalf),
        top_(static_cast<int>(std::floor(centre_px.y)) - kPatchHalf), centre_{centre_px.x - left_, centre_px.y - top_},
        sum_(kPatchSide * kPatchSide) {}

  void lay_all(const StarburstRings& rings) {
    lay_disc(rings);
    for (std::size_t o = 0; o < rings.octaves.size(); ++o) {
      const double first = rings.first_px * std::exp2(static_cast<double>(o));
      if (first < kReadFrom) lay_octave(rings.octaves[o], first);
    }
  }

  void add_to(Image& image, const Rgb& flux) const {
    for (int y = 0; y < kPatchSide; ++y) {
      for (int x = 0; x < kPatchSide; ++x) {
        const int px = left_ + x, py = top_ + y;
        if (px < 0 || py < 0 || px >= image.width || py >= image.height) continue;
        for (std::size_t c = 0; c < 3; ++c)
          image.at(px, py, static_cast<int>(c)) +=
              static_cast<float>(flux[c] * sum_[static_cast<std::size_t>(y * kPatchSide + x)][c]);
      }
    }
  }

 private:
  // Half the flux at an offset and half at its opposite, each over a square this wide.
  void lay(Vec2 offset, double width, const std::array<double, 3>& flux) {
    lay_square(centre_ + offset, width, flux);
    lay_square(centre_ - offset, width, flux);
  }

  void lay_square(Vec2 at, double width, const std::array<double, 3>& flux) {
    const int x0 = static_cast<int>(std::floor(at.x - 0.5 * width)), x1 = static_cast<int>(at.x + 0.5 * width);
    const int y0 = static_cast<int>(std::floor(at.y - 0.5 * width)), y1 = static_cast<int>(at.y + 0.5 * width);
    for (int y = std::max(y0, 0); y <= std::min(y1, kPatchSide - 1); ++y) {
      for (int x = std::max(x0, 0); x <= std::min(x1, kPatchSide - 1); ++x) {
        const double w = std::min(at.x + 0.5 * width, x + 1.0) - std::max(at.x - 0.5 * width, static_cast<double>(x));
        const double h = std::min(at.y + 0.5 * width, y + 1.0) - std::max(at.y - 0.5 * width, static_cast<double>(y));
        const double share = 0.5 * w * h / (width * width);
        for (std::size_t c = 0; c < 3; ++c) sum_[static_cast<std::size_t>(y * kPatchSide + x)][c] += share * flux[c];
      }
    }
  }

  // Within the first row the density is that row's mean.
  void lay_disc(const StarburstRings& rings) {
    const StarburstOctave& inner = rings.octaves.front();
    const double r = rings.first_px * std::exp2(-0.5 / kRowsPerOctave);
    std::array<double, 3> flux{};
    for (std::size_t a = 0; a < inner.angles; ++a)
      for (std::size_t c = 0; c < 3; ++c)
        flux[c] += inner.at(0, a)[c] * kPi * r * r / static_cast<double>(inner.angles);
    lay({}, std::sqrt(kPi) * r, flux);
  }

  // Each row and direction stands for its share of the ring between the rows half-way to its neighbours.
  void lay_octave(const StarburstOctave& octave, double first_px) {
    const double step = kPi / static_cast<double>(octave.angles);
    const double half_row = std::exp2(0.5 / kRowsPerOctave);
    for (std::size_t row = 0; row < kRowsPerOctave; ++row) {
      const double r = first_px * std::exp2(static_cast<double>(row) / kRowsPerOctave);
      const double laid = 1.0 - read_share(r);
      if (laid <= 0.0) return;
      const double inner = r / half_row, outer = r * half_row;
      const double area = step * (outer * outer - inner * inner) / kPiecesPerAngle;  // both halves of the turn
      const double width = std::max(outer - inner, r * step / kPiecesPerAngle);
      for (std::size_t i = 0; i < octave.angles * kPiecesPerAngle; ++i) {
        const double angle = (static_cast<double>(i) + 0.5) * step / kPiecesPerAngle - 0.5 * kPi;
        const float* const rgb = octave.at(row, i / kPiecesPerAngle);
        lay(Vec2{std::cos(angle), -std::sin(angle)} * r, width,
            {laid * area * rgb[0], laid * area * rgb[1], laid * area * rgb[2]});
      }
    }
  }

  int left_, top_;
  Vec2 centre_;
  std::vector<std::array<double, 3>> sum_;
};

// A pixel near the centre, at so many places, without what the patch has.
std::array<float, 3> read_finely(const StarburstRings& rings, double x, double y) {
  constexpr int kSide = 4;
  std::array<float, 3> sum{};
  for (int i = 0; i < kSide * kSide; ++i) {
    const double u = x + (i % kSide + 0.5) / kSide - 0.5, v = y + (i / kSide + 0.5) / kSide - 0.5;
    const auto share = static_cast<float>(read_share(std::hypot(u, v)) / (kSide * kSide));
    if (share <= 0.0F) continue;
    std::array<float, 3> rgb{};
    read_rings(rings, u, v, 1, rgb.data());
    for (std::size_t c = 0; c < 3; ++c) sum[c] += share * rgb[c];
  }
  return sum;
}

}  // namespace

void add_starburst(Image& image, const Starburst& starburst, Vec2 centre_px, const Rgb& flux, const Context& context) {
  assert(image.channels == 3);
  if (starburst.rings() == nullptr) return;
  const StarburstRings& rings = *starburst.rings();
  CentrePatch patch(centre_px);
  patch.lay_all(rings);
  patch.add_to(image, flux);
  const auto width = static_cast<std::size_t>(image.width);
  parallel_for(static_cast<std::size_t>(image.height), context, [&](std::size_t row) {
    const double y = static_cast<double>(row) + 0.5 - centre_px.y;
    if (std::abs(y) > rings.radius_px) return;
    std::vector<float> rgb(3 * width);
    read_rings(rings, 0.5 - centre_px.x, y, width, rgb.data());
    for (std::size_t x = 0; x < width; ++x) {
      const double from_centre = static_cast<double>(x) + 0.5 - centre_px.x;
      if (std::hypot(from_centre, y) > kReadFinelyWithin) continue;
      const std::array<float, 3> fine = read_finely(rings, from_centre, y);
      std::copy(fine.begin(), fine.end(), rgb.begin() + static_cast<std::ptrdiff_t>(3 * x));
    }
    const std::array<float, 3> scale{static_cast<float>(flux[0]), static_cast<float>(flux[1]),
                                     static_cast<float>(flux[2])};
    const std::span<float> pixels = image.row(static_cast<int>(row));
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] += scale[i % 3] * rgb[i];
  });
}

}  // namespace contrejour
