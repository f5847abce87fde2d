// SPDX-License-Identifier: Apache-2.0
// A camera's exposure from a file: a mosaic in a PNG or TIFF of 16 bits or an EXR of one channel, or a maker's RAW file
// through LibRaw where the program is built with it.
#pragma once

#include <optional>
#include <string>

#include "contrejour/expert/capture.h"

namespace contrejour::cli {

// Facts that a RAW file states and a picture file does not.
struct MosaicFormat {
  BayerPattern pattern = BayerPattern::Rggb;
  std::optional<double> black_dn, white_dn;  // otherwise 0 and the type's largest value, or the RAW file's
};

[[nodiscard]] bool reads_raw_files();

// time_s: of the list; a RAW file's own time must agree to a fifth, since cameras round the times that they state.
// Errors: Io, Parse, Unsupported, InvalidArgument, with the file as place.
[[nodiscard]] Result<RawFrame> read_raw_frame(const std::string& file, const MosaicFormat& format, double time_s);

}  // namespace contrejour::cli
