// SPDX-License-Identifier: Apache-2.0
// Sequential lens files of Zemax (docs/formats/zemax.md): a keyword a line, surfaces in SURF blocks.
#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/near_name.h"
#include "optics/lens_files/read_lens.h"
#include "optics/lens_files/sequential/sequential_design.h"
#include "optics/lens_files/sequential/zmx_block.h"
#include "optics/lens_files/sequential/zmx_surface.h"
#include "optics/lens_files/sequential/zmx_system.h"
#include "optics/lens_files/sequential/zmx_zoom.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kMaxZmxSurfaces = 1000;

class ZmxReader {
 public:
  explicit ZmxReader(const LensText& in)
      : errors_{in.file, {}}, finder_(in.glasses), design_(design_from("Zemax", in.file)) {
    read_rows(in.text);
  }

  [[nodiscard]] Result<Prescription> read() {
    system_.finish(design_);
    warn_of_blocks();
    make_surfaces();
    if (errors_.first) return tl::unexpected(*errors_.first);
    return prescription_of(design_);
  }

 private:
  void read_rows(std::string_view text) {
    for (int line = 1; !text.empty() && !errors_.first; ++line) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      const ZmxRow row(text.substr(0, end), line, errors_);
      text.remove_prefix(std::min(end + 1, text.size()));
      if (!row.is_empty()) read_row(row);
    }
  }

  void read_row(const ZmxRow& row) {
    if (row.is("SURF")) return begin_surface(row);
    if (in_surface_ && read_zmx_surface_row(row, surfaces_.back(), design_.warnings)) return;
    if (in_surface_ && zmx_is_passed_over(row.word(0))) return;
    if (in_surface_ && row.is_set_in()) {
      unknown_.insert(std::string(row.word(0).substr(0, 16)));
      return;
    }
    in_surface_ = false;
    if (configurations_.is_there && configurations_.count > 0) {
      configurations_.add(row);
    } else if (row.is("MNUM")) {
      configurations_.begin(row);
    } else {
      system_.read(row, !surfaces_.empty(), design_);
    }
  }

  void begin_surface(const ZmxRow& row) {
    in_surface_ = true;
    if (row.whole(1) != static_cast<int>(surfaces_.size()))
      return row.fail(fmt::format("SURF {} where SURF {} is due", shortened(row.word(1)), surfaces_.size()));
    if (surfaces_.size() >= kMaxZmxSurfaces)
      return row.fail(fmt::format("more than {} surfaces; no lens has so many", kMaxZmxSurfaces));
    surfaces_.push_back({});
    surfaces_.back().line = row.line();
  }

  void warn_of_blocks() {
    const auto coated =
        std::find_if(surfaces_.begin(), surfaces_.end(), [](const ZmxSurface& s) { return !s.coating.empty(); });
    if (coated != surfaces_.end())
      design_.warnings.push_back(
          fmt::format("coatings are names of another program, such as {}; surfaces are bare, --coating puts films on "
                      "them",
                      coated->coating));
    for (const std::string& word : unknown_)
      design_.warnings.push_back(fmt::format("'{}' of a surface is not known and left out", word));
  }

  // A row's own glass, or that of the surface it is picked up from.
  Result<Glass> glass_of(const ZmxGlass& in) {
    if (in.status != ZmxGlass::Status::PickedUp || !in.is_blank())
      return zmx_glass(in, system_.makers(), finder_, errors_.file, design_.warnings);
    if (in.from < 1 || static_cast<std::size_t>(in.from) >= design_.surfaces.size())
      return failure(ErrorCode::Parse, fmt::format("a glass picked up from surface {}, which is not in front", in.from),
                     {errors_.file, in.line, 0});
    return design_.surfaces[static_cast<std::size_t>(in.from)].glass_after;
  }

  void make_surfaces() {
    if (surfaces_.empty()) return errors_.fail(0, "no SURF blocks; a sequential lens of Zemax has them");
    surfaces_.back().thickness = 0.0;
    Glass medium = air();
    for (std::size_t k = 0; k < surfaces_.size() && !errors_.first; ++k) {
      const ZmxSurface& from = surfaces_[k];
      auto surface = zmx_surface(from, static_cast<int>(k), errors_.file);
      if (!surface) {
        errors_.first = surface.error();
        return;
      }
      if (k == 0 && from.glass && from.glass->name != "AIR" && from.glass->name != "VACUUM")
        return errors_.fail(from.glass->line, "the object stands in glass; lenses in air are computed",
                            ErrorCode::Unsupported);
      if (!surface->is_break) {
        medium = air();
        if (from.glass && k > 0 && k + 1 < surfaces_.size()) {
          auto glass = glass_of(*from.glass);
          if (!glass) {
            errors_.first = glass.error();
            return;
          }
          medium = std::move(*glass);
        }
        surface->glass_after = medium;
      }
      design_.surfaces.push_back(std::move(*surface));
    }
    design_.is_focused = surfaces_.size() > 1 && surfaces_[surfaces_.size() - 2].is_to_focus;
    design_.image_semi_diameter = surfaces_.back().semi_diameter;
    design_.positions = zmx_positions(configurations_, surfaces_, design_.warnings);
  }

  FirstError errors_;
  GlassFinder finder_;
  SequentialDesign design_;
  ZmxSystem system_;
  std::vector<ZmxSurface> surfaces_;
  ZmxConfigurations configurations_;
  std::set<std::string> unknown_;
  bool in_surface_ = false;
};

}  // namespace

bool looks_like_zmx(std::string_view text) {
  const bool surfaces = text.starts_with("SURF 0") || text.find("\nSURF 0") != std::string_view::npos;
  return surfaces && (text.find("CURV") != std::string_view::npos || text.find("DISZ") != std::string_view::npos);
}

Result<Prescription> read_zmx(const LensText& in) { return ZmxReader(in).read(); }

}  // namespace contrejour::inline internal
