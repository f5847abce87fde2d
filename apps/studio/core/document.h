// SPDX-License-Identifier: Apache-2.0
// The document that the studio edits: one lens and the values that the user has set, as a plain value. Every edit makes
// a new document from an old one, which costs little: the lens is shared. Errors: those of the table of parameters.
// Thread-safety: plain values, pure functions.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/expert/animation.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/expert/session.h"
#include "contrejour/lens.h"

namespace contrejour::studio {

using ValueTexts = std::map<std::string, std::vector<std::string>, std::less<>>;

struct Document {
  std::string lens_name;  // the bundled lens or the file that the lens was read from
  std::shared_ptr<const Prescription> lens;  // never null
  bool lens_was_edited = false;  // it is no longer the one that lens_name names
  ValueTexts texts;  // by parameter, each a value that the table accepts; what is missing has its default
  SessionPlate plate = {};  // the photograph behind the flare; its file is absolute
  Animation animation = {};  // what has keys; the values above are those of the frame at hand (keys.h)
  std::vector<SessionMember> others;  // members of the session's file that the studio does not know

  [[nodiscard]] params::Values values() const;
  [[nodiscard]] bool has_plate() const { return !plate.file.empty(); }
  // Given, or the default; empty where neither is.
  [[nodiscard]] std::string text(std::string_view name) const;
  [[nodiscard]] std::vector<std::string> list(std::string_view name) const;
};

// The scene of the first start.
[[nodiscard]] Document first_document();
// A lens with the lights, size, exposure and f-number of another document, and with its own coatings. An f-number that
// it does not have becomes its widest.
[[nodiscard]] Result<Document> document_with_lens(const Document& scene, const std::string& lens_name);
// A preset in the scene of another document.
[[nodiscard]] Result<Document> document_with_preset(const Document& scene, const std::string& preset_name);

// file: the session's, from which the plate's name counts.
[[nodiscard]] Result<Document> document_of(const Session& session, const std::filesystem::path& file = {});
// The lens is always embedded, so that the file opens without the lens's own. The name of a plate in the session's
// folder, or below it, becomes a relative one, so that the folder can be moved.
[[nodiscard]] Session session_of(const Document& document, const std::filesystem::path& file = {});

[[nodiscard]] Result<Document> with_value(Document document, std::string_view name, const std::string& text);
// In place of all values of a parameter that repeats; none: its default.
[[nodiscard]] Result<Document> with_values(Document document, std::string_view name,
                                           const std::vector<std::string>& texts);
[[nodiscard]] Document without_value(Document document, std::string_view name);
// The picture then has the plate's size. Its own lights are not sought while the user's lights stand for them.
[[nodiscard]] Document with_plate(Document document, const SessionPlate& plate, int width, int height);
[[nodiscard]] Document without_plate(Document document);
// Coatings of surfaces that no longer bound glass are left out.
[[nodiscard]] Document with_edited_lens(Document document, Prescription lens);

}  // namespace contrejour::studio
