// SPDX-License-Identifier: Apache-2.0
#include "base/tasks.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#if defined(CONTREJOUR_TSAN)
#include <sanitizer/tsan_interface.h>
#endif

namespace contrejour::inline internal {
namespace {

// These functions declare to ThreadSanitizer how work passes between threads. The installed TBB is built without it, so
// its synchronisation looks like a race. This file, the only one with TBB's templates, is compiled without it too and
// declares each hand-over: writes before hand_over(x) are visible after take_over(x). In other builds both are empty.
#if defined(CONTREJOUR_TSAN)
void hand_over(void* token) { __tsan_release(token); }
void take_over(void* token) { __tsan_acquire(token); }
#else
void hand_over(void*) {}
void take_over(void*) {}
#endif

// Cached, because the system call takes as long as a short loop.
int core_count() {
  static const int count = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return count;
}

// Waits while the context's caller needs the processors. A caller that never releases them only slows the work down.
void rest_while_held(const Context& context) {
  using std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kLongest(8);
  constexpr std::chrono::microseconds kStep(200);
  const auto is_held = [&] { return context.hold != nullptr && context.hold->load(std::memory_order_relaxed); };
  if (!is_held()) return;
  for (const auto until = steady_clock::now() + kLongest; is_held() && steady_clock::now() < until;)
    std::this_thread::sleep_for(kStep);
}

// Passes rising fractions on to the caller, from one thread at a time.
class ProgressReport {
 public:
  ProgressReport(const Context& context, std::size_t count) : context_(context), count_(count) {}

  void item_done() {
    if (!context_.progress) return;
    const std::scoped_lock lock(mutex_);
    context_.progress(static_cast<double>(++done_) / static_cast<double>(count_));
  }

 private:
  const Context& context_;
  std::size_t count_;
  std::size_t done_ = 0;
  std::mutex mutex_;
};

// With as many threads as cores the body runs in the caller's arena, since waking the workers of a new arena takes as
// long as a short loop. It is isolated, so that no other task of the caller's runs meanwhile: the caller may hold a
// lock. An arena with more slots than cores needs a higher process-wide limit during its lifetime; so results for 7
// threads can be tested on 2 cores.
template <class Body>
void run_in_arena(int threads, Body body) {
  if (threads == core_count()) return oneapi::tbb::this_task_arena::isolate(body);
  const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                          static_cast<std::size_t>(std::max(threads, core_count())));
  oneapi::tbb::task_arena arena(threads);
  arena.execute(body);
}

}  // namespace

int thread_count(const Context& context) { return context.threads > 0 ? context.threads : core_count(); }

bool parallel_for(std::size_t count, const Context& context, const std::function<void(std::size_t)>& body) {
  ProgressReport report(context, count);
  char started = 0;
  char finished = 0;
  hand_over(&started);
  run_in_arena(thread_count(context), [&] {
    oneapi::tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      rest_while_held(context);
      if (context.cancelled()) return;
      take_over(&started);
      body(i);
      report.item_done();
      hand_over(&finished);
    });
  });
  take_over(&finished);
  return !context.cancelled();
}

bool ordered_pipeline_erased(std::size_t count, const Context& context,
                             const std::function<std::shared_ptr<void>(std::size_t)>& produce,
                             const std::function<void(std::size_t, void*)>& consume) {
  struct Item {
    std::size_t index = 0;
    std::shared_ptr<void> product;
  };
  namespace tbb = oneapi::tbb;
  const int threads = thread_count(context);
  ProgressReport report(context, count);
  std::size_t next = 0;
  char started = 0;
  char consumed = 0;
  hand_over(&started);
  const auto take = tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order,
                                                        [&](tbb::flow_control& flow) -> std::size_t {
                                                          if (next >= count || context.cancelled()) {
                                                            flow.stop();
                                                            return 0;
                                                          }
                                                          return next++;
                                                        });
  const auto work = tbb::make_filter<std::size_t, Item>(tbb::filter_mode::parallel, [&](std::size_t i) {
    rest_while_held(context);
    take_over(&started);
    Item item{i, produce(i)};
    hand_over(item.product.get());
    return item;
  });
  const auto give = tbb::make_filter<Item, void>(tbb::filter_mode::serial_in_order, [&](const Item& item) {
    take_over(item.product.get());
    if (!context.cancelled()) {
      take_over(&consumed);
      consume(item.index, item.product.get());
      report.item_done();
    }
    hand_over(&consumed);  // also for a product that is not consumed: the caller frees the data it was made from
  });
  run_in_arena(threads, [&] { tbb::parallel_pipeline(2 * static_cast<std::size_t>(threads), take & work & give); });
  take_over(&consumed);
  return !context.cancelled();
}

namespace {

// Lets a number of threads pass at once. Those that wait for it hold up no thread that has passed.
class Gate {
 public:
  explicit Gate(std::size_t width) : free_(width) {}

  template <class Body>
  auto pass(Body body) {
    const Passage within(*this);
    return body();
  }

 private:
  struct Passage {
    explicit Passage(Gate& through) : gate(through) {
      std::unique_lock lock(gate.mutex_);
      gate.left_.wait(lock, [&] { return gate.free_ > 0; });
      --gate.free_;
    }
    ~Passage() {
      const std::scoped_lock lock(gate.mutex_);
      ++gate.free_;
      gate.left_.notify_one();
    }
    Passage(const Passage&) = delete;
    Passage& operator=(const Passage&) = delete;

    Gate& gate;
  };

  std::mutex mutex_;
  std::condition_variable left_;
  std::size_t free_;
};

// Runs a body whose tasks wait, for a device for example, by more threads than cores, so that those that wait are not
// among those that compute.
template <class Body>
void run_with_more_threads(std::size_t more, Body body) {
  const std::size_t threads = static_cast<std::size_t>(core_count()) + more;
  const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
  oneapi::tbb::task_arena arena(static_cast<int>(threads));
  arena.execute(body);
}

}  // namespace

void staged_pipeline(std::size_t count, std::size_t max_items, const std::array<Stage, 3>& stages,
                     std::size_t middle_width) {
  struct Item {
    std::size_t index = 0;
    StageItem data;
  };
  namespace tbb = oneapi::tbb;
  constexpr auto kInOrder = tbb::filter_mode::serial_in_order;
  std::array<char, 3> done{};  // a stage's own data pass from thread to thread, too
  char started = 0;
  const auto run = [&](std::size_t stage, Item item) {
    take_over(&started);
    if (stage != 1 || middle_width <= 1) take_over(&done[stage]);
    if (stage > 0) take_over(item.data.get());
    if (stage == 0 || item.data) item.data = stages[stage](item.index, std::move(item.data));
    hand_over(item.data.get());
    hand_over(&done[stage]);
    return item;
  };
  std::size_t next = 0;
  Gate gate(middle_width);
  hand_over(&started);
  const auto first = tbb::make_filter<void, Item>(kInOrder, [&](tbb::flow_control& flow) -> Item {
    if (next < count) return run(0, {next++, nullptr});
    flow.stop();
    return {};
  });
  const auto middle_mode = middle_width > 1 ? tbb::filter_mode::parallel : kInOrder;
  const auto second = tbb::make_filter<Item, Item>(middle_mode, [&](Item item) {
    if (item.data) item = gate.pass([&] { return run(1, std::move(item)); });
    hand_over(&done[1]);  // the gate, too
    return item;
  });
  const auto third = tbb::make_filter<Item, void>(kInOrder, [&](Item item) { run(2, std::move(item)); });
  const auto pass_items = [&] { tbb::parallel_pipeline(max_items, first & second & third); };
  if (middle_width > 1)
    run_with_more_threads(max_items, pass_items);
  else
    pass_items();
  for (char& token : done) take_over(&token);
}

}  // namespace contrejour::inline internal
