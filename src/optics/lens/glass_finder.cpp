#include "optics/lens/glass_finder.h"

namespace contrejour {

Result<Glass> GlassFinder::find(std::string_view name, std::span<const std::string> makers) {
  if (auto coded = glass_of_code(name)) return std::move(*coded);
  Result<CatalogueEntry> found = failure(ErrorCode::InvalidArgument, "");
  if (own_ != nullptr) found = own_->find(name, makers);
  if (!found) {
    if (!bundled_) bundled_ = bundled_glasses();
    found = bundled_->find(name, makers);
  }
  if (!found) return tl::unexpected(found.error());
  found->glass.name = name;
  return std::move(found->glass);
}

}  // namespace contrejour
