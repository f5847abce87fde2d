// SPDX-License-Identifier: Apache-2.0
// A pool of objects that are costly to make and used by one thread at a time: they are lent and given back.
// Thread-safety: safe.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace contrejour::inline internal {

template <class Thing>
class Pool {
 public:
  class Lent {
   public:
    Lent(Pool& pool, std::unique_ptr<Thing> thing) : pool_(pool), thing_(std::move(thing)) {}
    Lent(const Lent&) = delete;
    Lent& operator=(const Lent&) = delete;
    ~Lent() { pool_.give_back(std::move(thing_)); }
    [[nodiscard]] Thing& operator*() const { return *thing_; }

   private:
    Pool& pool_;
    std::unique_ptr<Thing> thing_;
  };

  // Lends an object in the state in which it was given back, or a new one.
  [[nodiscard]] Lent lend() {
    const std::lock_guard lock(mutex_);
    if (unused_.empty()) return Lent(*this, std::make_unique<Thing>());
    auto thing = std::move(unused_.back());
    unused_.pop_back();
    return Lent(*this, std::move(thing));
  }

  // The sum over the objects that are not lent.
  template <class BytesOf>
  [[nodiscard]] std::size_t bytes(const BytesOf& bytes_of) const {
    const std::lock_guard lock(mutex_);
    std::size_t sum = 0;
    for (const auto& thing : unused_) sum += bytes_of(*thing);
    return sum;
  }

 private:
  void give_back(std::unique_ptr<Thing> thing) {
    const std::lock_guard lock(mutex_);
    unused_.push_back(std::move(thing));
  }

  mutable std::mutex mutex_;
  std::vector<std::unique_ptr<Thing>> unused_;
};

}  // namespace contrejour::inline internal
