// SPDX-License-Identifier: Apache-2.0
// The longest ghost of a lens, and rays for it, which the packet benchmarks share.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "contrejour/expert/ghost.h"
#include "optics/trace/packet_trace.h"

namespace contrejour::bench {

inline constexpr int kSide = 64;  // rays over a square of the entrance plane
inline constexpr double kWidth_mm = 4.0;
inline constexpr double kLambda_nm = 550.0;
inline constexpr const char* kLenses[] = {"heliar", "nikon-80-200", "canon-70-200"};

struct PacketScene {
  OpticalPath path;
  std::unique_ptr<ReflectanceTables> tables;
  std::unique_ptr<PacketPath> packets;
  std::vector<float> x_mm, y_mm;
  std::vector<std::vector<float>> results;

  [[nodiscard]] std::size_t rays() const { return x_mm.size(); }
  [[nodiscard]] TracedArrays arrays() {
    const auto at = [&](std::size_t k) { return results[k].data(); };
    TracedArrays out;
    out.sensor_x_mm = at(0);
    out.sensor_y_mm = at(1);
    out.transmission = at(2);
    out.relative_height = at(3);
    out.stop_x = {at(4), at(5), at(6)};
    out.stop_y = {at(7), at(8), at(9)};
    return out;
  }
};

// nullopt if the lens does not load.
inline std::optional<PacketScene> packet_scene(const char* name) {
  const Result<Prescription> prescription = find_lens(name);
  if (!prescription) return std::nullopt;
  const Result<LensState> lens = configure_lens(*prescription);
  if (!lens) return std::nullopt;
  const auto ghosts = enumerate_ghosts(*lens, GhostScope::OneSideOfStop);
  const Ghost longest =
      *std::max_element(ghosts.begin(), ghosts.end(), [](Ghost a, Ghost b) { return a.j - a.i < b.j - b.i; });
  const Vec3 direction = normalized({-0.05, -0.03, 1.0});
  PacketScene scene;
  scene.path = ghost_path(*lens, longest, kLambda_nm);
  scene.tables = std::make_unique<ReflectanceTables>(*lens, kLambda_nm);
  const LightRays rays{{-0.5 * kWidth_mm, -0.5 * kWidth_mm, entrance_window(*lens, direction).z_mm}, direction};
  scene.packets = std::make_unique<PacketPath>(scene.path, *scene.tables, rays);
  for (int k = 0; k < kSide * kSide; ++k) {
    scene.x_mm.push_back(static_cast<float>(kWidth_mm * (k % kSide) / kSide));
    scene.y_mm.push_back(static_cast<float>(kWidth_mm * (k / kSide) / kSide));
  }
  scene.results.assign(10, std::vector<float>(scene.rays()));
  return scene;
}

}  // namespace contrejour::bench
