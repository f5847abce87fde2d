// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/sequential/zmx_system.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/near_name.h"
#include "base/trimmed.h"
#include "base/units.h"
#include "optics/lens_files/sequential/design_text.h"

namespace contrejour::inline internal {
namespace {

void read_unit(const ZmxRow& row, SequentialDesign& design) {
  const std::string_view unit = row.size() > 1 ? row.word(1) : "MM";
  if (unit == "MM") return;
  if (unit == "CM") {
    design.unit_mm = 10.0;
  } else if (unit == "IN") {
    design.unit_mm = 25.4;
  } else if (unit == "METER" || unit == "M" || unit == "ME") {
    design.unit_mm = 1000.0;
  } else {
    row.fail(fmt::format("the unit '{}' is not known; MM, CM, IN and METER are", shortened(unit)));
  }
}

void set_aperture(DesignAperture kind, const ZmxRow& row, SequentialDesign& design) {
  design.aperture = kind;
  design.aperture_value = row.number(1);
  if (!(design.aperture_value > 0.0)) row.fail(fmt::format("{} is no size of an aperture", shortened(row.word(0))));
}

}  // namespace

void ZmxSystem::read(const ZmxRow& row, bool is_behind_surfaces, SequentialDesign& design) {
  if (row.is("MODE")) {
    if (row.word(1) == "NSC")
      row.fail("a non-sequential file; only sequential ones (MODE SEQ) are read", ErrorCode::Unsupported);
  } else if (row.is("UNIT")) {
    read_unit(row, design);
  } else if (row.is("NAME")) {
    design.name = std::string(trimmed(row.text().substr(row.text().find("NAME") + 4)));
  } else if (row.is("NOTE") && row.size() > 2 && row.word(1) == "0") {
    const auto begin = static_cast<std::size_t>(row.word(2).data() - row.text().data());
    if (notes_.size() < 1000) notes_ += (notes_.empty() ? "" : " ") + std::string(trimmed(row.text().substr(begin)));
  } else if (row.is("GCAT")) {
    for (std::size_t k = 1; k < row.size(); ++k) makers_.emplace_back(row.word(k));
  } else if (row.is("ENVD")) {
    if (row.whole(3) != 0 && (row.number(1) != 20.0 || row.number(2) != 1.0))
      design.warnings.push_back(
          fmt::format("indices at {:g} deg C and {:g} atm (line {}); those at 20 deg C and 1 atm are used",
                      row.number(1), row.number(2), row.line()));
  } else if (!is_behind_surfaces) {
    read_light(row, design);
  }
}

void ZmxSystem::read_light(const ZmxRow& row, SequentialDesign& design) {
  if (row.is("ENPD")) {
    set_aperture(DesignAperture::EntrancePupil, row, design);
  } else if (row.is("FNUM")) {
    set_aperture(row.whole(2) == 1 ? DesignAperture::WorkingFNumber : DesignAperture::FNumber, row, design);
  } else if (row.is("OBNA")) {
    set_aperture(DesignAperture::ObjectNA, row, design);
    if (row.whole(2) == 1) design.aperture_value = std::sin(rad_from_deg(design.aperture_value));  // a cone's
  } else if (row.is("FLOA")) {
    design.aperture = DesignAperture::ByStop;
  } else if (row.is("FTYP")) {
    field_type_ = row.whole(1);
    if (row.size() > 3) fields_ = row.whole(3);
  } else if (row.is_one_of({"XFLN", "YFLN", "XFLD", "YFLD"})) {
    auto& field = row.word(0)[0] == 'X' ? x_field_ : y_field_;
    for (std::size_t k = 1; k < row.size(); ++k) field.push_back(row.number(k));
  } else if (row.is_one_of({"WAVL", "WAVN"})) {
    for (std::size_t k = 1; k < row.size(); ++k) set_wavelength(static_cast<int>(k), row.number(k));
  } else if (row.is("WAVM")) {
    set_wavelength(row.whole(1), row.number(2));
  } else if (row.is("PWAV")) {
    primary_ = row.whole(1);
  }
}

void ZmxSystem::set_wavelength(int k, double um) {
  constexpr int kMaxWavelengths = 100;
  if (k < 1 || k > kMaxWavelengths) return;
  wavelengths_um_.resize(std::max(wavelengths_um_.size(), static_cast<std::size_t>(k)));
  wavelengths_um_[static_cast<std::size_t>(k) - 1] = um;
}

void ZmxSystem::finish(SequentialDesign& design) const {
  if (!notes_.empty()) design.source = cut_text(notes_);
  const std::size_t primary = static_cast<std::size_t>(std::max(primary_, 1)) - 1;
  if (primary < wavelengths_um_.size() && wavelengths_um_[primary] > 0.0)
    design.wavelength_nm = wavelengths_um_[primary] * 1e3;
  const std::size_t stated = std::max(x_field_.size(), y_field_.size());
  const std::size_t count = fields_ > 0 ? std::min(stated, static_cast<std::size_t>(fields_)) : stated;
  for (std::size_t k = 0; k < count; ++k)
    design.add_field(k < x_field_.size() ? x_field_[k] : 0.0, k < y_field_.size() ? y_field_[k] : 0.0);
  design.field = field_type_ == 1                       ? FieldKind::ObjectHeight
                 : field_type_ == 2 || field_type_ == 3 ? FieldKind::ImageHeight
                                                        : FieldKind::Angle_deg;
}

}  // namespace contrejour::inline internal
