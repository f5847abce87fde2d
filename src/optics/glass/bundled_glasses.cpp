// The files of data/glasses, in the library itself.
#include <iterator>
#include <vector>

#include "optics/glass/glass_line.h"

namespace contrejour {
namespace {

// Pointers alone: to measure such texts while compiling is more than compilers will do.
struct Embedded {
  const char* name;
  const char* text;
};

// In alphabetical order; written by embed_text.cmake when the library is built.
constexpr Embedded kEmbedded[] = {
#include "bundled_glasses.inc"
};

// The makers in the order in which names are looked for.
constexpr std::string_view kOrder[] = {"schott", "ohara", "hoya", "hikari", "sumita", "cdgm", "misc"};
static_assert(std::size(kEmbedded) == std::size(kOrder),
              "a file of data/glasses is missing, or not in the order above");

}  // namespace

std::vector<BundledGlassFile> bundled_glass_files() {
  std::vector<BundledGlassFile> files;
  for (const std::string_view name : kOrder)
    for (const Embedded& file : kEmbedded)
      if (file.name == name) files.push_back({file.name, file.text});
  return files;
}

std::string maker_of_bundled(std::string_view file_name) {
  std::string maker(file_name);
  for (char& c : maker) c = static_cast<char>(c - 'a' + 'A');
  return maker;
}

}  // namespace contrejour
