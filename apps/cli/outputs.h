// The files a command writes: all of them appear when everything worked, none otherwise (output_file.h).
// Not for sharing by threads.
#pragma once

#include <deque>
#include <span>
#include <string>
#include <utility>

#include "contrejour/output_file.h"
#include "contrejour/result.h"

namespace contrejour::cli {

class Outputs {
 public:
  // What to write into; null for an empty name: a file that was not asked for. Finds out at once whether that folder
  // can be written to, so that long work does not end with nowhere to put it. Errors: Io; InvalidArgument for a file
  // named twice.
  [[nodiscard]] Result<OutputFile*> add(const std::string& destination);

  // The same for several: each name, and where to say what to write into.
  [[nodiscard]] Result<void> add_all(std::span<const std::pair<const std::string&, OutputFile*&>> files);

  // Errors: Io, Cancelled.
  [[nodiscard]] Result<void> commit();

 private:
  std::deque<OutputFile> files_;  // which stay where they are
};

}  // namespace contrejour::cli
