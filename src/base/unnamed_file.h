// Files that have no name until they are complete: nothing is left of them, whatever ends the process.
#pragma once

#include <cstdio>
#include <filesystem>

namespace contrejour {

// For writing, in the folder of `spare_name`, a name that no file has; null where the system or the file system has no
// such files, or cannot give them a name later: that is tried with another one and the spare name, which is free again
// at return.
[[nodiscard]] std::FILE* open_unnamed_file(const std::filesystem::path& spare_name);

// Gives it a name in the same folder that no file has yet; what was written must have been flushed. 0, or the error's
// number.
[[nodiscard]] int name_unnamed_file(std::FILE* file, const std::filesystem::path& name);

}  // namespace contrejour
