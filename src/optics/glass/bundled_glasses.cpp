// The files of data/glasses, in the library itself.
#include <array>

#include "optics/glass/glass_line.h"

namespace contrejour {
namespace {

// In alphabetical order; written by embed_text.cmake when the library is built.
constexpr BundledGlassFile kEmbedded[] = {
#include "bundled_glasses.inc"
};

// The makers in the order in which names are looked for.
constexpr std::string_view kOrder[] = {"schott", "ohara", "hoya", "hikari", "sumita", "cdgm", "misc"};

constexpr auto in_order() {
  std::array<BundledGlassFile, std::size(kOrder)> files{};
  for (std::size_t k = 0; k < files.size(); ++k)
    for (const BundledGlassFile& file : kEmbedded)
      if (file.name == kOrder[k]) files[k] = file;
  return files;
}
constexpr auto kFiles = in_order();
static_assert(std::size(kEmbedded) == std::size(kOrder), "a file of data/glasses is missing, or not in the order above");

}  // namespace

std::span<const BundledGlassFile> bundled_glass_files() { return kFiles; }

std::string maker_of_bundled(std::string_view file_name) {
  std::string maker(file_name);
  for (char& c : maker) c = static_cast<char>(c - 'a' + 'A');
  return maker;
}

}  // namespace contrejour
