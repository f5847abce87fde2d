// SPDX-License-Identifier: Apache-2.0
// The memory of pictures that are made again and again, such as the layers of a shot's frames. The system clears each
// page that it hands out, which for the layers of a frame takes as long as summing them. A picture's memory comes back
// when the picture is destroyed; what is kept is at most kMaxBytes, and nothing that kFrames frames in a row did not
// need.
// Thread-safety: safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "contrejour/image.h"

namespace contrejour::detail {

class PixelPool {
 public:
  static constexpr std::size_t kMaxBytes = std::size_t{256} << 20U;  // ten pictures of 1920x1080
  static constexpr std::uint64_t kFrames = 4;
  // A block is lent for no less than this part of it, so that small layers do not take the memory of whole pictures.
  static constexpr std::size_t kLeastPart = 2;

  PixelPool() = default;
  PixelPool(const PixelPool&) = delete;
  PixelPool& operator=(const PixelPool&) = delete;
  ~PixelPool() { close(); }

  // Memory with undefined contents: the latest that came back of the best size. Throws std::bad_alloc.
  [[nodiscard]] void* take(std::size_t bytes);
  void give_back(void* memory) noexcept;
  void next_frame();
  // Frees what is kept, and keeps nothing from now on: its renderer is gone, though some pictures may be there still.
  void close() noexcept;
  [[nodiscard]] std::size_t bytes() const;  // kept, and not lent

 private:
  struct Block {
    void* memory = nullptr;
    std::size_t bytes = 0;
    std::uint64_t used = 0;  // the frame in which it came back
  };
  void free_oldest() noexcept;

  mutable std::mutex mutex_;
  std::vector<Block> kept_;  // in the order in which they came back
  std::size_t kept_bytes_ = 0;
  std::unordered_map<void*, std::size_t> lent_;  // their sizes
  std::uint64_t frame_ = 0;
  bool is_closed_ = false;
};

}  // namespace contrejour::detail
