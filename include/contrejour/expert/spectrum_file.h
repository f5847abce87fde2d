// SPDX-License-Identifier: Apache-2.0
// Spectra as files: each line has a wavelength in nm and a power, separated by a comma, semicolon, tab or spaces, with
// rising wavelengths; `#` begins a comment, one line of headings may come first (docs/formats/spectrum.md).
// Bounded in memory and time. Errors: Parse with file and line, Io. Thread-safety: pure functions.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/expert/colour.h"
#include "contrejour/export.h"

namespace contrejour {

[[nodiscard]] CONTREJOUR_API Result<TabulatedSpectrum> read_spectrum(std::string_view text, const std::string& file);
[[nodiscard]] CONTREJOUR_API Result<TabulatedSpectrum> read_spectrum(const std::filesystem::path& file);
[[nodiscard]] CONTREJOUR_API std::string write_spectrum(const TabulatedSpectrum& spectrum);  // reads back as the same

// Lamps that come with the library: "led", "sodium", ...
struct BundledSpectrum {
  std::string_view name;
  std::string_view what;  // one line
};
[[nodiscard]] CONTREJOUR_API std::vector<BundledSpectrum> bundled_spectra();

// Finds a spectrum that parse_spectrum knows, a bundled lamp, or a file: a name with a dot or a slash is a file.
// Errors: those of reading; InvalidArgument for any other name.
[[nodiscard]] CONTREJOUR_API Result<Spectrum> find_spectrum(const std::string& name_or_file);

}  // namespace contrejour
