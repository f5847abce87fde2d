// SPDX-License-Identifier: Apache-2.0
// The studio without its window: one document with its history, what is selected, how it is looked at, and the work
// that runs for it on other threads. Panels read it and call its commands; update() takes what the work has answered.
// No call waits for a render. Thread-safety: one thread, that of the interface.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "studio/core/autosave.h"
#include "studio/core/display_job.h"
#include "studio/core/document.h"
#include "studio/core/figures_job.h"
#include "studio/core/history.h"
#include "studio/core/picture_job.h"

namespace contrejour::studio {

struct Selection {
  std::size_t light = 0;
  std::optional<Ghost> ghost;
  int surface = 0;  // 1-based; 0: none
};

// The parts of the view that are saved with a session, apart from its content.
struct View {
  double zoom = 1.0;  // of the picture that just fits
  Vec2 pan;  // of its middle, in parts of the fitting picture's size
  ViewTransform transform = ViewTransform::Preview;
  bool shows_handles = true;
  bool shows_ghosts = true;  // outline of the selected ghost
};

struct StudioSettings {
  std::function<void()> wake = {};  // called on other threads when an answer can be taken
  std::filesystem::path autosave_folder = {};
};

class Studio {
 public:
  Studio(std::string how_opened, Document first, StudioSettings settings);

  // Commands. False: the document stays as it was, and problem() says why.
  using Edit = std::function<Result<Document>(const Document&)>;
  bool edit(const std::string& name, const std::string& merge_key, const Edit& edit);
  void end_gesture() { history_.seal(); }
  void undo();
  void redo();
  void go_to_step(std::size_t step);

  bool open_session(const std::string& file);
  bool open_lens(const std::string& name_or_file);  // a step of the history
  bool open_plate(const std::string& file);
  bool recover(const LostWork& work);
  bool save_session(const std::string& file);
  // Renders the picture again at full quality and writes it, by the extension, on another thread.
  bool export_picture(const std::string& file);

  // Takes answers; posts work that the document's changes ask for. Once per frame of the interface.
  void update();

  [[nodiscard]] const Document& document() const { return history_.now(); }
  [[nodiscard]] const LensState& lens() const { return *lens_; }
  [[nodiscard]] const History& history() const { return history_; }
  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  [[nodiscard]] const std::string& problem() const { return problem_; }
  [[nodiscard]] const std::string& problem_key() const { return problem_key_; }  // merge key of the refused command
  [[nodiscard]] const std::string& message() const { return message_; }
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] bool is_saved() const { return history_.is_saved(); }
  [[nodiscard]] bool is_idle() const;

  [[nodiscard]] const DisplayAnswer& shown() const { return shown_; }
  // Rises with everything that update() has taken and a window could show.
  [[nodiscard]] std::uint64_t changes() const { return changes_; }
  [[nodiscard]] std::uint64_t shown_count() const { return shown_count_; }  // of pictures taken so far
  [[nodiscard]] const std::vector<GhostFigures>& figures() const { return figures_; }
  [[nodiscard]] bool figures_are_current() const { return figures_revision_ == revision_; }
  [[nodiscard]] const SectionAnswer& section() const { return section_; }

  Selection selection;
  View view;
  void refresh_display();  // exposure or view transform have changed
  void refresh_section();  // another ghost or light was selected
  void select_ghost(std::optional<Ghost> ghost);
  void select_light(std::size_t light);

  [[nodiscard]] std::vector<LostWork> lost_work() const { return autosave_.lost_work(); }
  void autosave_now() { static_cast<void>(autosave_.save(document(), file_, true)); }
  void forget_autosave() { autosave_.forget(); }

 private:
  bool adopt(Result<Document> document, const std::string& name, const std::string& merge_key);
  bool refuse(const Error& error, const std::string& key);
  void document_changed();
  void post_work();
  void take_view(const Document& document);
  void take_display();
  void take_section(SectionAnswer section);
  void take_problem(const std::string& problem);
  void say(std::string message);

  History history_;
  std::shared_ptr<const LensState> lens_;
  std::uint64_t revision_ = 1, figures_revision_ = 0, shown_count_ = 0, changes_ = 0;
  std::string problem_, problem_key_, message_, file_;
  std::shared_ptr<const Image> plate_;
  DisplayAnswer shown_;
  PictureAnswer picture_;
  std::vector<GhostFigures> figures_;
  SectionAnswer section_;
  Autosave autosave_;

  // Last: their threads end before what they use.
  PictureJob picture_job_;
  DisplayJob display_job_;
  FiguresJob figures_job_;
  SectionJob section_job_;
  LatestJob<std::function<std::string()>, std::string> export_job_;
};

}  // namespace contrejour::studio
