// SPDX-License-Identifier: Apache-2.0
#include "studio/core/history.h"

#include <algorithm>
#include <utility>

namespace contrejour::studio {

History::History(std::string name, Document first) {
  steps_.push_back({std::move(name), {}, std::make_shared<const Document>(std::move(first))});
  mark_saved();
}

void History::push(std::string name, std::string merge_key, Document next) {
  steps_.resize(position_ + 1);
  auto document = std::make_shared<const Document>(std::move(next));
  const bool merges = !sealed_ && !merge_key.empty() && position_ > 0 && steps_.back().merge_key == merge_key;
  if (merges) {
    steps_.back().document = std::move(document);
  } else {
    steps_.push_back({std::move(name), std::move(merge_key), std::move(document)});
    ++position_;
  }
  sealed_ = false;
}

void History::replace_now(Document document) {
  const bool was_saved = is_saved();
  steps_[position_].document = std::make_shared<const Document>(std::move(document));
  if (was_saved) mark_saved();
}

void History::undo() {
  if (can_undo()) go_to(position_ - 1);
}

void History::redo() {
  if (can_redo()) go_to(position_ + 1);
}

void History::go_to(std::size_t step) {
  position_ = std::min(step, steps_.size() - 1);
  seal();
}

}  // namespace contrejour::studio
