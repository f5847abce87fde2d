// SPDX-License-Identifier: Apache-2.0
// Files without a name until they are complete: nothing remains of them if the process ends before.
#pragma once

#include <cstdio>
#include <filesystem>

namespace contrejour::inline internal {

// Opens an unnamed file for writing in the folder of `spare_name`, a name that no file has. Null if the system or the
// file system has no unnamed files, or cannot name them later: this is tried with a second file and the spare name,
// which is free again at return.
[[nodiscard]] std::FILE* open_unnamed_file(const std::filesystem::path& spare_name);

// Gives the file a name in the same folder that no file has yet; its data must have been flushed. Returns 0 or the
// error's number.
[[nodiscard]] int name_unnamed_file(std::FILE* file, const std::filesystem::path& name);

}  // namespace contrejour::inline internal
