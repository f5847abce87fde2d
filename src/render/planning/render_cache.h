// SPDX-License-Identifier: Apache-2.0
// What successive frames have in common, so that it is computed only once. A section is a class of the layer that fills
// it. Its type Key contains everything that the section's contents depend on and is comparable with ==; a section is
// made from a key, and is replaced once another key is requested. Its memory_bytes() is approximate: of its large
// arrays. If it has a member next_frame(), that is called before each frame but the first, to drop what is not used; if
// it has a constant kMaxBytes, a section that takes more is dropped then.
// Thread-safety: section(), next_frame() and memory_bytes() from one thread at a time; each section's header states
// what the section itself allows.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <typeindex>
#include <utility>

namespace contrejour::inline internal {

class RenderCache {
 public:
  // The section of this type for a key. A caller that holds the section of an older key keeps it unchanged.
  template <class Section>
  [[nodiscard]] std::shared_ptr<Section> section(const typename Section::Key& key) {
    std::unique_ptr<Slot>& slot = sections_[typeid(Section)];
    auto* const kept = static_cast<Kept<Section>*>(slot.get());
    if (kept != nullptr && kept->key == key) return kept->section;
    auto made = std::make_unique<Kept<Section>>(key);
    const std::shared_ptr<Section> section = made->section;
    slot = std::move(made);
    return section;
  }

  // The present section; null if none has been requested yet.
  template <class Section>
  [[nodiscard]] std::shared_ptr<const Section> find() const {
    const auto found = sections_.find(typeid(Section));
    return found == sections_.end() ? nullptr : static_cast<const Kept<Section>&>(*found->second).section;
  }

  void next_frame() {
    std::erase_if(sections_, [](const auto& section) { return !section.second->next_frame(); });
  }

  [[nodiscard]] std::size_t memory_bytes() const {
    std::size_t bytes = 0;
    for (const auto& [type, slot] : sections_) bytes += slot->memory_bytes();
    return bytes;
  }

 private:
  struct Slot {
    Slot() = default;
    Slot(const Slot&) = delete;
    Slot& operator=(const Slot&) = delete;
    virtual ~Slot() = default;
    [[nodiscard]] virtual bool next_frame() = 0;  // false: the section has grown too large
    [[nodiscard]] virtual std::size_t memory_bytes() const = 0;
  };

  template <class Section>
  struct Kept : Slot {
    explicit Kept(const typename Section::Key& of) : key(of), section(std::make_shared<Section>(of)) {}
    [[nodiscard]] bool next_frame() override {
      if constexpr (requires { section->next_frame(); }) section->next_frame();
      if constexpr (requires { Section::kMaxBytes; }) return section->memory_bytes() <= Section::kMaxBytes;
      return true;
    }
    [[nodiscard]] std::size_t memory_bytes() const override { return section->memory_bytes(); }

    typename Section::Key key;
    std::shared_ptr<Section> section;
  };

  std::map<std::type_index, std::unique_ptr<Slot>> sections_;
};

}  // namespace contrejour::inline internal
