// The fringes along an iris's edges for the wavelengths that are drawn together, as one table for all channels: what
// adaptive looks up pixel by pixel. Differs: where two edges meet, the channels' means multiply, not each wavelength's.
#pragma once

#include <array>
#include <vector>

#include "render/adaptive/polygon_screen.h"
#include "render/screens/iris_screens.h"

namespace contrejour::adaptive {

class EdgeTable {
 public:
  using Rgb = std::array<float, 3>;

  // band: of edges' fringes, which must outlive the table. width: of a pixel, stop radii.
  EdgeTable(const BandScreen& band, double width);

  [[nodiscard]] const IrisShape& iris() const { return *iris_; }
  [[nodiscard]] double dark_beyond() const { return dark_beyond_; }  // distance outside a bound, stop radii
  [[nodiscard]] double level_within() const { return level_within_; }  // and inside

  // Takes the factor that a bound brings at a signed distance from it into `share`.
  void apply(double distance, Rgb& share) const {
    if (distance <= -level_within_) return;
    const double place = (dark_beyond_ - distance) * per_step_;
    if (!(place > 0.0)) return share.fill(0.0F);
    const auto at = static_cast<std::size_t>(place);
    const auto t = static_cast<float>(place - static_cast<double>(at));
    const Rgb& a = value_[at];
    const Rgb& b = value_[at + 1];
    for (std::size_t c = 0; c < 3; ++c) share[c] *= a[c] + t * (b[c] - a[c]);
  }

 private:
  const IrisShape* iris_;
  double dark_beyond_, level_within_, per_step_;
  std::vector<Rgb> value_;
};

}  // namespace contrejour::adaptive
