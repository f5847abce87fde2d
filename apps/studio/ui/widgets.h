// SPDX-License-Identifier: Apache-2.0
// The widgets that panels are made of, which also record where they are, under a name that does not change, for the
// test port and for the dump of the state. Thread-safety: the thread of the interface.
#pragma once

#include <array>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <imgui.h>

#include "studio/core/ghost_order.h"
#include "studio/core/keys.h"
#include "studio/core/section_edits.h"
#include "studio/core/studio.h"

namespace contrejour::studio {

struct WidgetRecord {
  std::string id;  // "ghosts/3-8/solo"
  ImVec2 min, max;
  std::string value;
  bool is_clipped = false;  // a part of it lies outside its panel
  bool is_hidden = false;  // its middle does
  bool is_cut = false;  // its text is longer than it
};

class WidgetRegistry {
 public:
  void begin_frame() { widgets_.clear(); }
  // The item that Dear ImGui has drawn last, or a rectangle.
  void record(std::string id, std::string value = {});
  void record(std::string id, ImVec2 min, ImVec2 max, std::string value = {});
  void mark_cut() { widgets_.back().is_cut = true; }  // the last one
  [[nodiscard]] const WidgetRecord* find(const std::string& id) const;
  [[nodiscard]] const std::vector<WidgetRecord>& all() const { return widgets_; }

 private:
  std::vector<WidgetRecord> widgets_;
};

enum class SideTab { Ghosts, Lights, Looks, Parameters, History };
enum class BottomTab { Section, Prescription, Coatings, Iris, Timeline, Compare, Measured };
enum class Dialog { None, OpenLens, OpenPlate, OpenSweep, SaveAs, Export, Recover, Quit };

// A cell or a field that is typed into, until it is accepted.
struct TextEdit {
  std::string id;  // of the widget; empty: none
  std::string text;
  std::string offered;  // the completion under the mouse; empty: none
  std::string refused_id, refused_text, reason;  // the last text that was not accepted
  std::string entered_over, refused_over;  // the value in force when a text was entered, and when one was refused
  std::size_t refused_at = 0;  // step of the history
};

// The drag of a light that goes on; it ends with the button.
struct LightDrag {
  bool on = false;
  std::size_t light = 0;
  ImVec2 grip;  // from the mouse to the light
};

// A surface that is dragged in the section, as it was before.
struct SurfaceDrag {
  bool on = false, has_moved = false;
  int surface = 0;  // 1-based
  SurfaceGrip grip = SurfaceGrip::Vertex;
  float from_x = 0;  // of the mouse
  float scale = 1;  // of the screen per mm
  std::shared_ptr<const Prescription> lens;
};

// A key that is dragged along the timeline.
struct KeyDrag {
  bool on = false;
  TrackId track;
  int frame = 0;
};

// A number that is dragged: it goes on through values that are refused, such as an iris of one blade.
struct NumberDrag {
  std::string id;  // empty: none
  float value = 0;
};

// A bundled lens in the list of lenses.
struct ListedLens {
  std::string name, full_name;  // "planar-50", "Zeiss Planar 50mm f/1.4"
};

// The state of the interface that is neither document nor view.
struct InterfaceState {
  SideTab side = SideTab::Ghosts;
  BottomTab bottom = BottomTab::Section;
  bool side_was_chosen = false, bottom_was_chosen = false;  // by a key: the tab bar follows
  bool shows_panels = true, shows_help = false;
  Dialog dialog = Dialog::None;
  bool dialog_opens = false, dialog_has_failed = false;
  std::string path, ghost_filter, parameter_filter, lens_filter;
  std::array<std::string, 8> folders;  // in which each dialog opens, as Dialog; empty: the program's
  std::array<std::string, kExportKinds.size()> exported;  // the last file's name of each kind
  bool shows_all_files = false, path_wants_keys = false, selects_name = false;  // of file dialogs
  std::vector<ListedLens> lenses;  // the bundled ones, once their list was opened
  std::string asked_path;  // the file that the user was asked about, since it exists
  GhostOrder ghost_order = GhostOrder::Visibility;
  float side_width = 450, bottom_height = 272;  // at scale 1
  int coating_in_sight = 0, row_in_sight = 0;  // the surfaces that lists were scrolled to last
  std::optional<Ghost> ghost_in_sight;  // the same of the ghosts' list
  TextEdit edit;
  LightDrag drag;
  ExportKind export_kind = ExportKind::Picture;
  int export_layers = 2;  // as LayersBy
  int measured_curve = 0;  // as GhostCurve
  std::string look_name;  // typed for a look to be saved
  KeyDrag key_drag;
  NumberDrag number_drag;
  SurfaceDrag surface_drag;
  bool drags_wipe = false;
  bool viewport_has_keys = true;  // arrows and Tab are the viewport's
  ImVec2 probe{-1, -1};  // the picture's pixel under the mouse; negative: none
  bool asks_to_quit = false, wants_to_quit = false;
  bool quits_when_saved = false;  // the dialog that saves was opened on the way out
  double started_scale = 1;  // of the interface
  std::vector<LostWork> lost;
};

inline constexpr Vec2 kPlaceOfNewLight{0.5, 0.4};

// The scale of the interface: that which the user has set, else that of the start.
[[nodiscard]] inline double scale_of(const View& view, const InterfaceState& state) {
  return view.interface_scale > 0 ? view.interface_scale : state.started_scale;
}

// The arguments of every panel.
struct Ui {
  Studio& studio;
  InterfaceState& state;
  WidgetRegistry& registry;
};

bool button(Ui& ui, const std::string& id, const char* label, const char* tip = nullptr, ImVec2 size = {0, 0});
// A small square that is lit while on.
bool toggle(Ui& ui, const std::string& id, const char* label, bool on, ImU32 lit, const char* tip);
void tip(const char* text);
// Goes on in the same line so far to the right that buttons with these labels, and other items of this width, just fit.
void align_right(std::initializer_list<const char*> labels, float others = 0);
void colour_patch(ImU32 colour, float width);
// A text of which the last part is left out where it does not fit.
void fitting_text(const std::string& text, float width, ImU32 colour);
// The text, or its beginning and an ellipsis that are at most so wide.
[[nodiscard]] std::string fitted(const std::string& text, float width);
[[nodiscard]] float text_width(const std::string& text);
// ASCII letters in any case.
[[nodiscard]] bool contains_in_any_case(std::string_view text, std::string_view part);
// The headings of a table's columns, each with its tip. Columns of fields: their padding.
void heading_row(std::initializer_list<const char*> tips, int first_field = 0, int fields = 0, float indent = 0);
// A text field that keeps what is typed until Enter or a click elsewhere; true when it is to be accepted, `text` then
// has it. Refused text stays, in red, with the reason as its tip, until the value changes or a step is undone.
// complete: what Tab makes of the text; none: Tab goes on.
bool text_field(Ui& ui, const std::string& id, std::string& text, float width, const char* hint = "",
                std::string (*complete)(const std::string& text) = nullptr);
void refuse_text(Ui& ui, const std::string& id, const std::string& text, const std::string& reason);

// A list of completions below the item drawn last, or above it where it would not fit; ends with ImGui::End(). The
// field keeps the keyboard.
void begin_completions(std::size_t lines);
// One of them; true while the mouse is over it.
[[nodiscard]] bool completion(const std::string& text);

// A number between two limits, which is dragged by hand and shown as a bar below it, too; true if it has changed.
[[nodiscard]] bool drag_bar(const char* label, float& value, float low, float high, const char* format,
                            ImGuiSliderFlags flags = 0);

// The item drawn last, in a list that scrolls.
[[nodiscard]] bool is_wholly_in_sight();
// Scrolls the list to the item drawn last if its surface is selected, once.
void bring_into_sight(const Ui& ui, int surface, int& in_sight);

// The name that the last export of the chosen kind had, or its usual one.
[[nodiscard]] std::string file_to_export(const Ui& ui);

// In the folder that it was left in, if the path has none. A session to be saved gets a name.
void open_dialog(Ui& ui, Dialog dialog, std::string path = {});

[[nodiscard]] ImU32 display_colour(const Rgb& rgb, double brightest);

}  // namespace contrejour::studio
