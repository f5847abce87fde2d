// SPDX-License-Identifier: Apache-2.0
// Plates that are sequences: their file is a pattern ("plate.####.exr", frame_pattern.h), unless a file has exactly
// this name, as for `contrejour apply`. Errors: those of frame_pattern.h. Thread-safety: pure functions, but for the
// disk.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "contrejour/expert/session.h"
#include "contrejour/result.h"

namespace contrejour::studio {

[[nodiscard]] bool is_plate_sequence(const std::string& file);

// The plate of one frame: that frame's file of a sequence; any other plate as it is.
[[nodiscard]] SessionPlate plate_at(const SessionPlate& plate, int frame);

// The frames whose files exist, in rising order; empty for a plate that is no sequence.
[[nodiscard]] Result<std::vector<int>> frames_of_plate(const SessionPlate& plate);

// The frames from first to last that are not among `present`, which rises.
[[nodiscard]] std::vector<int> missing_frames(const std::vector<int>& present, int first, int last);

// The sequence that a file with a number before its extension belongs to, by its pattern. None where no other file has
// the same name with another number.
[[nodiscard]] std::optional<std::string> sequence_of_file(const std::filesystem::path& file);

}  // namespace contrejour::studio
