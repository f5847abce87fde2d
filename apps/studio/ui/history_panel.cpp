// SPDX-License-Identifier: Apache-2.0
// Every command since the document was opened; a click goes back to it, or forward.
#include <fmt/format.h>

#include "studio/ui/panels.h"
#include "studio/ui/theme.h"

namespace contrejour::studio {

void draw_history_panel(Ui& ui) {
  const History& history = ui.studio.history();
  const std::size_t count = history.steps().size() - 1;
  ImGui::TextDisabled("%zu %s since it was opened. Ctrl+Z undoes, Ctrl+Shift+Z redoes.", count,
                      count == 1 ? "step" : "steps");
  ImGui::BeginChild("##history");
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(history.steps().size()));
  while (clipper.Step())
    for (int k = clipper.DisplayStart; k < clipper.DisplayEnd; ++k) {
      const auto step = static_cast<std::size_t>(k);
      const bool is_undone = step > ui.studio.history().position();
      ImGui::PushStyleColor(ImGuiCol_Text, is_undone ? colours::dim() : colours::text());
      const std::string label = fmt::format("{}##{}", ui.studio.history().steps()[step].name, k);
      if (ImGui::Selectable(label.c_str(), step == ui.studio.history().position())) ui.studio.go_to_step(step);
      ImGui::PopStyleColor();
      ui.registry.record(fmt::format("history/{}", k), ui.studio.history().steps()[step].name);
    }
  ImGui::EndChild();
}

}  // namespace contrejour::studio
