// SPDX-License-Identifier: Apache-2.0
// Glasses by CODE V's names.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "optics/lens_files/glass_finder.h"
#include "optics/lens_files/sequential/seq_commands.h"

namespace contrejour::inline internal {

// The glasses that a file defines between PRV and END.
class SeqPrivateGlasses {
 public:
  // One command of that part: PWL and wavelengths (nm), or a name and its indices or coefficients. Errors are reported
  // when a glass is used, since files define more glasses than they use.
  void add(const SeqCommand& command);
  [[nodiscard]] const Result<Glass>* find(std::string_view name) const;

 private:
  [[nodiscard]] Result<Glass> glass_of(const SeqCommand& command) const;

  std::vector<double> wavelengths_nm_;
  std::map<std::string, Result<Glass>, std::less<>> glasses_;  // by name in capitals
};

// "NBK7_SCHOTT", "517642", "517.642", "517000.642000", "1.517:64.2", or "1.517" with `next` "64.2". Errors:
// InvalidArgument for an unknown name.
[[nodiscard]] Result<Glass> seq_glass(std::string_view word, std::string_view next, const SeqPrivateGlasses& own,
                                      GlassFinder& finder, const std::string& file, int line,
                                      std::vector<std::string>& warnings);

}  // namespace contrejour::inline internal
