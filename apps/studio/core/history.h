// SPDX-License-Identifier: Apache-2.0
// Every state of a document since it was opened, each with the name of the command that made it. Undo has no limit: a
// state costs some kilobytes, since lenses are shared. Commands of one gesture (a drag, a slider) have the same merge
// key and become one step, until seal() ends the gesture. Thread-safety: a plain value.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "studio/core/document.h"

namespace contrejour::studio {

class History {
 public:
  struct Step {
    std::string name;  // "move light 1"; of the first step, how the document was opened
    std::string merge_key;  // empty: merges with nothing
    std::shared_ptr<const Document> document;
  };

  History(std::string name, Document first);

  [[nodiscard]] const Document& now() const { return *steps_[position_].document; }
  [[nodiscard]] std::shared_ptr<const Document> shared_now() const { return steps_[position_].document; }

  // Commands that had been undone are dropped.
  void push(std::string name, std::string merge_key, Document next);
  void seal() { sealed_ = true; }
  // The same state seen at another frame: no step.
  void replace_now(Document document);

  [[nodiscard]] bool can_undo() const { return position_ > 0; }
  [[nodiscard]] bool can_redo() const { return position_ + 1 < steps_.size(); }
  void undo();
  void redo();
  void go_to(std::size_t step);

  [[nodiscard]] const std::vector<Step>& steps() const { return steps_; }
  [[nodiscard]] std::size_t position() const { return position_; }

  void mark_saved() { saved_ = steps_[position_].document; }
  [[nodiscard]] bool is_saved() const { return saved_ == steps_[position_].document; }

 private:
  std::vector<Step> steps_;
  std::size_t position_ = 0;
  std::shared_ptr<const Document> saved_;
  bool sealed_ = true;
};

}  // namespace contrejour::studio
