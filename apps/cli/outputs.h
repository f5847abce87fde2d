// SPDX-License-Identifier: Apache-2.0
// The files that a command writes: all of them appear when everything succeeded, none otherwise (output_file.h).
// Thread-safety: from one thread only.
#pragma once

#include <deque>
#include <span>
#include <string>
#include <utility>

#include "contrejour/expert/output_file.h"
#include "contrejour/result.h"

namespace contrejour::cli {

class Outputs {
 public:
  // Returns the file to write into; null for an empty name, which means a file that is not requested. Checks at once
  // that the folder can be written to, so that a long task does not fail at its end. Errors: Io; InvalidArgument for a
  // file named twice.
  [[nodiscard]] Result<OutputFile*> add(const std::string& destination);

  // Adds several files: each name, and where to store the file to write into.
  [[nodiscard]] Result<void> add_all(std::span<const std::pair<const std::string&, OutputFile*&>> files);

  // Errors: Io, Cancelled.
  [[nodiscard]] Result<void> commit();

 private:
  std::deque<OutputFile> files_;  // a deque, since its elements do not move
};

}  // namespace contrejour::cli
