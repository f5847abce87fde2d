// Glasses by the names that lens files give them.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "contrejour/glass_catalogue.h"

namespace contrejour {

// One for the reading of one file: each name is looked for once.
class GlassFinder {
 public:
  explicit GlassFinder(const GlassCatalogue* own = nullptr) : own_(own) {}

  // A six-digit code, a glass of the caller's own catalogue, a bundled one; named as asked for. makers: see
  // GlassCatalogue::find. A few names that other programs give to materials (F_SILICA) stand for ours. Errors:
  // InvalidArgument, naming the nearest.
  [[nodiscard]] Result<Glass> find(std::string_view name, std::span<const std::string> makers = {});

 private:
  [[nodiscard]] Result<Glass> look_for(std::string_view name, std::span<const std::string> makers);

  const GlassCatalogue* own_;
  std::map<std::string, Result<Glass>> found_;  // by name and makers
};

}  // namespace contrejour
