// SPDX-License-Identifier: Apache-2.0
// What successive frames have in common, so that it is computed only once. A section is a class of the layer that fills
// it. Its type Key contains everything that the section's contents depend on and is comparable with ==; a section is
// made from a key, and is replaced once another key is requested.
// Thread-safety: section() from one thread at a time; each section's header states what the section itself allows.
#pragma once

#include <any>
#include <map>
#include <memory>
#include <typeindex>

namespace contrejour::inline internal {

class RenderCache {
 public:
  // The section of this type for a key. A caller that holds the section of an older key keeps it unchanged.
  template <class Section>
  [[nodiscard]] std::shared_ptr<Section> section(const typename Section::Key& key) {
    std::any& slot = sections_[typeid(Section)];
    const auto* kept = std::any_cast<Kept<Section>>(&slot);
    if (kept == nullptr || !(kept->key == key))
      kept = &slot.emplace<Kept<Section>>(Kept<Section>{key, std::make_shared<Section>(key)});
    return kept->section;
  }

  // The present section; null if none has been requested yet.
  template <class Section>
  [[nodiscard]] std::shared_ptr<const Section> find() const {
    const auto found = sections_.find(typeid(Section));
    return found == sections_.end() ? nullptr : std::any_cast<const Kept<Section>&>(found->second).section;
  }

 private:
  template <class Section>
  struct Kept {
    typename Section::Key key;
    std::shared_ptr<Section> section;
  };

  std::map<std::type_index, std::any> sections_;
};

}  // namespace contrejour::inline internal
