// SPDX-License-Identifier: Apache-2.0
// Values that were costly to compute, by key, as long as frames use them: a value that kFrames frames in a row did not
// ask for is dropped, and nothing is added beyond a number of bytes.
// Thread-safety: safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

namespace contrejour::inline internal {

// Key is ordered by <; values are copied out.
template <class Key, class Value>
class RecentlyUsed {
 public:
  static constexpr std::uint64_t kFrames = 4;

  explicit RecentlyUsed(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  [[nodiscard]] std::optional<Value> find(const Key& key) {
    const std::scoped_lock lock(mutex_);
    const auto found = entries_.find(key);
    if (found == entries_.end()) return std::nullopt;
    found->second.used = frame_;
    return found->second.value;
  }

  // bytes: what the key and the value take. A key that is there already keeps its value.
  void keep(Key key, Value value, std::size_t bytes) {
    const std::scoped_lock lock(mutex_);
    if (bytes > max_bytes_ - bytes_) return;
    if (entries_.try_emplace(std::move(key), Entry{std::move(value), bytes, frame_}).second) bytes_ += bytes;
  }

  void next_frame() {
    const std::scoped_lock lock(mutex_);
    ++frame_;
    for (auto entry = entries_.begin(); entry != entries_.end();) {
      const bool is_used = entry->second.used + kFrames > frame_;
      if (!is_used) bytes_ -= entry->second.bytes;
      entry = is_used ? std::next(entry) : entries_.erase(entry);
    }
  }

  [[nodiscard]] std::size_t bytes() const {
    const std::scoped_lock lock(mutex_);
    return bytes_;
  }

 private:
  struct Entry {
    Value value;
    std::size_t bytes = 0;
    std::uint64_t used = 0;  // the latest frame that asked for it
  };

  std::size_t max_bytes_;
  mutable std::mutex mutex_;
  std::map<Key, Entry> entries_;
  std::size_t bytes_ = 0;
  std::uint64_t frame_ = 0;
};

}  // namespace contrejour::inline internal
