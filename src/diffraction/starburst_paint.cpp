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
#include "diffraction/sheet_rows.h"
#include "diffraction/starburst_core.h"
#include "diffraction/starburst_rings.h"

namespace contrejour {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLaidWithin = 4.0, kReadFrom = 8.0;  // pixels from the centre
constexpr double kReadFinelyWithin = 16.0;  // pixels: farther out a pixel's middle is its mean
constexpr int kPatchHalf = 10;  // pixels on each side of the centre's that the laid part can reach
constexpr int kPatchSide = 2 * kPatchHalf + 1;
constexpr int kPiecesPerAngle = 4;
constexpr std::size_t kParts = 4;  // that rows are laid in side by side, whatever the number of threads

double read_share(double r_px) {
  const double t = std::clamp((r_px - kLaidWithin) / (kReadFrom - kLaidWithin), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// The laid part on square cells about the centre, pixels or smaller. centre: in cells of the patch.
class CentrePatch {
 public:
  CentrePatch(Vec2 centre, int side, double cell_px)
      : side_(side), cell_px_(cell_px), centre_(centre), sum_(static_cast<std::size_t>(side * side)) {}
  explicit CentrePatch(Vec2 centre_px)
      : CentrePatch(
            {centre_px.x - std::floor(centre_px.x) + kPatchHalf, centre_px.y - std::floor(centre_px.y) + kPatchHalf},
            kPatchSide, 1.0) {
    left_ = static_cast<int>(std::floor(centre_px.x)) - kPatchHalf;
    top_ = static_cast<int>(std::floor(centre_px.y)) - kPatchHalf;
  }

  void lay_all(const StarburstRings& rings, const Context& context) {
    Context quiet = context;
    quiet.progress = {};
    std::vector<Octave> octaves;
    for (std::size_t o = 0; o < rings.octaves.size(); ++o) {
      const double first_px = rings.first_px * std::exp2(static_cast<double>(o));
      if (first_px < kReadFrom) octaves.push_back({&rings.octaves[o], first_px, {}});
    }
    parallel_for(octaves.size(), quiet, [&](std::size_t k) { octaves[k].find_directions(); });
    std::vector<CentrePatch> parts(kParts, *this);
    parallel_for(kParts, quiet, [&](std::size_t part) {
      if (part == 0) parts[part].lay_disc(rings);
      for (const Octave& octave : octaves)
        for (std::size_t row = part; row < kRowsPerOctave; row += kParts) parts[part].lay_row(octave, row);
    });
    for (const CentrePatch& part : parts)
      for (std::size_t k = 0; k < sum_.size(); ++k)
        for (std::size_t c = 0; c < 3; ++c) sum_[k][c] += part.sum_[k][c];
  }

  [[nodiscard]] const std::array<double, 3>& flux(std::size_t x, std::size_t y) const {
    return sum_[y * static_cast<std::size_t>(side_) + x];
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
  struct Octave {
    const StarburstOctave* octave;
    double first_px;
    std::vector<Vec2> direction;  // of its pieces

    void find_directions() {
      const double step = kPi / static_cast<double>(octave->angles) / kPiecesPerAngle;
      for (std::size_t i = 0; i < octave->angles * kPiecesPerAngle; ++i) {
        const double angle = (static_cast<double>(i) + 0.5) * step - 0.5 * kPi;
        direction.push_back({std::cos(angle), -std::sin(angle)});
      }
    }
  };

  // Half the flux at an offset (pixels) and half at its opposite, each over a square this wide.
  void lay(Vec2 offset_px, double width_px, const std::array<double, 3>& flux) {
    const Vec2 offset = offset_px * (1.0 / cell_px_);
    lay_square(centre_ + offset, width_px / cell_px_, flux);
    lay_square(centre_ - offset, width_px / cell_px_, flux);
  }

  void lay_square(Vec2 at, double width, const std::array<double, 3>& flux) {
    const int x0 = static_cast<int>(std::floor(at.x - 0.5 * width)), x1 = static_cast<int>(at.x + 0.5 * width);
    const int y0 = static_cast<int>(std::floor(at.y - 0.5 * width)), y1 = static_cast<int>(at.y + 0.5 * width);
    for (int y = std::max(y0, 0); y <= std::min(y1, side_ - 1); ++y) {
      for (int x = std::max(x0, 0); x <= std::min(x1, side_ - 1); ++x) {
        const double w = std::min(at.x + 0.5 * width, x + 1.0) - std::max(at.x - 0.5 * width, static_cast<double>(x));
        const double h = std::min(at.y + 0.5 * width, y + 1.0) - std::max(at.y - 0.5 * width, static_cast<double>(y));
        const double share = 0.5 * w * h / (width * width);
        for (std::size_t c = 0; c < 3; ++c) sum_[static_cast<std::size_t>(y * side_ + x)][c] += share * flux[c];
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
  void lay_row(const Octave& of, std::size_t row) {
    const double r = of.first_px * std::exp2(static_cast<double>(row) / kRowsPerOctave);
    const double laid = 1.0 - read_share(r);
    if (laid <= 0.0) return;
    const double step = kPi / static_cast<double>(of.octave->angles);
    const double half_row = std::exp2(0.5 / kRowsPerOctave);
    const double inner = r / half_row, outer = r * half_row;
    const double area = step * (outer * outer - inner * inner) / kPiecesPerAngle;  // both halves of the turn
    const double width = std::max(outer - inner, r * step / kPiecesPerAngle);
    for (std::size_t i = 0; i < of.direction.size(); ++i) {
      const float* const rgb = of.octave->at(row, i / kPiecesPerAngle);
      lay(of.direction[i] * r, width, {laid * area * rgb[0], laid * area * rgb[1], laid * area * rgb[2]});
    }
  }

  int side_;
  double cell_px_;
  int left_ = 0, top_ = 0;  // of the image's pixel under the first cell
  Vec2 centre_;
  std::vector<std::array<double, 3>> sum_;
};

}  // namespace

void paint_core(Image& image, const StarburstRings& rings, Vec2 centre_px, const Rgb& flux, const Context& context) {
  CentrePatch patch(centre_px);
  patch.lay_all(rings, context);
  patch.add_to(image, flux);
}

std::vector<double> core_flux(const StarburstRings& rings, const Context& context) {
  constexpr auto kSide = static_cast<std::size_t>(kCoreCells);
  // Cells of the patch are pixels there: the same rings with pixels a kCellsPerPixel-th as wide.
  CentrePatch patch({0.5 * kCoreCells, 0.5 * kCoreCells}, kCoreCells, 1.0 / kCellsPerPixel);
  patch.lay_all(rings, context);
  std::vector<double> below((kSide + 1) * (kSide + 1) * 3);
  const auto at = [&](std::size_t x, std::size_t y, std::size_t c) -> double& {
    return below[(y * (kSide + 1) + x) * 3 + c];
  };
  for (std::size_t y = 0; y < kSide; ++y)
    for (std::size_t x = 0; x < kSide; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        at(x + 1, y + 1, c) = patch.flux(x, y)[c] + at(x, y + 1, c) + at(x + 1, y, c) - at(x, y, c);
  return below;
}

// Places of a row at so many offsets within the pixels, without what the patch has.
void read_core_row(const StarburstRings& rings, Vec2 centre_px, double y, std::size_t width, float* rgb) {
  constexpr int kSide = 4;
  if (std::abs(y) > kReadFinelyWithin) return;
  const double half = std::sqrt(kReadFinelyWithin * kReadFinelyWithin - y * y);
  const auto clamped = [&](double x) {
    return static_cast<std::size_t>(std::clamp(x, 0.0, static_cast<double>(width)));
  };
  const std::size_t from = clamped(std::ceil(centre_px.x - half - 0.5)),
                    to = clamped(std::floor(centre_px.x + half + 0.5));
  if (from >= to) return;
  std::fill(rgb + 3 * from, rgb + 3 * to, 0.0F);
  std::vector<float> fine(3 * (to - from));
  for (int i = 0; i < kSide * kSide; ++i) {
    const double u = static_cast<double>(from) + (i % kSide + 0.5) / kSide - centre_px.x;
    const double v = y + (i / kSide + 0.5) / kSide - 0.5;
    read_rings(rings, u, v, to - from, fine.data());
    for (std::size_t x = 0; x < to - from; ++x) {
      const auto share = static_cast<float>(read_share(std::hypot(u + static_cast<double>(x), v)) / (kSide * kSide));
      for (std::size_t c = 0; c < 3; ++c) rgb[3 * (from + x) + c] += share * fine[3 * x + c];
    }
  }
}

void add_starburst(Image& image, const Starburst& starburst, Vec2 centre_px, const Rgb& flux, const Context& context) {
  assert(image.channels == 3);
  if (starburst.rings() == nullptr || !is_drawable(centre_px)) return;
  const StarburstRings& rings = *starburst.rings();
  paint_core(image, rings, centre_px, flux, context);
  const auto width = static_cast<std::size_t>(image.width);
  const std::array<float, 3> scale{static_cast<float>(flux[0]), static_cast<float>(flux[1]),
                                   static_cast<float>(flux[2])};
  parallel_for(static_cast<std::size_t>(image.height), context, [&](std::size_t row) {
    const double y = static_cast<double>(row) + 0.5 - centre_px.y;
    if (std::abs(y) > rings.radius_px) return;
    std::vector<float> rgb(3 * (width + 1));
    read_rings(rings, 0.5 - centre_px.x, y, width, rgb.data());
    read_core_row(rings, centre_px, y, width, rgb.data());
    add_between(rgb.data(), 0.0F, scale, 3 * width, image.row(static_cast<int>(row)).data());
  });
}

}  // namespace contrejour
