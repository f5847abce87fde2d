// SPDX-License-Identifier: Apache-2.0
// The files of data/glasses, embedded in the library.
#include <iterator>
#include <vector>

#include "optics/glass/glass_line.h"

namespace contrejour::inline internal {
namespace {

// These are pointers, since compilers refuse to compute the length of such long texts in constant expressions.
struct Embedded {
  const char* name;
  const char* text;
};

// In alphabetical order; written by embed_text.cmake when the library is built.
constexpr Embedded kEmbedded[] = {
#include "bundled_glasses.inc"
};

// The makers in the order in which names are searched.
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

}  // namespace contrejour::inline internal
