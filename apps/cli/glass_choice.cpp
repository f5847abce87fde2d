// SPDX-License-Identifier: Apache-2.0
#include "cli/glass_choice.h"

#include <algorithm>
#include <cstdlib>

#include "cli/console.h"

namespace contrejour::cli {
namespace {

#ifdef _WIN32
constexpr char kPathSeparator = ';';
#else
constexpr char kPathSeparator = ':';
#endif

std::vector<std::string> environment_paths() {
  std::vector<std::string> paths;
  const char* value = std::getenv("CONTREJOUR_GLASS_PATH");
  std::string rest = value == nullptr ? "" : value;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(kPathSeparator), rest.size());
    if (end > 0) paths.push_back(rest.substr(0, end));
    rest.erase(0, std::min(end + 1, rest.size()));
  }
  return paths;
}

}  // namespace

void add_catalogue_option(CLI::App& command, std::vector<std::string>& paths) {
  command
      .add_option("--catalogue", paths,
                  "your own catalogue: an .agf file, a .yml file of refractiveindex.info, or a folder of these")
      ->option_text("PATH");
}

Result<GlassCatalogue> own_glasses(const std::vector<std::string>& paths) {
  std::vector<std::string> all = paths;
  for (std::string& path : environment_paths()) all.push_back(std::move(path));
  GlassCatalogue glasses;
  for (const std::string& path : all) {
    const auto warnings = glasses.add_path(path);
    if (!warnings) return tl::unexpected(warnings.error());
    print_warnings(*warnings);
  }
  return glasses;
}

Result<GlassCatalogue> all_glasses(const std::vector<std::string>& paths) {
  auto glasses = own_glasses(paths);
  if (glasses) glasses->add(bundled_glasses());
  return glasses;
}

}  // namespace contrejour::cli
