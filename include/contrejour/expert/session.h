// SPDX-License-Identifier: Apache-2.0
// A session: one picture of one lens as the studio saves it, complete in one file (docs/formats/session.md): the lens
// with its changes, every value that the user has set, lights and size included, its plate and its keys. Members that
// this version does not know are kept, so that a file can pass through an older program. Errors: Parse with file and
// line; Io. Thread-safety: plain values, pure functions.
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

// The photograph to which the flare is added, as `apply` reads it.
struct SessionPlate {
  std::string file;  // as it is written: from the session's folder on, or absolute; empty: no photograph
  std::string layer, part;  // of an OpenEXR file (ReadOptions); empty: the usual ones
  std::string input_space, config;  // OpenColorIO's (PlateColour); empty: as the format says
  friend bool operator==(const SessionPlate&, const SessionPlate&) = default;
};

struct Session {
  std::string lens;          // the name or the file that the lens was read from
  std::string prescription;  // the lens itself as TOML (docs/formats/lens-toml.md); empty: `lens` as it is
  params::Values values;
  SessionPlate plate = {};
  std::string animation = {};  // lights and parameters with keys (docs/formats/lights.md); empty: none
  std::vector<SessionMember> others;  // everything else in the file, in its order
};

// Whether a name is that of a session's file: it ends in ".session.json", in any case.
[[nodiscard]] CONTREJOUR_API bool is_session(std::string_view name);

// Errors: also a file of a later version; a value that the table of parameters refuses.
[[nodiscard]] CONTREJOUR_API Result<Session> read_session(std::string_view json, const std::string& file);
[[nodiscard]] CONTREJOUR_API Result<Session> read_session(const std::filesystem::path& file);

// Reads back as the same session. A member of `others` that is not valid JSON is left out.
[[nodiscard]] CONTREJOUR_API std::string write_session(const Session& session);

// The plate's file for a session that was read from `session_file`, or is to be written there; empty: no plate.
[[nodiscard]] CONTREJOUR_API std::filesystem::path plate_file(const SessionPlate& plate,
                                                              const std::filesystem::path& session_file);

// The lens of a session. Errors: also those of find_lens().
[[nodiscard]] CONTREJOUR_API Result<Prescription> lens_of_session(const Session& session,
                                                                  const GlassCatalogue* glasses = nullptr);

}  // namespace contrejour
