// The diffraction patterns of one iris, a section of RenderCache: by Fresnel number on a ladder, by band of
// wavelengths, by fractional order. docs/physics/diffraction.md. Thread-safety: band() from any thread, as long as no
// pattern is made; all else from one thread at a time.
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
#include "contrejour/fractional_fourier.h"
#include "contrejour/iris.h"
#include "contrejour/pupil_mask.h"
#include "render/screens/band_pattern.h"
#include "render/screens/edge_profile.h"
#include "render/screens/pattern_texture.h"

namespace contrejour::screens {

class StopPatterns {
 public:
  using Key = Iris;
  using Texture = std::shared_ptr<const PatternTexture>;
  using Profile = std::shared_ptr<const EdgeProfile>;
  using Band = std::shared_ptr<const BandPattern>;

  // From here on edges' fringes do not depend on one another, nearly.
  static constexpr double kEdgesFrom = 48.0;
  // Wavelengths that are drawn together have patterns together, up to this.
  static constexpr double kHighestFresnel = 128.0;
  // Below, a ghost is its own far field, smaller than a few pixels or so faint that its shape is not seen.
  static constexpr double kLowestFresnel = 0.5;

  // A pattern for one Fresnel number, the mean over a band of wavelengths.
  struct Wanted {
    double fresnel_number = 1.0;  // at the band's middle; taken within the range
    double spread = 0.0;          // of the band's wavelengths over their mean, root mean square
  };

  explicit StopPatterns(const Iris& iris);

  // Makes what is not there yet, on all threads. False when cancelled.
  bool make(std::span<const Wanted> wanted, const Context& context);
  [[nodiscard]] Texture pattern(const Wanted& wanted) const;  // null unless made
  [[nodiscard]] Profile profile(double spread);
  // |F^order U|^2, the mean over some orders. Null when cancelled.
  [[nodiscard]] Texture fractional(std::span<const double> orders, const Context& context);

  // Some of the textures above as one, made when first asked for. Any thread may ask, as long as no pattern is made.
  [[nodiscard]] Band band(std::span<const PatternTexture* const> parts);

  // Of pictures of the stop plane; fringes of edges take next to nothing.
  [[nodiscard]] std::size_t count() const { return rungs_.size() + patterns_.size() + by_orders_.size(); }

 private:
  struct BandKey {
    int rung = 0, spread = 0;
    friend auto operator<=>(const BandKey&, const BandKey&) = default;
  };
  [[nodiscard]] static BandKey key_of(const Wanted& wanted);
  [[nodiscard]] Texture average(const BandKey& key) const;

  Iris iris_;
  PupilMask mask_;
  double open_area_;  // stop radii
  struct Rung {       // one wavelength
    double extent = 0.0;
    std::vector<float> samples;
  };
  std::map<int, Rung> rungs_;
  std::map<BandKey, Texture> patterns_;
  std::map<int, Profile> profiles_;
  std::optional<FractionalFourier> fractional_;
  std::vector<std::complex<double>> analysis_;
  std::map<std::vector<double>, Texture> by_orders_;
  std::mutex bands_mutex_;
  std::map<std::vector<const PatternTexture*>, Band> bands_;
};

}  // namespace contrejour::screens
