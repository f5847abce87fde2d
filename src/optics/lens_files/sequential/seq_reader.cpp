// SPDX-License-Identifier: Apache-2.0
// Lens files of CODE V (docs/formats/codev.md): a sequence of commands, of which those behind an S refer to the surface
// that it starts.
#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/near_name.h"
#include "optics/lens/validate.h"
#include "optics/lens_files/plain_number.h"
#include "optics/lens_files/read_lens.h"
#include "optics/lens_files/sequential/seq_commands.h"
#include "optics/lens_files/sequential/seq_glass.h"
#include "optics/lens_files/sequential/seq_surface.h"
#include "optics/lens_files/sequential/seq_system.h"
#include "optics/lens_files/sequential/seq_zoom.h"
#include "optics/lens_files/sequential/sequential_design.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kMaxSeqSurfaces = 1000;

class SeqReader {
 public:
  explicit SeqReader(const LensText& in)
      : errors_{in.file, {}}, finder_(in.glasses), surface_reader_(errors_.file),
        design_(design_from("CODE V", in.file)) {
    const std::vector<SeqCommand> commands = seq_commands(in.text);
    if (commands.size() >= kMaxSeqCommands)
      fail(0, fmt::format("more than {} commands; no lens has so many", kMaxSeqCommands - 1));
    for (const SeqCommand& command : commands) {
      if (errors_.first) break;
      read_command(command);
    }
  }

  [[nodiscard]] Result<Prescription> read() {
    finish();
    if (errors_.first) return tl::unexpected(*errors_.first);
    return prescription_of(design_);
  }

 private:
  void fail(int line, std::string message, ErrorCode code = ErrorCode::Parse) {
    errors_.fail(line, std::move(message), code);
  }
  void warn(std::string message) { design_.warnings.push_back(std::move(message)); }

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
    } else if (system_.read(command, design_, errors_) || seq_is_passed_over(command.name)) {
      return;
    } else {
      read_of_surface(command);
    }
  }

  // EPD Z1 10 is EPD 10; values of other positions belong to the zoom.
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
    if (at > surfaces_.size() || at >= kMaxSeqSurfaces)
      return fail(command.line, at >= kMaxSeqSurfaces
                                    ? fmt::format("more than {} surfaces; no lens has so many", kMaxSeqSurfaces)
                                    : fmt::format("S{} where S{} is due", at, surfaces_.size()));
    if (at == surfaces_.size()) surfaces_.push_back({});
    current_ = at;
    SeqSurface& s = surfaces_[at];
    s.line = command.line;
    s.radius_mode = system_.radius_mode();
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

  // Reads a command for the last surface, or for the one that it names.
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
    if (problem) errors_.first = problem;
  }

  // S2..4, SI-1, SA
  static bool names_several(std::string_view word) {
    const std::string upper = capitals(word);
    return upper.starts_with("S") &&
           (upper.find("..") != std::string::npos || upper.starts_with("SI-") || upper == "SA");
  }

  void finish() {
    if (errors_.first) return;
    if (surfaces_.size() < 3) return fail(0, "no lens: it has an object, an image and nothing between");
    decide_radius_mode();
    system_.finish(design_);
    for (std::size_t k = 0; k < surfaces_.size() && !errors_.first; ++k) add_surface(surfaces_[k], k);
    if (errors_.first) return;
    set_default_stop();
    design_.is_focused = surfaces_[surfaces_.size() - 2].is_to_focus && surfaces_.back().thickness == 0.0;
    if (const auto& opening = design_.surfaces.back().opening)
      design_.image_semi_diameter = std::max({opening->half_x, opening->half_y, opening->circle});
    design_.positions = zoom_.positions(design_, design_.warnings);
  }

  // Without RDM the first number of S is a curvature, CODE V's default, unless no beam would get through then.
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

  // The stop that CODE V uses if the file marks none.
  void set_default_stop() {
    const auto is_stop = [](const DesignSurface& s) { return s.is_stop; };
    if (std::any_of(design_.surfaces.begin(), design_.surfaces.end(), is_stop)) return;
    design_.surfaces[1].is_stop = true;
    warn(fmt::format("no surface is the stop (STO); it is S1 (line {})", design_.surfaces[1].line));
  }

  void add_surface(const SeqSurface& from, std::size_t k) {
    if (k == 0 && !from.glass.empty() && capitals(from.glass) != "AIR")
      return fail(from.glass_line, "the object stands in glass; lenses in air are computed", ErrorCode::Unsupported);
    auto surface = seq_design_surface(from, static_cast<int>(k), errors_.file);
    if (!surface) {
      errors_.first = surface.error();
      return;
    }
    if (k > 0) {
      auto glass = seq_glass(from.glass, from.glass_next, own_glasses_, finder_, errors_.file, from.glass_line,
                             design_.warnings);
      if (!glass) {
        errors_.first = glass.error();
        return;
      }
      surface->glass_after = std::move(*glass);
    }
    design_.surfaces.push_back(std::move(*surface));
  }

  FirstError errors_;
  GlassFinder finder_;
  SeqPrivateGlasses own_glasses_;
  SeqSurfaceReader surface_reader_;
  SeqSystem system_;
  SeqZoom zoom_;
  SequentialDesign design_;
  std::vector<SeqSurface> surfaces_;
  std::size_t current_ = 0;
  bool private_ = false;
  std::set<std::string> unknown_;
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

Result<Prescription> read_seq(const LensText& in) { return SeqReader(in).read(); }

}  // namespace contrejour::inline internal
