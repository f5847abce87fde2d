// SPDX-License-Identifier: Apache-2.0
// Drafts of many lights while few of them move. A flare is the sum of its lights' flares: what the lights that stand
// still have together is drawn once and kept, and each draft draws only the others. A kept flare is of one lens and one
// key, a text of all else that decides a flare but the lights. Thread-safety: none; by one thread.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "contrejour/expert/parameter_values.h"
#include "contrejour/expert/requests.h"

namespace contrejour::studio {

using DrawFlare = std::function<Result<Flare>(const PictureRequest& request)>;

class StillLights {
 public:
  // The flare of the request. Statistics are those of the lights that moved since the call before, or of all. Errors:
  // those of `draw`.
  [[nodiscard]] Result<Flare> draw(const PictureRequest& request, const std::string& key, const DrawFlare& draw);
  void forget() { *this = StillLights(); }  // the lens is another one
  // The time that drawing the lights that stand still took, in ms; 0: none are kept. drawn_time_ms: that within the
  // last call.
  [[nodiscard]] double kept_time_ms() const { return kept_ ? kept_time_ms_ : 0.0; }
  [[nodiscard]] double drawn_time_ms() const { return were_drawn_ ? kept_time_ms() : 0.0; }

 private:
  [[nodiscard]] Result<void> keep(const PictureRequest& request, std::vector<Light> lights, const DrawFlare& draw);

  std::string key_;
  std::vector<Light> before_;  // all of the call before
  std::vector<Light> still_;
  std::optional<Image> kept_;  // the flare of still_
  double kept_time_ms_ = 0.0;
  bool were_drawn_ = false;
};

// A text of all values but those of lights, for the key.
[[nodiscard]] std::string key_without_lights(const params::Values& values);

}  // namespace contrejour::studio
