// SPDX-License-Identifier: Apache-2.0
// Any bytes as a measured flare: what is read passes its own check, is written as the same text, has ghosts of finite
// size at every angle, and renders.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>

#include "contrejour/expert/measured_flare.h"

namespace {

using namespace contrejour;

constexpr std::size_t kMaxDrawn = 16;  // ghosts, since a picture takes as long as its ghosts are many

void demand(bool holds) {
  if (!holds) std::abort();
}

void check_ghost(const MeasuredGhost& ghost, double s, double s_max) {
  const auto at = ghost_at(ghost, s, s_max);
  if (!at) return;
  demand(at->outline.left > 0.0 && at->outline.right > 0.0 && at->outline.half_height > 0.0);
  demand(at->shade.fade_in >= 0.0 && at->shade.fade_out >= 0.0);
  for (std::size_t c = 0; c < at->border.size(); ++c) demand(at->border[c] >= 0.0 && at->inside[c] >= 0.0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  auto flare = read_flare(text, "fuzz.flare.toml");
  if (!flare) return 0;
  demand(check_flare(*flare).has_value());
  const std::string written = write_flare(*flare);
  const auto again = read_flare(written, "again.flare.toml");
  demand(again.has_value() && write_flare(*again) == written);
  for (const double fraction : {0.0, 0.3, 1.0}) {
    for (const MeasuredGhost& ghost : flare->ghosts) check_ghost(ghost, fraction * flare->s_max, flare->s_max);
  }
  if (flare->ghosts.size() > kMaxDrawn) flare->ghosts.resize(kMaxDrawn);
  const FlareLight light{{0.3 * flare->s_max, 0.2 * flare->s_max}, {1.0, 1.0, 1.0}};
  demand(render_measured(*flare, std::span(&light, 1), {24, 16, 20.0, {12.0, 8.0}}, {.threads = 1}).has_value());
  return 0;
}
