// SPDX-License-Identifier: Apache-2.0
// Copies of unsaved work in a folder of the user's state, so that a crash loses seconds. Each running studio
// has a file of its own, which it removes when it ends; a file whose program no longer runs is offered again.
// Errors: Io. Thread-safety: one thread at a time.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "contrejour/result.h"
#include "studio/core/document.h"

namespace contrejour::studio {

// $XDG_STATE_HOME/contrejour/studio, else ~/.local/state/contrejour/studio; empty where neither is known.
[[nodiscard]] std::filesystem::path state_folder();

struct LostWork {
  std::filesystem::path copy;  // in the folder of copies
  std::string of_file;  // the session that it is a copy of; empty: never saved
  std::string lens;
  std::chrono::seconds age{0};
};

class Autosave {
 public:
  static constexpr std::chrono::seconds kInterval{5};

  // An empty folder: nothing is saved or offered.
  explicit Autosave(std::filesystem::path folder);

  // Writes a copy if the document has changed and the interval has passed since the last look, or `now`.
  Result<void> save(const Document& document, const std::string& of_file, bool now = false);
  // The work was saved, or is not wanted: removes this program's copy.
  void forget();

  // Copies of programs that no longer run, the latest first.
  [[nodiscard]] std::vector<LostWork> lost_work() const;
  static void remove(const LostWork& work);

 private:
  std::filesystem::path folder_, file_;
  std::chrono::steady_clock::time_point last_{};
  std::string written_;
};

}  // namespace contrejour::studio
