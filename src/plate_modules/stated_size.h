// SPDX-License-Identifier: Apache-2.0
// The sizes that a file states, read before it is opened, so that a few bytes that claim much memory are refused first:
// OpenImageIO allocates some of it while it opens a file. Thread-safety: pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace contrejour::inline internal {

struct StatedSize {
  int width = 0, height = 0, channels = 0;
};

// The size in a JPEG's frame header (ITU-T T.81, B.2.2), for which libjpeg allocates all coefficients of a progressive
// file. Null: there is no frame.
[[nodiscard]] std::optional<StatedSize> stated_jpeg_size(std::span<const std::byte> bytes);

// True if a DPX claims more user data than the file has bytes (SMPTE 268M-2003, field 7).
[[nodiscard]] bool claims_too_much_user_data(std::span<const std::byte> dpx);

}  // namespace contrejour::inline internal
