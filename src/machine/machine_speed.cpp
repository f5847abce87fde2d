// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/machine_speed.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "base/clock.h"
#include "base/tasks.h"
#include "contrejour/expert/check_lens.h"
#include "contrejour/expert/ghost.h"
#include "contrejour/image.h"
#include "optics/trace/packet_trace.h"

namespace contrejour {
namespace {

constexpr int kRounds = 5;
constexpr double kMaxPixels = 268435456.0;  // the limit of a render
constexpr double kLambda_nm = 550.0;
// A number of rays that fills long vectors and fits into a core's own cache.
constexpr std::size_t kRaysPerSide = 32;
constexpr std::size_t kRays = kRaysPerSide * kRaysPerSide;
constexpr std::size_t kRepeats = 8;
constexpr std::size_t kItems = 256;  // several for each thread, so that none waits long for the last
constexpr double kWidth_mm = 4.0;    // side of the square of the entrance plane that they start from

// Points of the entrance plane, and memory for the results of their rays.
class RaySquare {
 public:
  RaySquare() : x_mm_(kRays), y_mm_(kRays), results_((4 + 2 * kMaxStopCrossings) * kRays) {
    for (std::size_t k = 0; k < kRays; ++k) {
      x_mm_[k] = static_cast<float>(kWidth_mm * static_cast<double>(k % kRaysPerSide) / kRaysPerSide);
      y_mm_[k] = static_cast<float>(kWidth_mm * static_cast<double>(k / kRaysPerSide) / kRaysPerSide);
    }
  }

  void trace_along(const PacketPath& path) {
    TracedArrays out;
    float* next = results_.data();
    const auto take = [&next] { return std::exchange(next, next + kRays); };
    out.sensor_x_mm = take();
    out.sensor_y_mm = take();
    out.transmission = take();
    out.relative_height = take();
    for (auto& x : out.stop_x) x = take();
    for (auto& y : out.stop_y) y = take();
    trace_packets(path, PacketPrecision::Float, x_mm_.data(), y_mm_.data(), kRays, out);
  }

 private:
  std::vector<float> x_mm_, y_mm_, results_;
};

// The fastest of the rounds; body runs one round.
template <class Body>
double fastest_ms(const Body& body) {
  double best_ms = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRounds; ++round) {
    const auto start = Clock::now();
    body();
    best_ms = std::min(best_ms, ms_since(start));
  }
  return best_ms;
}

}  // namespace

double peak_hits_per_ms(const LensState& lens, const Context& context) {
  if (!check_lens(lens)) return 0.0;
  const auto ghosts = enumerate_ghosts(lens, GhostScope::OneSideOfStop);
  if (ghosts.empty()) return 0.0;
  const Ghost longest =
      *std::max_element(ghosts.begin(), ghosts.end(), [](Ghost a, Ghost b) { return a.j - a.i < b.j - b.i; });
  const OpticalPath path = ghost_path(lens, longest, kLambda_nm);
  const ReflectanceTables tables(lens, kLambda_nm);
  const Vec3 along_axis{0.0, 0.0, 1.0};
  const Vec3 corner_mm{-0.5 * kWidth_mm, -0.5 * kWidth_mm, entrance_window(lens, along_axis).z_mm};
  const PacketPath packets(path, tables, {corner_mm, along_axis});
  const double ms = fastest_ms([&] {
    parallel_for(kItems, context, [&](std::size_t) {
      RaySquare square;
      for (std::size_t repeat = 0; repeat < kRepeats; ++repeat) square.trace_along(packets);
    });
  });
  if (context.cancelled()) return 0.0;
  return static_cast<double>(kItems * kRepeats * kRays * path.steps.size()) / ms;
}

double frame_pass_ms(int width, int height, const Context& context) {
  if (width < 1 || height < 1 || static_cast<double>(width) * height > kMaxPixels) return 0.0;
  Image image(width, height, 3);
  const auto row_floats = static_cast<std::size_t>(width) * 3;
  float value = 0.0F;
  return fastest_ms([&] {
    value += 1.0F;  // the value differs in each round
    parallel_for(static_cast<std::size_t>(height), context,
                 [&](std::size_t row) { std::fill_n(image.pixels.data() + row * row_floats, row_floats, value); });
  });
}

}  // namespace contrejour
