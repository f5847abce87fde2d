// SPDX-License-Identifier: Apache-2.0
// Coatings, gains and selections of a document after its surfaces have other numbers.
#include <doctest/doctest.h>

#include "contrejour/expert/settings.h"
#include "studio/core/coating_curves.h"
#include "studio/core/prescription_table.h"
#include "studio/core/surface_numbers.h"

namespace contrejour::studio {
namespace {

using Texts = std::vector<std::string>;

Document scene_with_changed_ghosts() {
  Document document = first_document();
  document.texts["ghost"] = {"2-5:gain=2", "3-7:gain=0", "7:colour=1,0.5,0"};
  document.texts["select"] = {"list:2-5,3-7"};
  return document;
}

}  // namespace

TEST_CASE("the first scene's coatings do not prevent its surfaces from being deleted, inserted and reversed") {
  const Document first = first_document();
  const std::size_t count = first.lens->surfaces.size();
  for (std::size_t row = 0; row < count; ++row) {
    CAPTURE(row);
    if (const auto lens = without_surface(*first.lens, row)) {
      const Document edited = with_edited_lens(with_surface_numbers(first, numbers_after_deletion(count, row)), *lens);
      const auto state = params::lens_of(*edited.lens, edited.values());
      CHECK((state || state.error().message.find("coating") == std::string::npos));
    }
    if (const auto lens = with_inserted_surface(*first.lens, row)) {
      const Document edited = with_edited_lens(with_surface_numbers(first, numbers_after_insertion(count, row)), *lens);
      const auto state = params::lens_of(*edited.lens, edited.values());
      CHECK((state || state.error().message.find("coating") == std::string::npos));
    }
  }
  const auto reversed = reversed_lens(*first.lens);
  REQUIRE(reversed);
  const Document edited = with_edited_lens(with_surface_numbers(first, numbers_after_reversal(count)), *reversed);
  CHECK(edited.list("coating-at").size() == first.list("coating-at").size());
  CHECK(coating_of_surface(edited, 1) == coating_of_surface(first, static_cast<int>(count)));
}

TEST_CASE("coatings, gains and selections follow the surfaces that they mean") {
  const Document first = scene_with_changed_ghosts();
  const std::size_t count = first.lens->surfaces.size();
  const Document deleted = with_surface_numbers(first, numbers_after_deletion(count, 5));  // surface 6
  CHECK(deleted.list("coating-at") == Texts{"10:quarter-wave:700:1.38", "12:quarter-wave:660:1.38",
                                            "13:quarter-wave:480:1.38", "15:quarter-wave:560:1.38"});
  CHECK(deleted.list("ghost") == Texts{"2-5:gain=2", "3-6:gain=0", "6:colour=1,0.5,0"});
  CHECK(deleted.text("select") == "list:2-5,3-6");
  const Document inserted = with_surface_numbers(first, numbers_after_insertion(count, 1));  // behind surface 2
  CHECK(inserted.list("ghost") == Texts{"2-6:gain=2", "4-8:gain=0", "8:colour=1,0.5,0"});
  CHECK(inserted.list("coating-at").front() == "7:quarter-wave:640:1.38");
  const Document gone = with_surface_numbers(first, numbers_after_deletion(count, 2));  // surface 3
  CHECK(gone.list("ghost") == Texts{"2-4:gain=2", "6:colour=1,0.5,0"});
  CHECK(gone.text("select") == "list:2-4");
  const Document reversed = with_surface_numbers(first, numbers_after_reversal(16));
  CHECK(reversed.list("ghost").front() == "12-15:gain=2");
}

}  // namespace contrejour::studio
