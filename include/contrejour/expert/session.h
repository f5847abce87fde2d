// SPDX-License-Identifier: Apache-2.0
// A session: one picture of one lens as the studio saves it, complete in one file (docs/formats/session.md): the lens
// with its changes, and every value that the user has set, lights and size included. Keys that this version does not
// know are kept, so that a file can pass through an older program.
// Errors: Parse with file and line; Io. Thread-safety: plain values, pure functions.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/expert/parameter_values.h"
#include "contrejour/export.h"
#include "contrejour/lens.h"
#include "contrejour/result.h"

namespace contrejour {

inline constexpr int kSessionVersion = 1;

// A member of the file as its JSON text, without interpretation.
struct SessionMember {
  std::string key;
  std::string json;
  friend bool operator==(const SessionMember&, const SessionMember&) = default;
};

struct Session {
  std::string lens;          // the name or the file that the lens was read from
  std::string prescription;  // the lens itself as TOML (docs/formats/lens-toml.md); empty: `lens` as it is
  params::Values values;
  std::vector<SessionMember> others;  // everything else in the file, in its order
};

// Whether a name is that of a session's file: it ends in ".session.json", in any case.
[[nodiscard]] CONTREJOUR_API bool is_session(std::string_view name);

// Errors: also a file of a later version; a value that the table of parameters refuses.
[[nodiscard]] CONTREJOUR_API Result<Session> read_session(std::string_view json, const std::string& file);
[[nodiscard]] CONTREJOUR_API Result<Session> read_session(const std::filesystem::path& file);

// Reads back as the same session. A member of `others` that is not valid JSON is left out.
[[nodiscard]] CONTREJOUR_API std::string write_session(const Session& session);

// The lens of a session. Errors: also those of find_lens().
[[nodiscard]] CONTREJOUR_API Result<Prescription> lens_of_session(const Session& session,
                                                                  const GlassCatalogue* glasses = nullptr);

}  // namespace contrejour
