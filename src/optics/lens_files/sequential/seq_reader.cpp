// Lens files of CODE V (docs/formats/codev.md): commands, those behind an S about the surface that it starts.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/near_name.h"
#include "base/trimmed.h"
#include "optics/lens/validate.h"
#include "optics/lens_files/plain_number.h"
#include "optics/lens_files/read_lens.h"
#include "optics/lens_files/sequential/design_text.h"
#include "optics/lens_files/sequential/seq_commands.h"
#include "optics/lens_files/sequential/seq_glass.h"
#include "optics/lens_files/sequential/seq_surface.h"
#include "optics/lens_files/sequential/seq_zoom.h"
#include "optics/lens_files/sequential/sequential_design.h"

namespace contrejour {
namespace {

constexpr std::size_t kMostSurfaces = 1000;

// Names, weights, vignetting factors, variables and their limits, derivatives, colours, plots.
bool is_passed_over(std::string_view name) {
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

class Reader {
 public:
  explicit Reader(const LensText& in) : file_(in.file), finder_(in.glasses), surface_reader_(in.file) {
    design_.program = "CODE V";
    design_.file = in.file;
    const std::vector<SeqCommand> commands = seq_commands(in.text);
    if (commands.size() >= kMostSeqCommands)
      fail(0, fmt::format("more than {} commands; no lens has so many", kMostSeqCommands - 1));
    for (const SeqCommand& command : commands) {
      if (error_) break;
      read_command(command);
    }
  }

  [[nodiscard]] Result<Prescription> read() {
    finish();
    if (error_) return tl::unexpected(*error_);
    return prescription_of(design_);
  }

 private:
  void fail(int line, std::string message, ErrorCode code = ErrorCode::Parse) {
    if (!error_) error_ = Error{code, std::move(message), {file_, line, 0}};
  }
  void warn(std::string message) { design_.warnings.push_back(std::move(message)); }

  double number(const SeqCommand& command, std::size_t k) {
    const auto value = plain_number(command.word(k));
    if (!value) fail(command.line, fmt::format("'{}' of {} is no number", shortened(command.word(k)), command.name));
    return value.value_or(0.0);
  }

  void read_command(const SeqCommand& command) {
    if (const std::size_t word = seq_zoom_word(command); word < command.words.size())
      return read_of_position(command, word);
    if (private_) {
      if (command.name == "END") {
        private_ = false;
      } else if (command.name == "S") {
        fail(command.line, "the private glasses (PRV) do not END before the surfaces");
      } else {
        own_glasses_.add(command);
      }
    } else if (command.name == "PRV") {
      private_ = true;
    } else if (command.name == "S") {
      begin_surface(command);
    } else if (command.name == "ZOO") {
      if (const auto problem = zoom_.add(command)) fail(command.line, *problem);
    } else if (read_light(command) || read_system(command) || is_passed_over(command.name)) {
      return;
    } else {
      read_of_surface(command);
    }
  }

  // EPD Z1 10 is EPD 10; what the other positions have is the zoom's.
  void read_of_position(const SeqCommand& command, std::size_t word) {
    zoom_.add_one(command, word);
    if (capitals(command.words[word]) != "Z1" || command.name == "TIT") return;
    SeqCommand first = command;
    first.words.erase(first.words.begin() + static_cast<std::ptrdiff_t>(word));
    read_command(first);
  }

  // S, S4, SO, SI: radius or curvature, thickness, glass.
  void begin_surface(const SeqCommand& command) {
    const SeqSurfaceName named = seq_surface_name(command.word(0));
    const std::size_t from = named.is ? 1 : 0;
    std::size_t at = surfaces_.size();
    if (named.is && named.index != kSeqImage) at = static_cast<std::size_t>(named.index);
    if (at > surfaces_.size() || at >= kMostSurfaces)
      return fail(command.line, at >= kMostSurfaces
                                    ? fmt::format("more than {} surfaces; no lens has so many", kMostSurfaces)
                                    : fmt::format("S{} where S{} is due", at, surfaces_.size()));
    if (at == surfaces_.size()) surfaces_.push_back({});
    current_ = at;
    SeqSurface& s = surfaces_[at];
    s.line = command.line;
    s.radius_mode = radius_mode_;
    if (!command.word(from).empty()) s.first = radius_or_curvature(command, from);
    if (!command.word(from + 1).empty()) {
      const auto thickness = number_or_infinity(command.word(from + 1));
      if (!thickness) return fail(command.line, fmt::format("'{}' is no thickness", shortened(command.word(from + 1))));
      s.thickness = *thickness;
    }
    for (std::size_t k = from + 2; k < command.words.size(); ++k) {
      const std::string word = capitals(command.words[k]);
      if (word == "REFL") return refuse_mirror(command.line);
      if (word == "REFR" || (k > from + 2 && plain_number(word))) continue;
      s.glass = command.words[k];
      s.glass_next = command.word(k + 1);
      s.glass_line = command.line;
    }
  }

  double radius_or_curvature(const SeqCommand& command, std::size_t k) {
    const auto value = number_or_infinity(command.word(k));
    if (!value) fail(command.line, fmt::format("'{}' is no radius", shortened(command.word(k))));
    return value && std::isfinite(*value) ? *value : 0.0;
  }

  void refuse_mirror(int line) {
    fail(line, "a mirror (REFL); lenses of refracting surfaces alone are computed", ErrorCode::Unsupported);
  }

  bool read_light(const SeqCommand& command) {
    const std::string& name = command.name;
    if (name == "EPD") {
      set_aperture(command, DesignAperture::EntrancePupil);
    } else if (name == "FNO") {
      set_aperture(command, DesignAperture::WorkingFNumber);
    } else if (name == "NA") {
      set_aperture(command, DesignAperture::WorkingFNumber);
      if (!error_) design_.aperture_value = 0.5 / design_.aperture_value;
    } else if (name == "NAO") {
      set_aperture(command, DesignAperture::ObjectNA);
    } else if (name == "WL") {
      wavelengths_nm_.clear();
      for (std::size_t k = 0; k < command.words.size(); ++k) wavelengths_nm_.push_back(number(command, k));
    } else if (name == "REF") {
      reference_ = static_cast<int>(std::clamp(number(command, 0), 0.0, 1e3));
    } else {
      return read_field(command);
    }
    return true;
  }

  void set_aperture(const SeqCommand& command, DesignAperture kind) {
    design_.aperture = kind;
    design_.aperture_value = number(command, 0);
    if (!(design_.aperture_value > 0.0))
      fail(command.line, fmt::format("{} is no size of an aperture", shortened(command.name)));
  }

  // XAN 0 10 14, or YAN F2 10.
  bool read_field(const SeqCommand& command) {
    if (command.name.size() != 3 || (command.name[0] != 'X' && command.name[0] != 'Y')) return false;
    const std::string kind = command.name.substr(1);
    if (kind != "AN" && kind != "OB" && kind != "IM" && kind != "RI") return false;
    design_.field = kind == "AN"   ? FieldKind::Angle_deg
                    : kind == "OB" ? FieldKind::ObjectHeight
                                   : FieldKind::ImageHeight;
    auto& values = fields_[command.name];
    const std::string_view first = command.word(0);
    if (first.size() > 1 && (first[0] == 'F' || first[0] == 'f')) {
      const auto k = static_cast<std::size_t>(std::clamp(plain_number(first.substr(1)).value_or(0.0), 1.0, 100.0));
      values.resize(std::max(values.size(), k));
      values[k - 1] = number(command, 1);
    } else {
      values.clear();
      for (std::size_t k = 0; k < command.words.size(); ++k) values.push_back(number(command, k));
    }
    return true;
  }

  bool read_system(const SeqCommand& command) {
    if (command.name == "RDM") {
      const std::string mode = capitals(command.word(0));
      radius_mode_ = mode.empty() || mode[0] == 'Y' ? RadiusMode::Radius : RadiusMode::Curvature;
    } else if (command.name == "TIT") {
      if (design_.name.empty()) design_.name = trimmed(join(command.words), " '\"");
    } else if (command.name == "DIM") {
      read_unit(command);
    } else if (command.name == "TEM") {
      if (number(command, 0) != 20.0)
        warn(fmt::format("indices at {:g} deg C (line {}); those at 20 deg C are used", number(command, 0),
                         command.line));
    } else if (command.name == "PRE") {
      if (number(command, 0) != 760.0)
        warn(fmt::format("the pressure of the air (line {}) is left out; indices are those at 1 atm", command.line));
    } else if (command.name == "AFI") {
      warn(fmt::format("an afocal system (line {}); the sensor is put in focus", command.line));
    } else {
      return false;
    }
    return true;
  }

  static std::string join(const std::vector<std::string>& words) {
    std::string out;
    for (const std::string& word : words) out += (out.empty() ? "" : " ") + word;
    while (!out.empty() && out.back() == ' ') out.pop_back();
    return cut_text(out);
  }

  void read_unit(const SeqCommand& command) {
    const std::string unit = capitals(command.word(0));
    if (unit == "C" || unit == "CM") {
      design_.unit_mm = 10.0;
    } else if (unit.starts_with("I")) {
      design_.unit_mm = 25.4;
    } else if (unit != "M" && unit != "MM") {
      fail(command.line, fmt::format("the unit '{}' is not known; M, C and I are", shortened(unit)));
    }
  }

  // A command about the last surface, or about the one that it names.
  void read_of_surface(const SeqCommand& command) {
    SeqCommand own = command;
    std::size_t at = current_;
    const std::size_t word = command.name == "PIK" ? 1 : 0;  // PIK THI S3 ...
    const SeqSurfaceName named = seq_surface_name(command.word(word));
    if (named.is) {
      at = named.index == kSeqImage ? surfaces_.size() - 1 : static_cast<std::size_t>(named.index);
      own.words.erase(own.words.begin() + static_cast<std::ptrdiff_t>(word));
    }
    if (!seq_is_of_surface(command.name)) {
      if (unknown_.insert(command.name).second && unknown_.size() < 20)
        warn(fmt::format("the command {} (line {}) is not known and left out", shortened(command.first), command.line));
      return;
    }
    if (names_several(own.word(0)))
      return fail(command.line, fmt::format("{} of {}: name one surface, such as S3", command.name, own.word(0)));
    if (at >= surfaces_.size())
      return fail(command.line, fmt::format("{} of a surface that is not there", command.name));
    const auto problem = surface_reader_.read(own, static_cast<int>(at), surfaces_[at], design_.warnings);
    if (problem) error_ = problem;
  }

  // S2..4, SI-1, SA
  static bool names_several(std::string_view word) {
    const std::string upper = capitals(word);
    return upper.starts_with("S") &&
           (upper.find("..") != std::string::npos || upper.starts_with("SI-") || upper == "SA");
  }

  void finish() {
    if (error_) return;
    if (surfaces_.size() < 3) return fail(0, "no lens: it has an object, an image and nothing between");
    decide_radius_mode();
    if (design_.name.empty()) design_.name = stem_of(file_);
    design_.source = "a CODE V file that does not say it";
    const std::size_t reference =
        reference_ > 0 ? static_cast<std::size_t>(reference_) - 1 : wavelengths_nm_.size() / 2;
    if (reference < wavelengths_nm_.size()) design_.wavelength_nm = wavelengths_nm_[reference];
    finish_fields();
    for (std::size_t k = 0; k < surfaces_.size() && !error_; ++k) add_surface(surfaces_[k], k);
    if (error_) return;
    set_default_stop();
    design_.is_focused = surfaces_[surfaces_.size() - 2].is_to_focus && surfaces_.back().thickness == 0.0;
    if (const auto& opening = design_.surfaces.back().opening)
      design_.image_semi_diameter = std::max({opening->half_x, opening->half_y, opening->circle});
    design_.positions = zoom_.positions(design_, design_.warnings);
  }

  // Where RDM does not say it, the first number of S is a curvature, as CODE V has it, unless no beam would pass.
  void decide_radius_mode() {
    const double semi = design_.aperture == DesignAperture::EntrancePupil ? 0.5 * design_.aperture_value : 1.0;
    double largest = 0.0;
    int line = 0;
    for (const SeqSurface& s : surfaces_) {
      if (s.radius_mode != RadiusMode::Unsaid) continue;
      if (s.first && std::abs(*s.first) > largest) line = s.line;
      largest = std::max(largest, std::abs(s.first.value_or(0.0)));
    }
    const bool radii = largest * semi > 1.0;
    for (SeqSurface& s : surfaces_)
      if (s.radius_mode == RadiusMode::Unsaid) s.radius_mode = radii ? RadiusMode::Radius : RadiusMode::Curvature;
    if (largest > 0.0)
      warn(radii ? fmt::format(
                       "without RDM, S would tell curvatures; {:g} (line {}) is too large for one, so radii are read",
                       largest, line)
                 : "without RDM, S tells curvatures");
  }

  void finish_fields() {
    std::size_t count = 0;
    for (const auto& [name, values] : fields_) count = std::max(count, values.size());
    for (std::size_t k = 0; k < count; ++k) {
      double x = 0.0, y = 0.0;
      for (const auto& [name, values] : fields_)
        if (k < values.size()) (name[0] == 'X' ? x : y) = values[k];
      design_.add_field(x, y);
    }
  }

  // CODE V's own.
  void set_default_stop() {
    const auto is_stop = [](const DesignSurface& s) { return s.is_stop; };
    if (std::any_of(design_.surfaces.begin(), design_.surfaces.end(), is_stop)) return;
    design_.surfaces[1].is_stop = true;
    warn(fmt::format("no surface is the stop (STO); it is S1 (line {})", design_.surfaces[1].line));
  }

  void add_surface(const SeqSurface& from, std::size_t k) {
    if (k == 0 && !from.glass.empty() && capitals(from.glass) != "AIR")
      return fail(from.glass_line, "the object stands in glass; lenses in air are computed", ErrorCode::Unsupported);
    auto surface = seq_design_surface(from, static_cast<int>(k), file_);
    if (!surface) {
      error_ = surface.error();
      return;
    }
    if (k > 0) {
      auto glass =
          seq_glass(from.glass, from.glass_next, own_glasses_, finder_, file_, from.glass_line, design_.warnings);
      if (!glass) {
        error_ = glass.error();
        return;
      }
      surface->glass_after = std::move(*glass);
    }
    design_.surfaces.push_back(std::move(*surface));
  }

  const std::string& file_;
  GlassFinder finder_;
  SeqPrivateGlasses own_glasses_;
  SeqSurfaceReader surface_reader_;
  SeqZoom zoom_;
  SequentialDesign design_;
  std::vector<SeqSurface> surfaces_;
  std::size_t current_ = 0;
  bool private_ = false;
  RadiusMode radius_mode_ = RadiusMode::Unsaid;
  std::vector<double> wavelengths_nm_;
  int reference_ = 0;
  std::map<std::string, std::vector<double>> fields_;
  std::set<std::string> unknown_;
  std::optional<Error> error_;
};

}  // namespace

// SO or S0, and another S.
bool looks_like_seq(std::string_view text) {
  bool object = false, surface = false;
  for (const SeqCommand& command : seq_commands(text.substr(0, 20'000))) {
    if (command.name != "S") continue;
    const SeqSurfaceName named = seq_surface_name(command.word(0));
    const auto numeric = [](std::string_view word) { return number_or_infinity(word).has_value(); };
    if (named.is && named.index == 0 && numeric(command.word(1))) object = true;
    if ((!named.is && numeric(command.word(0))) || (named.is && named.index != 0)) surface = true;
  }
  return object && surface;
}

Result<Prescription> read_seq(const LensText& in) { return Reader(in).read(); }

}  // namespace contrejour
