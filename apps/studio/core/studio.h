// SPDX-License-Identifier: Apache-2.0
// The studio without its window: one document with its history, what is selected, how it is looked at, and the work
// that runs for it on other threads. Panels read it and call its commands; update() takes what the work has answered.
// No call waits for a render. Thread-safety: one thread, that of the interface.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "studio/core/autosave.h"
#include "studio/core/compare.h"
#include "studio/core/display_job.h"
#include "studio/core/document.h"
#include "studio/core/exports.h"
#include "studio/core/figures_job.h"
#include "studio/core/frame_cache.h"
#include "studio/core/frame_export.h"
#include "studio/core/history.h"
#include "studio/core/looks.h"
#include "studio/core/measured_view.h"
#include "studio/core/picture_job.h"
#include "studio/core/plates.h"
#include "studio/core/point_spread.h"
#include "studio/core/view.h"
#include "studio/core/views_job.h"

namespace contrejour::studio {

struct Selection {
  std::size_t light = 0;
  std::optional<Ghost> ghost;
  int surface = 0;  // 1-based; 0: none
};

struct ExportTask {
  std::string file;
  std::function<std::string()> write;  // what went wrong; empty: nothing
};

struct ExportAnswer {
  std::string file, error;  // error: empty if it was written
};

struct StudioSettings {
  JobHost jobs = {};  // wake: an answer can be taken
  std::filesystem::path autosave_folder = {};
  LookFolders looks = {};
};

class Studio {
 public:
  Studio(std::string how_opened, Document first, StudioSettings settings);

  // Commands. False: the document stays as it was, and problem() says why.
  using Edit = std::function<Result<Document>(const Document&)>;
  bool edit(const std::string& name, const std::string& merge_key, const Edit& edit);
  void end_gesture() { history_.seal(); }
  // One like the selected light, which is then selected. at: u, v.
  bool add_light(Vec2 at);
  void undo();
  void redo();
  void go_to_step(std::size_t step);

  bool open_session(const std::string& file);
  bool open_lens(const std::string& name_or_file);  // a step of the history
  // Reads it in the background; a step of the history once it is there. The frames of a sequence ("plate.####.exr")
  // become the timeline's.
  bool open_plate(const std::string& file);
  void close_plate();
  // Finds the plate's lights in the background; a step of the history that puts them in place of the lights. False:
  // there is no plate.
  bool detect_lights();
  bool save_look(const std::string& name);  // among the user's own
  bool recover(const LostWork& work);
  bool save_session(const std::string& file);
  // Renders again at full quality and writes it, by the extension, on another thread. False: it could not be written.
  bool export_as(ExportKind kind, const std::string& file, LayersBy layers_by = LayersBy::Part);
  void stop_exporting_frames();

  // A measured flare is looked at beside the document, of which it is no part.
  void open_measured(const std::string& file);
  void choose_measured_angle(double angle_deg) { measured_job_.post({measured_.file, angle_deg, measured_sweep_}); }
  // The folder of the merged photographs that it was learned from.
  void open_measured_sweep(const std::string& folder);

  // Keys and frames (keys.h). What has keys is at its value of the frame; this is no step of the history.
  void go_to_frame(int frame);
  void play(bool plays);
  [[nodiscard]] bool is_playing() const { return playing_since_.has_value(); }
  [[nodiscard]] const FrameCache& frame_cache() const { return *frame_cache_; }

  // Snapshots of the refined picture. False: there is none yet.
  bool take_snapshot();
  void remove_snapshot(std::size_t index);
  bool restore_snapshot(std::size_t index);  // a step of the history
  void set_compare(const CompareView& compare);

  // Takes answers; posts work that the document's changes ask for. Once per frame of the interface.
  void update();

  [[nodiscard]] const Document& document() const { return history_.now(); }
  [[nodiscard]] const LensState& lens() const { return *lens_; }
  [[nodiscard]] Vec2 frame_px() const;  // the picture's width and height
  [[nodiscard]] const History& history() const { return history_; }
  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  [[nodiscard]] const std::string& problem() const { return problem_; }
  [[nodiscard]] const std::string& problem_key() const { return problem_key_; }  // merge key of the refused command
  // The message tells the last step of the history, or what its work has answered since.
  [[nodiscard]] const std::string& message() const { return message_; }
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] bool is_saved() const { return history_.is_saved(); }
  [[nodiscard]] bool is_idle() const;

  [[nodiscard]] const DisplayAnswer& shown() const { return shown_; }
  // Rises with everything that update() has taken and a window could show.
  [[nodiscard]] std::uint64_t changes() const { return changes_; }
  [[nodiscard]] std::uint64_t shown_count() const { return shown_count_; }  // of pictures taken so far
  [[nodiscard]] const std::vector<GhostFigures>& figures() const { return figures_; }
  [[nodiscard]] const std::vector<GhostFootprint>& footprints() const { return footprints_; }  // one a figure
  [[nodiscard]] bool figures_are_current() const { return figures_revision_ == revision_; }
  // The ghosts of which late drafts draw the first: the brightest where the lights are now; until the ranks are there,
  // the brightest where the selected light was at rest.
  [[nodiscard]] std::vector<Ghost> brightest_ghosts() const;
  [[nodiscard]] bool has_ranks() const { return ranks_ != nullptr; }
  [[nodiscard]] const SectionAnswer& section() const { return section_; }
  [[nodiscard]] std::shared_ptr<const Plate> plate() { return plates_.find(document().plate, view.frame); }
  // The frames of a plate that is a sequence whose files exist.
  [[nodiscard]] std::vector<int> plate_frames() const { return plates_.frames(document().plate); }
  [[nodiscard]] const std::vector<Snapshot>& snapshots() const { return snapshots_; }
  [[nodiscard]] const CompareView& compare_view() const { return compare_; }
  [[nodiscard]] const std::optional<Comparison>& comparison() const { return comparison_; }
  [[nodiscard]] const std::vector<Look>& looks() const { return looks_; }
  [[nodiscard]] const Thumbnails& thumbnails() const { return thumbnails_; }
  [[nodiscard]] const PointSpreadAnswer& point_spread() const { return point_spread_; }
  [[nodiscard]] std::uint64_t point_spread_count() const { return point_spread_count_; }  // of those taken so far
  [[nodiscard]] const std::optional<ViewsAnswer>& colour_views() const { return colour_views_; }  // none yet
  [[nodiscard]] const MeasuredAnswer& measured() const { return measured_; }
  [[nodiscard]] std::uint64_t measured_count() const { return measured_count_; }
  [[nodiscard]] const FramesAnswer& exported_frames() const { return exported_frames_; }

  Selection selection;
  View view;
  void refresh_display();  // exposure or view transform have changed
  void refresh_section();  // another ghost or light was selected
  void select_ghost(std::optional<Ghost> ghost);
  void select_light(std::size_t light);
  // A panel that shows them asks for them while it is open: they cost time that the picture needs.
  void want_point_spread(bool wanted);
  void want_thumbnails();
  void want_colour_views();  // those of the OpenColorIO configuration

  [[nodiscard]] std::vector<LostWork> lost_work() const { return autosave_.lost_work(); }
  void autosave_now() { static_cast<void>(autosave_.save(document(), file_, true)); }
  void forget_autosave() { autosave_.forget(); }

 private:
  // After an edit, whose changes become keys; in place of the document before; as it is.
  bool adopt(Result<Document> document, const std::string& name, const std::string& merge_key);
  bool adopt_whole(Result<Document> document, const std::string& name, const std::string& merge_key);
  bool push(Result<Document> document, const std::string& name, const std::string& merge_key);
  bool refuse(const Error& error, const std::string& key);
  void document_changed();
  void post_work();
  void post_picture();
  void take_view(const Document& document);
  void take_display();
  void take_section(SectionAnswer section);
  void take_problem(const std::string& problem);
  void say(std::string message);
  void take_plate(PlateAnswer answer);
  void take_new_plate(const PlateAnswer& answer);
  void take_detection(const DetectionAnswer& answer);
  void take_export(const ExportAnswer& answer);
  void take_exported_frames(const FramesAnswer& answer);
  void take_background_work();
  void show_playing_frame();
  void post_point_spread();
  void post_comparison();
  bool export_frames(const std::string& pattern);

  History history_;
  std::shared_ptr<const LensState> lens_;
  std::uint64_t revision_ = 1, figures_revision_ = 0, shown_count_ = 0, changes_ = 0;
  std::string problem_, problem_key_, message_, file_;
  DisplayAnswer shown_;
  PictureAnswer picture_;
  std::vector<GhostFigures> figures_;
  std::vector<GhostFootprint> footprints_;
  std::shared_ptr<const GhostRanks> ranks_;
  SectionAnswer section_;
  std::vector<Snapshot> snapshots_;
  std::size_t snapshots_taken_ = 0;
  CompareView compare_;
  std::optional<Comparison> comparison_;
  LookFolders look_folders_;
  std::vector<Look> looks_;
  Thumbnails thumbnails_;
  PointSpreadAnswer point_spread_;
  std::uint64_t point_spread_count_ = 0, measured_count_ = 0;
  MeasuredAnswer measured_;
  std::string measured_sweep_;  // asked for last
  std::optional<ViewsAnswer> colour_views_;
  bool wants_point_spread_ = false, wants_colour_views_ = false;
  int frame_of_picture_ = 0;  // for which the picture was asked for last
  FramesAnswer exported_frames_;
  std::shared_ptr<FrameCache> frame_cache_ = std::make_shared<FrameCache>();
  std::optional<std::chrono::steady_clock::time_point> playing_since_;
  int playing_from_ = 1;
  Autosave autosave_;

  // Last: their threads end before what they use.
  PictureJob picture_job_;
  DisplayJob display_job_;
  FiguresJob figures_job_;
  SectionJob section_job_;
  LatestJob<ExportTask, ExportAnswer> export_job_;
  Plates plates_;
  DetectionJob detection_job_;
  ViewsJob views_job_;
  CompareJob compare_job_;
  ThumbnailJob thumbnail_job_;
  PointSpreadJob point_spread_job_;
  FramesJob frames_job_;
  CacheJob cache_job_;
  MeasuredJob measured_job_;
};

}  // namespace contrejour::studio
