// The commands of a CODE V file that are about one surface.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "optics/lens_files/sequential/seq_commands.h"
#include "optics/lens_files/sequential/sequential_design.h"

namespace contrejour {

// Coefficients of r^4, r^6, ... r^20.
inline constexpr std::string_view kSeqPowers[] = {"A", "B", "C", "D", "E", "F", "G", "H", "J"};

enum class RadiusMode { Unsaid, Radius, Curvature };

struct SeqSurface {
  int line = 0;
  RadiusMode radius_mode = RadiusMode::Unsaid;
  std::optional<double> first;  // of S: a radius or a curvature, as radius_mode says
  std::optional<double> curvature;  // by a command of its own
  double thickness = 0;
  std::string glass, glass_next;
  int glass_line = 0;
  bool is_stop = false;
  ShapeKind kind = ShapeKind::Revolution;
  bool turned = false;  // XTO: the profile is in x
  double curvature_x = 0;
  std::map<std::string, double, std::less<>> coefficients;  // K, A, B, ..., KX, KY
  std::map<std::string, double, std::less<>> moves;         // XDE, YDE, ZDE, ADE, BDE, CDE
  bool returns = false;                        // DAR
  std::string refused_move = {};  // how its decentre and tilts act, where that is not computed
  int refused_move_line = 0;
  std::optional<DesignOpening> opening;
  Obscuration obscuration;
  std::optional<ThicknessSolve> solve;
  bool is_to_focus = false;  // PIM: the next surface stands in the paraxial focus
};

[[nodiscard]] bool seq_is_of_surface(std::string_view name);

class SeqSurfaceReader {
 public:
  explicit SeqSurfaceReader(const std::string& file) : file_(file) {}

  // An error for what is not computed or no number; nothing if all is well.
  // Of surface `index`.
  [[nodiscard]] std::optional<Error> read(const SeqCommand& command, int index, SeqSurface& surface,
                                          std::vector<std::string>& warnings) const;

 private:
  const std::string& file_;
};

[[nodiscard]] Result<DesignSurface> seq_design_surface(const SeqSurface& in, int index, const std::string& file);

}  // namespace contrejour
