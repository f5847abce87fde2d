// What RingingPatterns holds: patterns by Fresnel number on a ladder, by band of wavelengths, by fractional order.
#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/fractional_fourier.h"
#include "contrejour/pupil_mask.h"
#include "contrejour/ringing.h"
#include "render/screens/band_pattern.h"
#include "render/screens/dirt_fringes.h"
#include "render/screens/edge_profile.h"
#include "render/screens/pattern_texture.h"

namespace contrejour {

struct RingingPatterns::Contents {
 public:
  using Texture = std::shared_ptr<const screens::PatternTexture>;
  using Profile = std::shared_ptr<const screens::EdgeProfile>;
  using Band = std::shared_ptr<const screens::BandPattern>;

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

  // Starts anew if the iris is another. All of the below are for this iris.
  void use(const Iris& iris);
  // Makes what is not there yet, on all threads. False when cancelled.
  bool make(std::span<const Wanted> wanted, const Context& context);
  [[nodiscard]] Texture pattern(const Wanted& wanted) const;  // null unless made
  [[nodiscard]] Profile profile(double spread);
  // |F^order U|^2, the mean over some orders. Null when cancelled.
  [[nodiscard]] Texture fractional(std::span<const double> orders, const Context& context);

  // Some of the textures above as one, made when first asked for. Any thread may ask, as long as no pattern is made.
  [[nodiscard]] Band band(std::span<const screens::PatternTexture* const> parts);

  [[nodiscard]] std::size_t count() const;

  screens::DirtFringes dirt;

  std::mutex& mutex() { return mutex_; }

 private:
  struct Key {
    int rung = 0, spread = 0;
    friend auto operator<=>(const Key&, const Key&) = default;
  };
  [[nodiscard]] static Key key_of(const Wanted& wanted);
  [[nodiscard]] Texture average(const Key& key) const;

  std::mutex mutex_;
  Iris iris_;
  std::optional<PupilMask> mask_;
  double open_area_ = 0.0;      // stop radii
  struct Rung {  // one wavelength
    double extent = 0.0;
    std::vector<float> samples;
  };
  std::map<int, Rung> rungs_;
  std::map<Key, Texture> patterns_;  // bands
  std::map<int, Profile> profiles_;
  std::optional<FractionalFourier> fractional_;
  std::vector<std::complex<double>> analysis_;
  std::map<std::vector<double>, Texture> by_orders_;
  std::mutex bands_mutex_;
  std::map<std::vector<const screens::PatternTexture*>, Band> bands_;
};

}  // namespace contrejour
