// SPDX-License-Identifier: Apache-2.0
// Declarations that the readers of lens files share.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "contrejour/lens.h"

namespace contrejour::inline internal {

// The largest real prescriptions take a few kB; the limit bounds the cost of hostile files.
inline constexpr std::size_t kMaxLensFileBytes = 1'000'000;

// The input of a reader.
struct LensText {
  std::string_view text;  // UTF-8, whatever the file's encoding
  std::string file;       // names it in errors
  const GlassCatalogue* glasses = nullptr;  // the user's own, if any
  std::string key = {};  // of a file with many lenses, which one
};

// For each format other than ours: the test that recognises its files, and its reader.
[[nodiscard]] bool looks_like_optical_bench(std::string_view text);
[[nodiscard]] Result<Prescription> read_optical_bench(const LensText& in);

[[nodiscard]] bool looks_like_zmx(std::string_view text);
[[nodiscard]] Result<Prescription> read_zmx(const LensText& in);

[[nodiscard]] bool looks_like_seq(std::string_view text);
[[nodiscard]] Result<Prescription> read_seq(const LensText& in);

[[nodiscard]] bool looks_like_pbrt(std::string_view text);
[[nodiscard]] Result<Prescription> read_pbrt(const LensText& in);

// JSON formats of several programs (json_lens.h).
[[nodiscard]] bool looks_like_json(std::string_view text);
[[nodiscard]] Result<Prescription> read_json_lens(const LensText& in);

// The format of OpenLensFlare and the LensFlareFramework.
[[nodiscard]] bool looks_like_lens_xml(std::string_view text);
[[nodiscard]] Result<Prescription> read_lens_xml(const LensText& in);

[[nodiscard]] bool looks_like_flaresim(std::string_view text);
[[nodiscard]] Result<Prescription> read_flaresim(const LensText& in);

}  // namespace contrejour::inline internal
