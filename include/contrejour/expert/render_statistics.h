// SPDX-License-Identifier: Apache-2.0
// The cost of a frame: time by phase, rays, polygons, memory.
// Thread-safety: plain values.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace contrejour {

struct RenderStatistics {
  std::string method;
  std::string device = "cpu";
  std::vector<std::pair<std::string, double>> time_ms;  // by phase, "total" last
  std::uint64_t rays = 0;
  std::uint64_t surface_hits = 0;
  std::uint64_t primitives = 0;  // what the method draws: polygons, triangles
  int ghosts_rendered = 0;
  // The fraction of the flare's flux that selection left out; nullopt where selection does not depend on flux (a list,
  // a surface), since measuring every ghost may take longer than rendering the chosen ones.
  std::optional<double> ghosts_skipped_flux;
  // Only for `polynomial`: the fraction of the light in the frame whose ghosts the fit does not accept, so that their
  // rays are traced.
  std::optional<double> traced_flux;
  std::uint64_t peak_memory_bytes = 0;

  // Only of frames that a device draws: the invocations of its shaders, which are counted on processors acting as GPUs
  // (0 on others), and the bytes between host and device in both directions.
  std::uint64_t device_invocations = 0;
  std::uint64_t device_bytes = 0;

  // Only for `tiled`, where `primitives` counts primitives before merging.
  std::uint64_t primitives_merged = 0;  // their number after merging
  std::uint64_t tile_indices = 0;  // entries of all dense tiles' lists
  std::uint64_t primitive_bytes = 0;  // of the primitives held at once
  std::uint64_t tile_list_bytes = 0;  // of the dense tiles' lists held at once
};

}  // namespace contrejour
