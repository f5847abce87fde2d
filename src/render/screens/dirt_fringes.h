// Dirt as ghosts see it out of focus: planes of shadows with fringes by wavelength times effective distance, kept as
// long as the dirt is the same, and one ghost's view of them.
// Thread-safety: make() from one thread; all else from any, afterwards.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/dirt.h"
#include "render/interface/dirt_field.h"
#include "render/screens/fringed_plane.h"

namespace contrejour::screens {

// A ghost's view at one wavelength, or a band.
class FringedDirt final : public DirtScreen {
 public:
  // crossings: the plane at each crossing of the stop, or the front's; null ones are sharp.
  FringedDirt(std::shared_ptr<const DirtField> sharp, std::vector<std::shared_ptr<const FringedPlane>> crossings);

  [[nodiscard]] double level() const override { return level_; }
  using DirtScreen::transmission;
  [[nodiscard]] double transmission(const DirtPlace& place, std::size_t crossing) const override;
  [[nodiscard]] bool is_clean(Vec2 middle_mm, double radius_mm, std::size_t crossing) const override;
  [[nodiscard]] Edges edges() const override;

 private:
  std::shared_ptr<const DirtField> sharp_;
  std::vector<std::shared_ptr<const FringedPlane>> crossings_;
  double level_ = 1.0;
};

class DirtFringes {
 public:
  struct Wanted {
    double lambda_z_mm2 = 1.0;  // at the band's middle
    double spread = 0.0;  // of its wavelengths over that, root mean square
  };

  // Starts anew if the dirt or its plane is another.
  void use(const Dirt& dirt, const DirtField& field);
  // Makes what is not there yet, on all threads. False when cancelled.
  bool make(const DirtField& field, std::span<const Wanted> wanted, const Context& context);
  [[nodiscard]] std::shared_ptr<const FringedPlane> plane(const Wanted& wanted) const;  // null unless made
  [[nodiscard]] std::size_t count() const { return planes_.size(); }

 private:
  struct Key {
    int rung = 0, spread = 0;
    friend auto operator<=>(const Key&, const Key&) = default;
  };
  [[nodiscard]] static Key key_of(const Wanted& wanted);

  std::optional<std::pair<Dirt, double>> of_;  // and the plane's extent
  std::map<int, std::shared_ptr<const StraightEdge>> edges_;  // by spread
  std::map<Key, std::shared_ptr<const FringedPlane>> planes_;
};

}  // namespace contrejour::screens
