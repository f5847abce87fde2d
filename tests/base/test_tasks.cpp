// SPDX-License-Identifier: Apache-2.0
// The guarantee that all renderers rely on: the number of threads changes the time of a computation, not its result.
#include "base/tasks.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <thread>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

namespace contrejour {
namespace {

constexpr std::size_t kItems = 500;
const std::vector<int> kThreadCounts = {1, 2, 7};

Context with_threads(int threads) {
  Context context;
  context.threads = threads;
  return context;
}

// Takes longer for some items than for others, so that they finish out of order.
void dawdle(std::size_t i) {
  if (i % 7 == 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
}

// Terms of very different size: their float sum depends on the order of addition.
float term(std::size_t i) {
  const float x = static_cast<float>(i);
  return std::sin(x * 1.7F) * std::pow(10.0F, static_cast<float>(i % 9) - 4.0F);
}

TEST_CASE("parallel_for visits every index once") {
  for (const int threads : kThreadCounts) {
    CAPTURE(threads);
    std::vector<std::atomic<int>> visits(kItems);
    CHECK(parallel_for(kItems, with_threads(threads), [&](std::size_t i) { ++visits[i]; }));
    for (std::size_t i = 0; i < kItems; ++i) CHECK(visits[i] == 1);
  }
}

TEST_CASE("loops over nothing succeed and call nothing") {
  int calls = 0;
  Context context = with_threads(2);
  context.progress = [&](double) { ++calls; };
  CHECK(parallel_for(0, context, [&](std::size_t) { ++calls; }));
  CHECK(ordered_pipeline(0, context, [&](std::size_t i) { return i; }, [&](std::size_t, std::size_t) { ++calls; }));
  CHECK(calls == 0);
}

TEST_CASE("zero threads means all cores, and works") {
  std::atomic<int> visits = 0;
  CHECK(parallel_for(kItems, with_threads(0), [&](std::size_t) { ++visits; }));
  CHECK(visits == static_cast<int>(kItems));
}

TEST_CASE("no more threads work at once than the context allows") {
  for (const int threads : kThreadCounts) {
    CAPTURE(threads);
    std::atomic<int> working = 0;
    std::atomic<int> largest = 0;
    parallel_for(200, with_threads(threads), [&](std::size_t) {
      const int now = ++working;
      int seen = largest.load();
      while (now > seen && !largest.compare_exchange_weak(seen, now)) {
      }
      std::this_thread::sleep_for(std::chrono::microseconds(100));
      --working;
    });
    CHECK(largest >= 1);
    CHECK(largest <= threads);
  }
}

TEST_CASE("the pipeline consumes in rising order, one at a time, each product with its index") {
  for (const int threads : kThreadCounts) {
    CAPTURE(threads);
    std::vector<std::size_t> order;
    std::atomic<int> consumers = 0;
    const bool done = ordered_pipeline(
        kItems, with_threads(threads),
        [](std::size_t i) {
          dawdle(i);
          return std::vector<std::size_t>{i, i * i};
        },
        [&](std::size_t i, const std::vector<std::size_t>& product) {
          CHECK(++consumers == 1);
          CHECK(product[0] == i);
          CHECK(product[1] == i * i);
          order.push_back(i);
          --consumers;
        });
    CHECK(done);
    std::vector<std::size_t> rising(kItems);
    std::iota(rising.begin(), rising.end(), std::size_t{0});
    CHECK(order == rising);
  }
}

TEST_CASE("a float sum over the pipeline is the serial sum, bit for bit") {
  float serial = 0;
  float backwards = 0;
  for (std::size_t i = 0; i < kItems; ++i) serial += term(i);
  for (std::size_t i = kItems; i-- > 0;) backwards += term(i);
  REQUIRE(serial != backwards);  // else this test could not fail

  for (const int threads : kThreadCounts) {
    CAPTURE(threads);
    float sum = 0;
    ordered_pipeline(
        kItems, with_threads(threads),
        [](std::size_t i) {
          dawdle(i);
          return term(i);
        },
        [&](std::size_t, float value) { sum += value; });
    CHECK(sum == serial);
  }
}

TEST_CASE("the pipeline keeps a bounded number of products alive") {
  struct Product {
    explicit Product(std::atomic<int>* counter) : alive(counter) { ++*alive; }
    Product(Product&& other) noexcept : alive(std::exchange(other.alive, nullptr)) {}
    Product(const Product&) = delete;
    Product& operator=(const Product&) = delete;
    Product& operator=(Product&&) = delete;
    ~Product() {
      if (alive != nullptr) --*alive;
    }
    std::atomic<int>* alive;
  };
  for (const int threads : kThreadCounts) {
    CAPTURE(threads);
    std::atomic<int> alive = 0;
    int largest = 0;
    ordered_pipeline(
        kItems, with_threads(threads), [&](std::size_t) { return Product(&alive); },
        [&](std::size_t, const Product&) {
          largest = std::max(largest, alive.load());
          std::this_thread::sleep_for(std::chrono::microseconds(50));  // lets the producers run ahead
        });
    CHECK(alive == 0);
    CHECK(largest >= 1);
    CHECK(largest <= 4 * threads);  // far below kItems; the pipeline holds two for each thread
  }
}

TEST_CASE("progress rises, is never called by two threads at once, and ends at 1") {
  for (const int threads : kThreadCounts) {
    for (const bool ordered : {false, true}) {
      CAPTURE(threads);
      CAPTURE(ordered);
      std::vector<double> heard;
      std::atomic<int> inside = 0;
      bool alone = true;
      Context context = with_threads(threads);
      context.progress = [&](double done) {
        if (++inside != 1) alone = false;
        heard.push_back(done);
        --inside;
      };
      if (ordered) {
        ordered_pipeline(kItems, context, [](std::size_t i) { return i; }, [](std::size_t, std::size_t) {});
      } else {
        parallel_for(kItems, context, dawdle);
      }
      CHECK(alone);
      REQUIRE(heard.size() == kItems);
      for (std::size_t i = 1; i < heard.size(); ++i) CHECK(heard[i] > heard[i - 1]);
      CHECK(heard.front() > 0);
      CHECK(heard.back() == 1.0);
    }
  }
}

TEST_CASE("a set cancel flag stops before the first item") {
  const std::atomic<bool> cancel = true;
  Context context = with_threads(2);
  context.cancel = &cancel;
  std::atomic<int> calls = 0;
  CHECK_FALSE(parallel_for(kItems, context, [&](std::size_t) { ++calls; }));
  CHECK_FALSE(ordered_pipeline(
      kItems, context, [&](std::size_t i) { return i + static_cast<std::size_t>(++calls); },
      [&](std::size_t, std::size_t) { ++calls; }));
  CHECK(calls == 0);
}

TEST_CASE("cancelling half way stops soon and says so") {
  for (const int threads : kThreadCounts) {
    CAPTURE(threads);
    std::atomic<bool> cancel = false;
    Context context = with_threads(threads);
    context.cancel = &cancel;
    std::atomic<int> calls = 0;
    CHECK_FALSE(parallel_for(kItems, context, [&](std::size_t) {
      if (++calls == 20) cancel = true;
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }));
    CHECK(calls >= 20);
    CHECK(calls < 20 + 2 * threads);  // those already in progress

    cancel = false;
    std::vector<std::size_t> consumed;
    CHECK_FALSE(ordered_pipeline(
        kItems, context, [](std::size_t i) { return i; },
        [&](std::size_t i, std::size_t) {
          consumed.push_back(i);
          if (consumed.size() == 20) cancel = true;
        }));
    CHECK(consumed.size() == 20);
    CHECK(consumed.back() == 19);
  }
}

TEST_CASE("a held loop rests before each of its parts, for a bounded time, and then does the same work") {
  for (const int threads : kThreadCounts) {
    CAPTURE(threads);
    std::atomic<bool> hold = true;
    Context context = with_threads(threads);
    context.hold = &hold;
    const auto start = std::chrono::steady_clock::now();
    std::atomic<int> calls = 0;
    CHECK(parallel_for(1, context, [&](std::size_t) { ++calls; }));
    CHECK(ordered_pipeline(1, context, [](std::size_t i) { return i; }, [&](std::size_t, std::size_t) { ++calls; }));
    CHECK(std::chrono::steady_clock::now() - start >= std::chrono::milliseconds(2 * 8));
    CHECK(calls == 2);

    std::thread release([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      hold = false;
    });
    CHECK(parallel_for(kItems, context, [&](std::size_t) { ++calls; }));
    CHECK(calls == 2 + static_cast<int>(kItems));
    release.join();
  }
}

TEST_CASE("loops may nest") {
  std::atomic<int> visits = 0;
  CHECK(parallel_for(8, with_threads(2),
                     [&](std::size_t) { parallel_for(16, with_threads(2), [&](std::size_t) { ++visits; }); }));
  CHECK(visits == 128);
}

}  // namespace
}  // namespace contrejour
