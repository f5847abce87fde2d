// What frames that are rendered one after the other have in common, so that it is made only once.
// A section is a class of the layer that fills it. Its type Key says all that its contents depend on, comparable with
// ==; it is made from a key, and starts anew once another key is asked for. Thread-safety: section() from one thread at
// a time; what a section itself allows, its own header states.
#pragma once

#include <any>
#include <map>
#include <memory>
#include <typeindex>

namespace contrejour {

class RenderCache {
 public:
  // The section of that type for a key. Whoever holds one of an older key keeps it as it is.
  template <class Section>
  [[nodiscard]] std::shared_ptr<Section> section(const typename Section::Key& key) {
    std::any& slot = sections_[typeid(Section)];
    const auto* kept = std::any_cast<Kept<Section>>(&slot);
    if (kept == nullptr || !(kept->key == key))
      kept = &slot.emplace<Kept<Section>>(Kept<Section>{key, std::make_shared<Section>(key)});
    return kept->section;
  }

  // The section as it is now; null if nobody has asked for it yet.
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

}  // namespace contrejour
