// SPDX-License-Identifier: Apache-2.0
// Glasses by the names that lens files give them.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "contrejour/expert/glass_catalogue.h"

namespace contrejour::inline internal {

// Serves the reading of one file: each name is searched once.
class GlassFinder {
 public:
  explicit GlassFinder(const GlassCatalogue* own = nullptr) : own_(own) {}

  // Finds a six-digit code, a glass of the caller's catalogue, or a bundled one; the result keeps the name given.
  // makers: see GlassCatalogue::find. A few names of materials in other programs (F_SILICA) are translated. Errors:
  // InvalidArgument, naming the nearest.
  [[nodiscard]] Result<Glass> find(std::string_view name, std::span<const std::string> makers = {});

 private:
  [[nodiscard]] Result<Glass> look_for(std::string_view name, std::span<const std::string> makers);

  const GlassCatalogue* own_;
  std::map<std::string, Result<Glass>> found_;  // by name and makers
};

}  // namespace contrejour::inline internal
