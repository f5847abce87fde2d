// SPDX-License-Identifier: Apache-2.0
// Which layer of a flare (flare_layers.h) each ghost of each light belongs to.
// Thread-safety: constant once made.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "contrejour/expert/flare_layers.h"

namespace contrejour::inline internal {

class LayerMap {
 public:
  // ghosts: those of the frame. flux_fractions: theirs, only needed by ghost and without a list.
  LayerMap(const LayerOptions& options, std::span<const Ghost> ghosts, std::span<const double> flux_fractions,
           std::span<const Light> lights);

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] std::size_t count() const { return names_.size(); }
  [[nodiscard]] const std::vector<Ghost>& ghosts() const { return ghosts_; }  // with layers of their own
  [[nodiscard]] std::size_t of(const Ghost& ghost, std::size_t light) const;
  [[nodiscard]] bool is_by_light() const { return is_by_light_; }
  [[nodiscard]] std::size_t of_light(std::size_t light) const { return by_light_[light]; }

 private:
  void add_ghosts(std::span<const Ghost> ghosts);
  void add_surfaces(std::span<const Ghost> ghosts);
  void add_lights(std::span<const std::string> names, std::span<const Light> lights);

  std::vector<std::string> names_;
  bool is_by_light_ = false;
  std::vector<Ghost> ghosts_;
  std::map<Ghost, std::size_t> by_ghost_;  // the others are in the last layer
  std::vector<std::size_t> by_light_;
};

inline constexpr const char* kRestLayer = "rest";

// The name with a number behind it if it is taken.
[[nodiscard]] std::string unique_layer_name(const std::string& name, std::set<std::string>& taken);

// Errors: InvalidArgument (render_layers()). Without a lens: all but the list of ghosts.
[[nodiscard]] Result<void> check_layers(const LayerOptions& options);
[[nodiscard]] Result<void> check_layers(const LensState& lens, const LayerOptions& options);

[[nodiscard]] bool needs_flux(const LayerOptions& options);

// The ghosts with a layer of their own, the brightest first.
[[nodiscard]] std::vector<Ghost> own_layers(const LayerOptions& options, std::span<const Ghost> ghosts,
                                            std::span<const double> flux_fractions);

}  // namespace contrejour::inline internal
