// SPDX-License-Identifier: Apache-2.0
// The lamps that come with the library, by name: docs/physics/colour.md.
#include <algorithm>
#include <iterator>
#include <memory>
#include <span>

#include <fmt/format.h>

#include "contrejour/expert/spectrum_file.h"
#include "image/lamp_tables.h"

namespace contrejour {
namespace {

TabulatedSpectrum table_of(std::vector<SpectrumPoint> points) {
  return {std::make_shared<const std::vector<SpectrumPoint>>(std::move(points))};
}

TabulatedSpectrum table_of(const std::array<double, cie::kLampCount>& power) {
  std::vector<SpectrumPoint> points;
  for (int k = 0; k < cie::kLampCount; ++k)
    points.push_back({cie::kLampFirstNm + k * cie::kLampStepNm, power[static_cast<std::size_t>(k)]});
  return table_of(std::move(points));
}

// A low pressure sodium lamp is its D lines: 588.9950 and 589.5924 nm in air (NIST Atomic Spectra Database, Na I). In
// thin vapour the first is twice the second (the ratio of their oscillator strengths, 0.641 and 0.320); a lamp's is
// thick, which makes them nearly equal, so they are taken as equal. Each is 0.2 nm wide at its base.
TabulatedSpectrum low_pressure_sodium() {
  std::vector<SpectrumPoint> points;
  for (const double line_nm : {588.9950, 589.5924}) {
    points.push_back({line_nm - 0.1, 0.0});
    points.push_back({line_nm, 1.0});
    points.push_back({line_nm + 0.1, 0.0});
  }
  return table_of(std::move(points));
}

struct Lamp {
  BundledSpectrum name;
  TabulatedSpectrum (*make)();
};

const Lamp kLamps[] = {
    {{"fluorescent", "cool white fluorescent lamp, CIE FL2"}, [] { return table_of(cie::kFluorescentFl2); }},
    {{"fluorescent-narrow", "fluorescent lamp of three narrow bands, CIE FL11"},
     [] { return table_of(cie::kFluorescentFl11); }},
    {{"led", "white LED of a blue chip and phosphor, CIE LED-B3"}, [] { return table_of(cie::kLedB3); }},
    {{"sodium", "high pressure sodium lamp, CIE HP1"}, [] { return table_of(cie::kSodiumHp1); }},
    {{"sodium-low", "low pressure sodium lamp: its two D lines"}, low_pressure_sodium},
};

}  // namespace

std::vector<BundledSpectrum> bundled_spectra() {
  std::vector<BundledSpectrum> all;
  for (const Lamp& lamp : kLamps) all.push_back(lamp.name);
  return all;
}

Result<Spectrum> find_spectrum(const std::string& name_or_file) {
  for (const Lamp& lamp : kLamps) {
    if (lamp.name.name == name_or_file) return Spectrum(lamp.make());
  }
  auto named = parse_spectrum(name_or_file);
  if (named || name_or_file.find_first_of("./\\") == std::string::npos) return named;
  auto read = read_spectrum(std::filesystem::path(name_or_file));
  if (!read) return tl::unexpected(read.error());
  return Spectrum(std::move(*read));
}

}  // namespace contrejour
