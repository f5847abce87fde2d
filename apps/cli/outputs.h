// The files a command writes: all of them appear when everything worked, none otherwise.
// Each is written beside its destination under a temporary name and renamed at the end; a destination that is no
// regular file (a pipe, a device) is written directly. Not for sharing by threads.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/result.h"

namespace contrejour::cli {

class Outputs {
 public:
  Outputs() = default;
  Outputs(const Outputs&) = delete;
  Outputs& operator=(const Outputs&) = delete;
  ~Outputs();  // removes what was not committed

  // Where to write what shall end at `destination`. Finds out at once whether that folder can be written to, so
  // that long work does not end with nowhere to put it. Errors: Io; InvalidArgument for a file named twice.
  [[nodiscard]] Result<std::filesystem::path> add(const std::filesystem::path& destination);

  // Errors: Io, Cancelled.
  [[nodiscard]] Result<void> commit();

 private:
  struct Pending {
    std::filesystem::path destination, temporary;
  };
  std::vector<Pending> pending_;
  std::vector<std::filesystem::path> named_;
};

[[nodiscard]] Result<void> write_text(const std::filesystem::path& file, std::string_view text);

}  // namespace contrejour::cli
