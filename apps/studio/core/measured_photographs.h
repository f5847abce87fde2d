// SPDX-License-Identifier: Apache-2.0
// The photographs of a sweep in the pictures of a measured flare's panel: they are read one after the other, and kept
// in the panel's size. Errors: those of MeasuredSweep and render_measured(). Thread-safety: one thread at a time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "studio/core/measured_halo.h"
#include "studio/core/measured_sweep.h"
#include "studio/core/measured_view.h"

namespace contrejour::studio {

class MeasuredPhotographs {
 public:
  // Whether the sweep is open.
  [[nodiscard]] bool are_of(const std::string& folder) const { return sweep_ && sweep_->folder() == folder; }
  // Adds the photograph nearest to the order's angle to the answer, whose flare is known.
  [[nodiscard]] Result<void> show(const MeasuredOrder& order, double stops, MeasuredAnswer& answer,
                                  const Context& context);
  // Reads some more stations, for the kymograph of the answer and for the halo that is left out of its residual. False:
  // there are none left.
  [[nodiscard]] bool read_next(MeasuredAnswer& answer, const Context& context);

 private:
  static constexpr std::size_t kMostPictures = 256;  // 1 MB each with its residual
  static constexpr std::size_t kReadAtOnce = 4;

  struct Station {
    bool is_read = false;
    std::optional<Image> row, picture;  // the picture of a short sweep only; none: it cannot be read
    std::optional<Image> residual;  // with its halo
    RingLevels rings;  // of the residual
  };
  [[nodiscard]] Result<void> open(const MeasuredOrder& order, const MeasuredAnswer& answer);
  [[nodiscard]] Result<Image> read(std::size_t station);
  [[nodiscard]] Result<Image> fit(std::size_t station, const MeasuredFlare& flare, const Context& context) const;
  void compare(std::size_t station, const Image& captured, const Image& fitted);
  [[nodiscard]] Vec2 light_px(std::size_t station) const;
  void draw_residual(MeasuredAnswer& answer) const;
  void draw_kymograph(MeasuredAnswer& answer);

  std::optional<MeasuredSweep> sweep_;
  std::string flare_file_;  // in whose frame the pictures are
  double half_width_ = 0, stops_ = 0;
  std::vector<Station> stations_;
  Image shown_;  // the photograph of the last answer
};

}  // namespace contrejour::studio
