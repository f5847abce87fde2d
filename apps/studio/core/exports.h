// SPDX-License-Identifier: Apache-2.0
// The kinds of files that a document can be exported as. Errors: InvalidArgument and Unsupported for a name that does
// not fit; those of rendering and of writing. Thread-safety: pure functions, but for the files.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/flare_layers.h"
#include "contrejour/ghost_figures.h"
#include "contrejour/lens.h"
#include "studio/core/document.h"
#include "studio/core/plate_job.h"

namespace contrejour::studio {

enum class ExportKind { Picture, Layers, Frames, Lens, Look, Report };
inline constexpr std::array<ExportKind, 6> kExportKinds = {ExportKind::Picture, ExportKind::Layers, ExportKind::Frames,
                                                           ExportKind::Lens,    ExportKind::Look,   ExportKind::Report};
[[nodiscard]] const char* name_of(ExportKind kind);
[[nodiscard]] const char* help_of(ExportKind kind);
[[nodiscard]] std::string usual_file(ExportKind kind);  // "flare.exr"
[[nodiscard]] std::vector<std::string_view> endings_of(ExportKind kind);  // that its files may have

struct ExportOrder {
  ExportKind kind = ExportKind::Picture;
  std::string file;
  Document document;
  std::shared_ptr<const LensState> lens;
  std::shared_ptr<const Plate> plate;
  LayersBy layers_by = LayersBy::Part;
  std::vector<GhostFigures> figures = {};  // for the report
};

// Whether the file's name fits and the folder can be written to, without writing.
[[nodiscard]] Result<void> check_export(const ExportOrder& order);
// Whether the export would replace a file, of frames in this range any file.
[[nodiscard]] bool would_replace(ExportKind kind, const std::string& file, int first_frame, int last_frame);

// At full quality. Frames are exported by frame_export.h.
[[nodiscard]] Result<void> export_file(const ExportOrder& order, const Context& context = {});

// One HTML page without other files: the picture, the section, the ghosts, the prescription, the settings.
[[nodiscard]] Result<std::string> report_html(const ExportOrder& order, const Context& context);

}  // namespace contrejour::studio
