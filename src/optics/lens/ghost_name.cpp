// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "contrejour/expert/ghost_id.h"

namespace contrejour {

std::string ghost_name(const Ghost& ghost) {
  std::string name = fmt::format("{}-{}", ghost.i, ghost.j);
  if (ghost.reflects_four_times()) name += fmt::format("-{}-{}", ghost.k, ghost.l);
  if (ghost.order != std::array{0, 0}) name += fmt::format("@{},{}", ghost.order[0], ghost.order[1]);
  return name;
}

}  // namespace contrejour
