// SPDX-License-Identifier: Apache-2.0
// The diffraction patterns of one iris, a section of RenderCache: on a grid of Fresnel numbers, by band of wavelengths,
// or by fractional order. See docs/physics/diffraction.md. Thread-safety: band() from any thread while no pattern is
// made; all else from one thread at a time.
#pragma once

#include <complex>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/fractional_fourier.h"
#include "contrejour/expert/iris.h"
#include "contrejour/expert/pupil_mask.h"
#include "render/stop_patterns/band_texture.h"
#include "render/stop_patterns/edge_profile.h"
#include "render/stop_patterns/pattern_texture.h"

namespace contrejour::inline internal::stop_patterns {

class StopPatterns {
 public:
  using Key = Iris;
  static constexpr std::size_t kMaxBytes = std::size_t{512} << 20U;  // from frame to frame
  using Texture = std::shared_ptr<const PatternTexture>;
  using Profile = std::shared_ptr<const EdgeProfile>;
  using Band = std::shared_ptr<const BandTexture>;

  // From this Fresnel number on, the fringes of different edges are nearly independent.
  static constexpr double kEdgesFrom = 48.0;
  // Wavelengths that are drawn together all have patterns, up to this Fresnel number.
  static constexpr double kHighestFresnel = 128.0;
  // Below this Fresnel number a ghost is its own far field: smaller than a few pixels, or so faint that its shape is
  // not visible.
  static constexpr double kLowestFresnel = 0.5;

  // A pattern for one Fresnel number, averaged over a band of wavelengths.
  struct Request {
    double fresnel_number = 1.0;  // at the band's middle; clamped to the range
    double spread = 0.0;  // RMS spread of the band's wavelengths over their mean
  };

  explicit StopPatterns(const Iris& iris);

  // Makes the patterns that do not exist yet, on all threads. Returns false if cancelled.
  bool make(std::span<const Request> requested, const Context& context);
  [[nodiscard]] Texture pattern(const Request& requested) const;  // null unless made
  [[nodiscard]] Profile profile(double spread);
  // Returns |F^order U|^2, averaged over some orders. Null if cancelled.
  [[nodiscard]] Texture fractional(std::span<const double> orders, const Context& context);

  // Combines some of the textures above; made when first requested. Any thread may call it while no pattern is made.
  [[nodiscard]] Band band(std::span<const PatternTexture* const> parts);
  // Contains the bands' textures, and the outline of a picture as the iris.
  [[nodiscard]] const raster::PatternAtlas& atlas() const { return atlas_; }

  // The number of stored patterns; fringes of edges need little memory.
  [[nodiscard]] std::size_t count() const { return nodes_.size() + patterns_.size() + by_orders_.size(); }
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  struct BandKey {
    int node = 0, spread = 0;
    friend auto operator<=>(const BandKey&, const BandKey&) = default;
  };
  [[nodiscard]] static BandKey key_of(const Request& requested);
  [[nodiscard]] Texture average(const BandKey& key) const;

  Iris iris_;
  PupilMask mask_;
  double open_area_;  // stop radii
  struct Node {  // one wavelength
    double extent = 0.0;
    std::vector<float> samples;
  };
  std::map<int, Node> nodes_;
  std::map<BandKey, Texture> patterns_;
  std::map<int, Profile> profiles_;
  std::optional<FractionalFourier> fractional_;
  std::vector<std::complex<double>> analysis_;
  std::map<std::vector<double>, Texture> by_orders_;
  raster::PatternAtlas atlas_;
  std::mutex bands_mutex_;
  std::map<std::vector<const PatternTexture*>, Band> bands_;
};

}  // namespace contrejour::inline internal::stop_patterns
