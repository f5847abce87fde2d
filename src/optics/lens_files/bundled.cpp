// SPDX-License-Identifier: Apache-2.0
// The lenses of data/lenses, embedded in the library: a program that links it needs no files.
#include "contrejour/lens.h"

namespace contrejour {

namespace {

// In alphabetical order; written by embed_text.cmake when the library is built.
constexpr BundledLens kBundled[] = {
#include "bundled_lenses.inc"
};

}  // namespace

std::vector<BundledLens> bundled_lenses() { return {std::begin(kBundled), std::end(kBundled)}; }

}  // namespace contrejour
