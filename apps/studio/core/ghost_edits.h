// SPDX-License-Identifier: Apache-2.0
// Which ghosts a document shows, and at what gain, as the values --select and --ghost say it, so that the command line
// draws the same. Errors: InvalidArgument. Thread-safety: pure functions.
#pragma once

#include <optional>
#include <vector>

#include "contrejour/expert/ghost_id.h"
#include "contrejour/expert/ghost_options.h"
#include "studio/core/document.h"

namespace contrejour::studio {

[[nodiscard]] bool is_muted(const Document& document, const Ghost& ghost);
[[nodiscard]] bool is_solo(const Document& document, const Ghost& ghost);
[[nodiscard]] bool has_solo(const Document& document);
// Ghosts that are neither muted nor hidden by others that are solo, nor by the surface to which the document limits
// them.
class DrawnGhosts {
 public:
  explicit DrawnGhosts(const Document& document);
  [[nodiscard]] bool operator()(const Ghost& ghost) const;

 private:
  std::vector<Ghost> muted_, solo_;
  int surface_ = 0;  // 0: any
};
[[nodiscard]] bool is_drawn(const Document& document, const Ghost& ghost);
// The adjustment of this ghost alone, or one that changes nothing.
[[nodiscard]] GhostAdjustment adjustment_of(const Document& document, const Ghost& ghost);

[[nodiscard]] Result<Document> with_mute(Document document, const Ghost& ghost, bool muted);
// Ghosts that are solo are drawn, all others are not; no ghost solo: all are drawn.
[[nodiscard]] Result<Document> with_solo(Document document, const Ghost& ghost, bool solo);
[[nodiscard]] Result<Document> with_gain(Document document, const Ghost& ghost, double gain);
[[nodiscard]] Result<Document> with_tint(Document document, const Ghost& ghost, const Rgb& colour);
// Only ghosts that reflect at this surface (1-based) are drawn; if that is so already, all are.
[[nodiscard]] Result<Document> with_ghosts_of_surface(Document document, int surface);
[[nodiscard]] Document with_all_ghosts(Document document);

}  // namespace contrejour::studio
