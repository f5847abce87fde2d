// SPDX-License-Identifier: Apache-2.0
// The commands of a CODE V file for one surface.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "optics/lens_files/sequential/seq_commands.h"
#include "optics/lens_files/sequential/sequential_design.h"

namespace contrejour::inline internal {

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
  bool in_x = false;  // XTO: the profile is in x
  double curvature_x = 0;
  std::map<std::string, double, std::less<>> coefficients;  // K, A, B, ..., KX, KY
  std::map<std::string, double, std::less<>> moves;         // XDE, YDE, ZDE, ADE, BDE, CDE
  bool returns = false;                        // DAR
  std::string refused_move = {};  // the kind of its decentre and tilts, if it is not supported
  int refused_move_line = 0;
  std::optional<DesignOpening> opening;
  Obscuration obscuration;
  std::optional<ThicknessSolve> solve;
  bool is_to_focus = false;  // PIM: the next surface is at the paraxial focus
};

[[nodiscard]] bool seq_is_of_surface(std::string_view name);

class SeqSurfaceReader {
 public:
  explicit SeqSurfaceReader(const std::string& file) : file_(file) {}

  // Reads a command of surface `index`. Returns an error for an unsupported command or an invalid number, else nothing.
  [[nodiscard]] std::optional<Error> read(const SeqCommand& command, int index, SeqSurface& surface,
                                          std::vector<std::string>& warnings) const;

 private:
  const std::string& file_;
};

[[nodiscard]] Result<DesignSurface> seq_design_surface(const SeqSurface& in, int index, const std::string& file);

}  // namespace contrejour::inline internal
