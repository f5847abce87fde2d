// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "contrejour/expert/glass_catalogue.h"

namespace contrejour {

// A row of the catalogue. A bundled glass stays a line of text until it is needed.
struct GlassCatalogue::Row {
  GlassSummary summary;
  std::string key, maker_key;                   // in the form that names are compared in
  std::string_view line;                        // of a bundled file; or:
  std::shared_ptr<const CatalogueEntry> entry;  // of a user's
};

}  // namespace contrejour
