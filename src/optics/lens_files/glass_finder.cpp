// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/glass_finder.h"

#include <cctype>

namespace contrejour::inline internal {
namespace {

// Translates names, in capitals, of materials in design programs' catalogues to those of the bundled catalogue.
std::string_view usual_name(std::string_view name) {
  struct Named {
    std::string_view theirs, ours;
  };
  constexpr Named kNames[] = {
      {"F_SILICA", "SILICA"}, {"FUSED_SILICA", "SILICA"}, {"F-SILICA", "SILICA"},        {"UVFS", "SILICA"},
      {"SIO2", "SILICA"},     {"C79-80", "SILICA"},       {"HPFS7980", "SILICA"},        {"SUPRASIL", "SILICA"},
      {"HOMOSIL", "SILICA"},  {"D263T", "D263TECO"},      {"POLYCARBONATE", "POLYCARB"}, {"POLYSTYRENE", "POLYSTYR"}};
  std::string upper(name.substr(0, 32));
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  for (const Named& known : kNames)
    if (known.theirs == upper) return known.ours;
  return name;
}

}  // namespace

Result<Glass> GlassFinder::find(std::string_view name, std::span<const std::string> makers) {
  std::string key(name);
  for (const std::string& maker : makers) key += '\n' + maker;
  const auto known = found_.find(key);
  if (known != found_.end()) return known->second;
  return found_.emplace(std::move(key), look_for(name, makers)).first->second;
}

Result<Glass> GlassFinder::look_for(std::string_view name, std::span<const std::string> makers) {
  if (auto coded = glass_of_code(name)) return std::move(*coded);
  Result<CatalogueEntry> found = failure(ErrorCode::InvalidArgument, "");
  if (own_ != nullptr) found = own_->find(name, makers);
  if (!found) {
    found = bundled_glasses().find(name, makers);
    if (const auto usual = usual_name(name); !found && usual != name) found = bundled_glasses().find(usual, makers);
  }
  if (!found) return tl::unexpected(found.error());
  found->glass.name = name;
  return std::move(found->glass);
}

}  // namespace contrejour::inline internal
