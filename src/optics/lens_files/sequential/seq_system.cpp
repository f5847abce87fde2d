// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/sequential/seq_system.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "base/near_name.h"
#include "base/trimmed.h"
#include "optics/lens_files/plain_number.h"
#include "optics/lens_files/sequential/design_text.h"

namespace contrejour::inline internal {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : " ") + word;
  while (!out.empty() && out.back() == ' ') out.pop_back();
  return cut_text(out);
}

void read_unit(const SeqCommand& command, SequentialDesign& design, FirstError& errors) {
  const std::string unit = capitals(command.word(0));
  if (unit == "C" || unit == "CM") {
    design.unit_mm = 10.0;
  } else if (unit.starts_with("I")) {
    design.unit_mm = 25.4;
  } else if (unit != "M" && unit != "MM") {
    errors.fail(command.line, fmt::format("the unit '{}' is not known; M, C and I are", shortened(unit)));
  }
}

void set_aperture(const SeqCommand& command, DesignAperture kind, SequentialDesign& design, FirstError& errors) {
  design.aperture = kind;
  design.aperture_value = seq_number(command, 0, errors);
  if (!(design.aperture_value > 0.0))
    errors.fail(command.line, fmt::format("{} is no size of an aperture", shortened(command.name)));
}

}  // namespace

bool seq_is_passed_over(std::string_view name) {
  static const std::set<std::string_view> kNames = {
      "LEN", "INI", "WTW", "WTF", "WTX", "WTY", "VUX", "VLX", "VUY", "VLY", "CCY", "CCX", "THC", "CCF", "SLB",
      "DER", "CLS", "POL", "CA",  "GO",  "AC",  "BC",  "CC",  "DC",  "EC",  "FC",  "GC",  "HC",  "JC",  "KC",
      "GLC", "XDC", "YDC", "ZDC", "ADC", "BDC", "CDC", "CUM", "THM", "VER", "IC",  "SAV", "END", "OUT", "CMT",
      "COM", "REM", "DDM", "TOL", "DLT", "DLF", "DLR", "DLN", "DLV", "DLX", "DLY", "DLZ", "TIR", "CYD", "BTI",
      "CPO", "LIS", "VIE", "DRA", "RSI", "LIB", "VIG", "HMY", "UMY", "HMX", "UMX", "IMY", "ICY", "CWT", "WTA",
      "LAB", "FFD", "RAY", "BUF", "EVA", "WRI", "CAN", "FVR", "SET", "MNT", "MXT", "EFX", "CTX", "MTF", "SPO",
      "RIM", "AUT", "EFL", "UID", "DOR", "CMP", "DSX", "DSY", "BTX", "BTY", "PUX", "PUY", "PUI", "EXI", "RED"};
  return kNames.contains(name);
}

double seq_number(const SeqCommand& command, std::size_t k, FirstError& errors) {
  const auto value = plain_number(command.word(k));
  if (!value)
    errors.fail(command.line, fmt::format("'{}' of {} is no number", shortened(command.word(k)), command.name));
  return value.value_or(0.0);
}

bool SeqSystem::read(const SeqCommand& command, SequentialDesign& design, FirstError& errors) {
  if (command.name == "RDM") {
    const std::string mode = capitals(command.word(0));
    radius_mode_ = mode.empty() || mode[0] == 'Y' ? RadiusMode::Radius : RadiusMode::Curvature;
  } else if (command.name == "TIT") {
    if (design.name.empty()) design.name = trimmed(joined(command.words), " '\"");
  } else if (command.name == "DIM") {
    read_unit(command, design, errors);
  } else if (command.name == "TEM") {
    if (seq_number(command, 0, errors) != 20.0)
      design.warnings.push_back(fmt::format("indices at {:g} deg C (line {}); those at 20 deg C are used",
                                            seq_number(command, 0, errors), command.line));
  } else if (command.name == "PRE") {
    if (seq_number(command, 0, errors) != 760.0)
      design.warnings.push_back(
          fmt::format("the pressure of the air (line {}) is left out; indices are those at 1 atm", command.line));
  } else if (command.name == "AFI") {
    design.warnings.push_back(fmt::format("an afocal system (line {}); the sensor is put in focus", command.line));
  } else {
    return read_light(command, design, errors);
  }
  return true;
}

bool SeqSystem::read_light(const SeqCommand& command, SequentialDesign& design, FirstError& errors) {
  const std::string& name = command.name;
  if (name == "EPD") {
    set_aperture(command, DesignAperture::EntrancePupil, design, errors);
  } else if (name == "FNO") {
    set_aperture(command, DesignAperture::WorkingFNumber, design, errors);
  } else if (name == "NA") {
    set_aperture(command, DesignAperture::WorkingFNumber, design, errors);
    if (!errors.first) design.aperture_value = 0.5 / design.aperture_value;
  } else if (name == "NAO") {
    set_aperture(command, DesignAperture::ObjectNA, design, errors);
  } else if (name == "WL") {
    wavelengths_nm_.clear();
    for (std::size_t k = 0; k < command.words.size(); ++k) wavelengths_nm_.push_back(seq_number(command, k, errors));
  } else if (name == "REF") {
    reference_ = static_cast<int>(std::clamp(seq_number(command, 0, errors), 0.0, 1e3));
  } else {
    return read_field(command, design, errors);
  }
  return true;
}

// XAN 0 10 14, or YAN F2 10.
bool SeqSystem::read_field(const SeqCommand& command, SequentialDesign& design, FirstError& errors) {
  if (command.name.size() != 3 || (command.name[0] != 'X' && command.name[0] != 'Y')) return false;
  const std::string kind = command.name.substr(1);
  if (kind != "AN" && kind != "OB" && kind != "IM" && kind != "RI") return false;
  design.field = kind == "AN" ? FieldKind::Angle_deg : kind == "OB" ? FieldKind::ObjectHeight : FieldKind::ImageHeight;
  auto& values = fields_[command.name];
  const std::string_view first = command.word(0);
  if (first.size() > 1 && (first[0] == 'F' || first[0] == 'f')) {
    const auto k = static_cast<std::size_t>(std::clamp(plain_number(first.substr(1)).value_or(0.0), 1.0, 100.0));
    values.resize(std::max(values.size(), k));
    values[k - 1] = seq_number(command, 1, errors);
  } else {
    values.clear();
    for (std::size_t k = 0; k < command.words.size(); ++k) values.push_back(seq_number(command, k, errors));
  }
  return true;
}

void SeqSystem::finish(SequentialDesign& design) const {
  const std::size_t reference = reference_ > 0 ? static_cast<std::size_t>(reference_) - 1 : wavelengths_nm_.size() / 2;
  if (reference < wavelengths_nm_.size()) design.wavelength_nm = wavelengths_nm_[reference];
  std::size_t count = 0;
  for (const auto& [name, values] : fields_) count = std::max(count, values.size());
  for (std::size_t k = 0; k < count; ++k) {
    double x = 0.0, y = 0.0;
    for (const auto& [name, values] : fields_)
      if (k < values.size()) (name[0] == 'X' ? x : y) = values[k];
    design.add_field(x, y);
  }
}

}  // namespace contrejour::inline internal
