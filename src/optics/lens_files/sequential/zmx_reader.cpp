// Sequential lens files of Zemax (docs/formats/zemax.md): a keyword a line, surfaces in SURF blocks.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/near_name.h"
#include "base/trimmed.h"
#include "base/units.h"
#include "optics/lens/validate.h"
#include "optics/lens_files/plain_number.h"
#include "optics/lens_files/read_lens.h"
#include "optics/lens_files/sequential/design_text.h"
#include "optics/lens_files/sequential/sequential_design.h"
#include "optics/lens_files/sequential/zmx_surface.h"
#include "optics/lens_files/sequential/zmx_zoom.h"

namespace contrejour {
namespace {

constexpr std::size_t kMostSurfaces = 1000, kMostOperands = 20'000;
constexpr int kMostWavelengths = 100;

using Words = std::vector<std::string_view>;

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// Plots, solves that are already carried out, tolerances, physical optics: nothing that bends or blocks a ray.
bool is_passed_over(std::string_view word) {
  static const std::set<std::string_view> kWords = {
      "SSID", "COMM", "FIMP", "HIDE", "MIRR", "SLAB", "POPS", "OEMA", "MEMA", "VPAR", "PPAR", "VDSZ", "CAZH", "VCON",
      "PCON", "TCED", "GLRS", "PKUP", "PZSP", "ISNA", "FZSP", "VXDT", "PXDT", "THIC", "BLNK", "DRAW", "SCAT", "CHZN",
      "EMAR", "PMAR", "LSMO", "ARTP", "ROWC", "SHAD", "OPDM", "MARG", "MRGA", "CHRA", "EDGE", "NOTE", "IDNT"};
  return kWords.contains(word);
}

class Reader {
 public:
  explicit Reader(const LensText& in) : file_(in.file), finder_(in.glasses) {
    design_.program = "Zemax";
    design_.file = in.file;
    split(in.text);
  }

  [[nodiscard]] Result<Prescription> read() {
    finish_header();
    make_surfaces();
    if (error_) return tl::unexpected(*error_);
    return prescription_of(design_);
  }

 private:
  void fail(int line, std::string message, ErrorCode code = ErrorCode::Parse) {
    if (!error_) error_ = Error{code, std::move(message), {file_, line, 0}};
  }
  void warn(std::string message) { design_.warnings.push_back(std::move(message)); }

  // The k-th word as a number; 0 where it is missing.
  double number(const Words& words, std::size_t k, bool may_be_infinite = false) {
    if (k >= words.size()) return 0.0;
    const auto value = may_be_infinite ? number_or_infinity(words[k]) : plain_number(words[k]);
    if (!value) fail(line_, fmt::format("'{}' of {} is no number", shortened(words[k]), shortened(words[0])));
    return value.value_or(0.0);
  }

  int whole(const Words& words, std::size_t k) {
    const double value = number(words, k);
    return std::abs(value) < 1e6 ? static_cast<int>(value) : 0;
  }

  void split(std::string_view text) {
    for (line_ = 1; !text.empty() && !error_; ++line_) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      const std::string_view line = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      const Words words = words_of(line);
      if (words.empty()) continue;
      if (words[0] == "SURF") {
        begin_surface(words);
      } else if (in_surface_ && read_surface_line(words)) {
        continue;
      } else if (in_surface_ && is_passed_over(words[0])) {
        continue;
      } else if (in_surface_ && (line.front() == ' ' || line.front() == '\t')) {
        unknown_.insert(std::string(words[0].substr(0, 16)));
      } else {
        in_surface_ = false;
        read_header_line(words, line);
      }
    }
  }

  void begin_surface(const Words& words) {
    in_surface_ = true;
    if (whole(words, 1) != static_cast<int>(surfaces_.size()))
      return fail(line_, fmt::format("SURF {} where SURF {} is due", shortened(words.size() > 1 ? words[1] : ""),
                                     surfaces_.size()));
    if (surfaces_.size() >= kMostSurfaces)
      return fail(line_, fmt::format("more than {} surfaces; no lens has so many", kMostSurfaces));
    surfaces_.push_back({});
    surfaces_.back().line = line_;
  }

  DesignOpening& opening() {
    auto& at = surfaces_.back().opening;
    if (!at) at = DesignOpening{.line = line_};
    return *at;
  }

  // False for a word that is not a surface's.
  bool read_surface_line(const Words& words) {
    ZmxSurface& s = surfaces_.back();
    const std::string_view word = words[0];
    if (word == "TYPE") {
      s.type = words.size() > 1 ? std::string(words[1]) : "";
    } else if (word == "CURV") {
      s.curvature = number(words, 1);
    } else if (word == "DISZ") {
      s.thickness = number(words, 1, true);
    } else if (word == "CONI") {
      s.conic = number(words, 1);
    } else if (word == "PARM") {
      if (s.parm.size() < 1000) s.parm[whole(words, 1)] = number(words, 2, true);
    } else if (word == "XDAT") {
      if (s.xdat.size() < 1000) s.xdat[whole(words, 1)] = number(words, 2);
    } else if (word == "STOP") {
      s.is_stop = true;
    } else if (word == "GLAS") {
      read_glass(words);
    } else if (word == "DIAM") {
      const double semi = std::abs(number(words, 1, true));
      s.semi_diameter = std::isinf(semi) ? 0.0 : semi;
      s.is_semi_fixed = words.size() > 2 && whole(words, 2) != 0;
    } else if (word == "SCBD") {
      for (std::size_t k = 4; k < words.size(); ++k)  // before or behind it, two flags, decentre and tilts
        if (number(words, k) != 0.0) s.own_tilt_line = line_;
    } else if (word == "COAT") {
      if (coatings_.empty() && words.size() > 1) coatings_ = fmt::format("{} (line {})", shortened(words[1]), line_);
    } else {
      return read_opening(words) || read_solve(words);
    }
    return true;
  }

  void read_glass(const Words& words) {
    ZmxGlass glass{.line = line_, .name = words.size() > 1 ? std::string(words[1]) : ""};
    glass.status = static_cast<ZmxGlass::Status>(std::clamp(whole(words, 2), 0, 5));
    glass.from = whole(words, 3);
    glass.n_d = number(words, 4);
    glass.v_d = number(words, 5);
    glass.d_pgf = number(words, 6);
    glass.more_n_d = number(words, 10);
    glass.more_v_d = number(words, 11);
    surfaces_.back().glass = glass;
  }

  bool read_opening(const Words& words) {
    const std::string_view word = words[0];
    if (word == "CLAP") {
      opening().obscured = number(words, 1);
      opening().half_x = opening().half_y = number(words, 2);
    } else if (word == "FLAP") {
      surfaces_.back().floats = true;
      if (number(words, 1) > 0.0) opening().obscured = number(words, 1);
    } else if (word == "SQAP" || word == "ELAP") {
      opening().shape = word == "SQAP" ? OpeningShape::Rectangle : OpeningShape::Ellipse;
      opening().half_x = number(words, 1);
      opening().half_y = number(words, 2);
    } else if (word == "OBDC") {
      opening().centre = {number(words, 1), number(words, 2)};
    } else if (is_one_of(word, {"OBSC", "SQOB", "ELOB", "SPID"})) {
      warn(fmt::format("the obscuration {} (line {}) is not computed; light goes through", word, line_));
    } else if (is_one_of(word, {"UDAP", "USAP", "UDOB", "USOB"})) {
      warn(fmt::format("the aperture {} (line {}) is drawn in a file of its own; the semi-diameter is used", word,
                       line_));
    } else {
      return false;
    }
    return true;
  }

  bool read_solve(const Words& words) {
    auto& solve = surfaces_.back().solve;
    if (words[0] == "PZUP") {
      solve = ThicknessSolve{ThicknessSolve::Kind::Pickup, whole(words, 1), number(words, 2), number(words, 3)};
    } else if (words[0] == "TOLE") {
      solve = ThicknessSolve{ThicknessSolve::Kind::Sum, whole(words, 1), 1.0, number(words, 2)};
    } else if (words[0] == "TCOM") {
      solve = ThicknessSolve{ThicknessSolve::Kind::Pair, whole(words, 1), 1.0, number(words, 2)};
    } else if (words[0] == "MAZH") {
      surfaces_.back().is_to_focus = number(words, 1) == 0.0 && number(words, 2) == 0.0;
    } else {
      return false;
    }
    return true;
  }

  void read_header_line(const Words& words, std::string_view line) {
    const std::string_view word = words[0];
    if (configurations_.count > 0 && has_configurations_) return read_operand(words);
    if (word == "MODE") {
      if (words.size() > 1 && words[1] == "NSC")
        fail(line_, "a non-sequential file; only sequential ones (MODE SEQ) are read", ErrorCode::Unsupported);
    } else if (word == "UNIT") {
      read_unit(words);
    } else if (word == "NAME") {
      design_.name = std::string(trimmed(line.substr(line.find("NAME") + 4)));
    } else if (word == "NOTE" && words.size() > 2 && words[1] == "0") {
      const auto begin = static_cast<std::size_t>(words[2].data() - line.data());
      if (notes_.size() < 1000) notes_ += (notes_.empty() ? "" : " ") + std::string(trimmed(line.substr(begin)));
    } else if (word == "GCAT") {
      for (std::size_t k = 1; k < words.size(); ++k) makers_.emplace_back(words[k]);
    } else if (word == "ENVD") {
      if (whole(words, 3) != 0 && (number(words, 1) != 20.0 || number(words, 2) != 1.0))
        warn(fmt::format("indices at {:g} deg C and {:g} atm (line {}); those at 20 deg C and 1 atm are used",
                         number(words, 1), number(words, 2), line_));
    } else if (word == "MNUM") {
      has_configurations_ = true;
      configurations_.count = words.size() > 1 ? whole(words, 1) : 1;
      configurations_.current = words.size() > 2 ? whole(words, 2) : 1;
      if (configurations_.count > kMaxZoomPositions)
        fail(line_, fmt::format("{} configurations; at most {} are read", configurations_.count, kMaxZoomPositions));
    } else if (!surfaces_.empty()) {
      return;  // merit function, tolerances
    } else {
      read_light(words);
    }
  }

  void read_unit(const Words& words) {
    const std::string_view unit = words.size() > 1 ? words[1] : "MM";
    if (unit == "MM") return;
    if (unit == "CM") {
      design_.unit_mm = 10.0;
    } else if (unit == "IN") {
      design_.unit_mm = 25.4;
    } else if (is_one_of(unit, {"METER", "M", "ME"})) {
      design_.unit_mm = 1000.0;
    } else {
      fail(line_, fmt::format("the unit '{}' is not known; MM, CM, IN and METER are", shortened(unit)));
    }
  }

  // System aperture, fields, wavelengths.
  void read_light(const Words& words) {
    const std::string_view word = words[0];
    if (word == "ENPD") {
      set_aperture(DesignAperture::EntrancePupil, words);
    } else if (word == "FNUM") {
      set_aperture(whole(words, 2) == 1 ? DesignAperture::WorkingFNumber : DesignAperture::FNumber, words);
    } else if (word == "OBNA") {
      set_aperture(DesignAperture::ObjectNA, words);
      if (whole(words, 2) == 1) design_.aperture_value = std::sin(rad_from_deg(design_.aperture_value));  // a cone's
    } else if (word == "FLOA") {
      design_.aperture = DesignAperture::ByStop;
    } else if (word == "FTYP") {
      field_type_ = whole(words, 1);
      if (words.size() > 3) fields_ = whole(words, 3);
    } else if (is_one_of(word, {"XFLN", "YFLN", "XFLD", "YFLD"})) {
      auto& field = word[0] == 'X' ? x_field_ : y_field_;
      for (std::size_t k = 1; k < words.size(); ++k) field.push_back(number(words, k));
    } else if (word == "WAVL" || word == "WAVN") {
      for (std::size_t k = 1; k < words.size(); ++k) set_wavelength(static_cast<int>(k), number(words, k));
    } else if (word == "WAVM") {
      set_wavelength(whole(words, 1), number(words, 2));
    } else if (word == "PWAV") {
      primary_ = whole(words, 1);
    }
  }

  void set_aperture(DesignAperture kind, const Words& words) {
    design_.aperture = kind;
    design_.aperture_value = number(words, 1);
    if (!(design_.aperture_value > 0.0)) fail(line_, fmt::format("{} is no size of an aperture", shortened(words[0])));
  }

  void set_wavelength(int k, double um) {
    if (k < 1 || k > kMostWavelengths) return;
    wavelengths_um_.resize(std::max(wavelengths_um_.size(), static_cast<std::size_t>(k)));
    wavelengths_um_[static_cast<std::size_t>(k) - 1] = um;
  }

  void read_operand(const Words& words) {
    if (words.size() < 4 || configurations_.operands.size() >= kMostOperands) return;
    const auto subject = plain_number(words[1]), configuration = plain_number(words[2]);
    if (!subject || !configuration || std::abs(*subject) > 1e6 || std::abs(*configuration) > 1e6) return;
    // A title may have spaces.
    std::string value(words[3]);
    for (std::size_t k = 4; value.starts_with('"') && (value.size() == 1 || value.back() != '"') && k < words.size();
         ++k)
      value += " " + std::string(words[k]);
    configurations_.operands.push_back(
        {line_, std::string(words[0]), static_cast<int>(*subject), static_cast<int>(*configuration), value});
  }

  void finish_header() {
    if (design_.name.empty()) design_.name = stem_of(file_);
    design_.source = notes_.empty() ? "a Zemax file that does not say it" : cut_text(notes_);
    const std::size_t primary = static_cast<std::size_t>(std::max(primary_, 1)) - 1;
    if (primary < wavelengths_um_.size() && wavelengths_um_[primary] > 0.0)
      design_.wavelength_nm = wavelengths_um_[primary] * 1e3;
    const std::size_t told = std::max(x_field_.size(), y_field_.size());
    const std::size_t count = fields_ > 0 ? std::min(told, static_cast<std::size_t>(fields_)) : told;
    for (std::size_t k = 0; k < count; ++k)
      design_.add_field(k < x_field_.size() ? x_field_[k] : 0.0, k < y_field_.size() ? y_field_[k] : 0.0);
    design_.field = field_type_ == 1                       ? FieldKind::ObjectHeight
                    : field_type_ == 2 || field_type_ == 3 ? FieldKind::ImageHeight
                                                           : FieldKind::Angle_deg;
    if (!coatings_.empty())
      warn(
          fmt::format("coatings are names of another program, such as {}; surfaces are bare, --coating puts films on "
                      "them",
                      coatings_));
    for (const std::string& word : unknown_) warn(fmt::format("'{}' of a surface is not known and left out", word));
  }

  // A row's own glass, or that of the surface it is picked up from.
  Result<Glass> glass_of(const ZmxGlass& in) {
    if (in.status != ZmxGlass::Status::PickedUp || !in.is_blank())
      return zmx_glass(in, makers_, finder_, file_, design_.warnings);
    if (in.from < 1 || static_cast<std::size_t>(in.from) >= design_.surfaces.size())
      return failure(ErrorCode::Parse, fmt::format("a glass picked up from surface {}, which is not in front", in.from),
                     {file_, in.line, 0});
    return design_.surfaces[static_cast<std::size_t>(in.from)].glass_after;
  }

  void make_surfaces() {
    if (surfaces_.empty()) return fail(0, "no SURF blocks; a sequential lens of Zemax has them");
    surfaces_.back().thickness = 0.0;
    Glass medium = air();
    for (std::size_t k = 0; k < surfaces_.size() && !error_; ++k) {
      const ZmxSurface& from = surfaces_[k];
      auto surface = zmx_surface(from, static_cast<int>(k), file_);
      if (!surface) {
        error_ = surface.error();
        return;
      }
      if (k == 0 && from.glass && from.glass->name != "AIR" && from.glass->name != "VACUUM")
        return fail(from.glass->line, "the object stands in glass; lenses in air are computed", ErrorCode::Unsupported);
      if (!surface->is_break) {
        medium = air();
        if (from.glass && k > 0 && k + 1 < surfaces_.size()) {
          auto glass = glass_of(*from.glass);
          if (!glass) {
            error_ = glass.error();
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

  const std::string& file_;
  GlassFinder finder_;
  SequentialDesign design_;
  std::vector<ZmxSurface> surfaces_;
  std::vector<std::string> makers_;
  std::string notes_, coatings_;
  std::set<std::string> unknown_;
  std::vector<double> wavelengths_um_, x_field_, y_field_;
  int primary_ = 1, fields_ = 0, field_type_ = 0;
  ZmxConfigurations configurations_;
  bool has_configurations_ = false;
  bool in_surface_ = false;
  int line_ = 0;
  std::optional<Error> error_;
};

}  // namespace

bool looks_like_zmx(std::string_view text) {
  const bool surfaces = text.starts_with("SURF 0") || text.find("\nSURF 0") != std::string_view::npos;
  return surfaces && (text.find("CURV") != std::string_view::npos || text.find("DISZ") != std::string_view::npos);
}

Result<Prescription> read_zmx(const LensText& in) { return Reader(in).read(); }

}  // namespace contrejour
