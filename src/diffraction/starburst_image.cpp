// SPDX-License-Identifier: Apache-2.0
// A starburst precomputed at pixels: half of the plane; the other half is the same rotated about the centre.
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/tasks.h"
#include "contrejour/expert/starburst.h"
#include "diffraction/near_field.h"
#include "diffraction/ring_reader.h"
#include "diffraction/sheet_rows.h"
#include "diffraction/starburst_core.h"
#include "diffraction/starburst_rings.h"

namespace contrejour::inline internal {

// Means over pixels whose middles lie whole pixels from the centre: x from -half_width to half_width, y (down) from 0
// to half_height; without the core.
struct StarburstSamples {
  Starburst starburst;
  int half_width = 0, half_height = 0;
  std::vector<float> rgb;
  // The core on cells a kCellsPerPixel-th of a pixel wide about the centre, summed from the first row and column on:
  // flux within (x, y) cells is at [(y * (kCoreCells + 1) + x) * 3 + c].
  std::vector<double> core;

  [[nodiscard]] std::size_t row_size() const { return 3 * (2 * static_cast<std::size_t>(half_width) + 1); }
  // From the sample x of a row y >= 0.
  [[nodiscard]] const float* at(int x, int y) const {
    return rgb.data() + static_cast<std::size_t>(y) * row_size() + 3 * static_cast<std::size_t>(x + half_width);
  }
};

}  // namespace contrejour::inline internal

namespace contrejour {
namespace {

constexpr double kMaxPixels = 67108864.0;  // 2^26: 1.6 GB
// Near the centre linear interpolation between samples is not accurate enough. The core fades out between these radii.
constexpr double kCoreFrom_px = 16.0, kCoreTo_px = 20.0;
constexpr int kCellsPerPixel = 8;
constexpr int kCorePixels = 42;
constexpr int kCoreCells = kCorePixels * kCellsPerPixel;
constexpr int kPixelRowsAtOnce = 8;     // neighbouring rows read the same samples

double core_weight(double r_px) {
  const double t = std::clamp((r_px - kCoreFrom_px) / (kCoreTo_px - kCoreFrom_px), 0.0, 1.0);
  return 1.0 - t * t * (3.0 - 2.0 * t);
}

std::vector<double> core_flux(const StarburstRings& rings, const Context& context) {
  constexpr auto kSide = static_cast<std::size_t>(kCoreCells);
  const NearField core(rings.near_cells, rings.first_px, core_weight);
  std::vector<double> below((kSide + 1) * (kSide + 1) * 3);
  constexpr double kCell_px = 1.0 / kCellsPerPixel;
  parallel_for(kSide, context, [&](std::size_t y) {
    const double top = 0.5 * kCorePixels - static_cast<double>(y) * kCell_px;
    double sum[3] = {};
    for (std::size_t x = 0; x < kSide; ++x) {
      const double left = static_cast<double>(x) * kCell_px - 0.5 * kCorePixels;
      const auto flux = core.flux({{left, top - kCell_px}, {left + kCell_px, top}});
      for (std::size_t c = 0; c < 3; ++c) below[((y + 1) * (kSide + 1) + x + 1) * 3 + c] = sum[c] += flux[c];
    }
  });
  const std::size_t row_size = (kSide + 1) * 3;
  for (std::size_t k = row_size; k < below.size(); ++k) below[k] += below[k - row_size];
  return below;
}

void mirror_columns(const float* from, std::size_t columns, float* to) {
  for (std::size_t i = 0; i < columns; ++i, to += 3) std::copy_n(from + 3 * (columns - 1 - i), 3, to);
}

// The position of a frame's pixels between the samples.
struct Placed {
  int x = 0, y = 0;  // the sample left of and above the first pixel's centre
  float right = 0, down = 0;  // and the distance beyond it, 0..1
};

Placed placed(Vec2 centre_px) {
  const double x = 0.5 - centre_px.x, y = 0.5 - centre_px.y;
  return {static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)), static_cast<float>(x - std::floor(x)),
          static_cast<float>(y - std::floor(y))};
}

bool contains(const StarburstSamples& samples, const Image& image, Vec2 centre_px) {
  return std::max(centre_px.x, image.width - centre_px.x) + 1.0 <= samples.half_width &&
         std::max(centre_px.y, image.height - centre_px.y) + 1.0 <= samples.half_height;
}

// Interpolates densities between the samples' rows y and y + 1, at `columns` samples from x on.
void blend_at(const StarburstSamples& samples, int x, int y, float down, std::size_t columns,
              std::vector<float>& mirrored, float* out) {
  const int last = x + static_cast<int>(columns) - 1;
  if (y >= 0) return blend_rows(samples.at(x, y), samples.at(x, y + 1), down, 3 * columns, out);
  // Above the centre the opposite samples are used.
  blend_rows(samples.at(-last, -y), samples.at(-last, -y - 1), down, 3 * columns, mirrored.data());
  mirror_columns(mirrored.data(), columns, out);
}

// Flux of the core within x and y cells, interpolated linearly.
Rgb core_within(const std::vector<double>& core, double x, double y) {
  const auto clamped = [](double v) { return std::clamp(v, 0.0, kCoreCells - 1e-9); };
  x = clamped(x);
  y = clamped(y);
  const auto column = static_cast<std::size_t>(x), row = static_cast<std::size_t>(y);
  const double s = x - static_cast<double>(column), t = y - static_cast<double>(row);
  constexpr std::size_t kRow = 3 * (kCoreCells + 1);
  const double* const p = core.data() + row * kRow + column * 3;
  Rgb sum{};
  for (std::size_t c = 0; c < 3; ++c)
    sum[c] = (1.0 - t) * ((1.0 - s) * p[c] + s * p[c + 3]) + t * ((1.0 - s) * p[c + kRow] + s * p[c + kRow + 3]);
  return sum;
}

void add_core(Image& image, const std::vector<double>& core, Vec2 centre_px, const Rgb& flux) {
  const Vec2 corner{centre_px.x - 0.5 * kCorePixels, centre_px.y - 0.5 * kCorePixels};
  const int left = static_cast<int>(std::floor(corner.x)), top = static_cast<int>(std::floor(corner.y));
  for (int y = std::max(top, 0); y < std::min(top + kCorePixels + 1, image.height); ++y) {
    for (int x = std::max(left, 0); x < std::min(left + kCorePixels + 1, image.width); ++x) {
      const double x0 = (x - corner.x) * kCellsPerPixel, y0 = (y - corner.y) * kCellsPerPixel;
      const double x1 = x0 + kCellsPerPixel, y1 = y0 + kCellsPerPixel;
      const Rgb a = core_within(core, x0, y0), b = core_within(core, x1, y0);
      const Rgb c = core_within(core, x0, y1), d = core_within(core, x1, y1);
      for (std::size_t k = 0; k < 3; ++k)
        image.at(x, y, static_cast<int>(k)) += static_cast<float>(flux[k] * (d[k] - c[k] - b[k] + a[k]));
    }
  }
}

void draw_rows(Image& image, const StarburstSamples& samples, Vec2 centre_px, const std::array<float, 3>& scale,
               int first, int end) {
  const Placed position = placed(centre_px);
  const auto width = static_cast<std::size_t>(image.width);
  std::vector<float> blended(3 * (width + 1)), mirrored(3 * (width + 1));
  for (int row = first; row < end; ++row) {
    blend_at(samples, position.x, position.y + row, position.down, width + 1, mirrored, blended.data());
    add_between(blended.data(), position.right, scale, 3 * width, image.row(row).data());
  }
}

}  // namespace

Result<StarburstImage> lay_out(const Starburst& starburst, int width, int height, const Context& context) {
  if (width < 1 || height < 1 || static_cast<double>(width) * height > kMaxPixels)
    return failure(ErrorCode::InvalidArgument, "a starburst is laid out for frames of 1 to 2^26 pixels");
  if (starburst.rings() == nullptr) return StarburstImage();
  auto samples = std::make_shared<StarburstSamples>();
  samples->starburst = starburst;
  samples->half_width = width + 1;
  samples->half_height = height + 1;
  samples->core = core_flux(*starburst.rings(), context);
  const NearField near_field(starburst.rings()->near_cells, starburst.rings()->first_px,
                             [](double r_px) { return 1.0 - core_weight(r_px); });
  const std::size_t row_size = samples->row_size();
  samples->rgb.resize(row_size * (static_cast<std::size_t>(samples->half_height) + 1));
  const bool done = parallel_for(static_cast<std::size_t>(samples->half_height) + 1, context, [&](std::size_t row) {
    const auto y = static_cast<double>(row);
    float* const to = samples->rgb.data() + row * row_size;
    read_rings(*starburst.rings(), -samples->half_width, y, row_size / 3, to);
    add_near_row(near_field, {samples->half_width + 0.5, 0.0}, y, row_size / 3, to);
  });
  if (!done) return interrupted();
  return StarburstImage(std::move(samples));
}

void add_starburst(Image& image, const StarburstImage& starburst_image, Vec2 centre_px, const Rgb& flux,
                   const Context& context) {
  if (image.channels != 3 || image.pixels.size() != image.index(0, image.height)) return;
  if (starburst_image.samples() == nullptr || !is_drawable(centre_px)) return;
  const StarburstSamples& samples = *starburst_image.samples();
  if (!contains(samples, image, centre_px)) return add_starburst(image, samples.starburst, centre_px, flux, context);
  add_core(image, samples.core, centre_px, flux);
  const std::array<float, 3> scale{static_cast<float>(flux[0]), static_cast<float>(flux[1]),
                                   static_cast<float>(flux[2])};
  const int blocks = (image.height + kPixelRowsAtOnce - 1) / kPixelRowsAtOnce;
  parallel_for(static_cast<std::size_t>(blocks), context, [&](std::size_t block) {
    const int first = static_cast<int>(block) * kPixelRowsAtOnce;
    draw_rows(image, samples, centre_px, scale, first, std::min(first + kPixelRowsAtOnce, image.height));
  });
}

}  // namespace contrejour
