// SPDX-License-Identifier: Apache-2.0
// Threads for long computations: the same result, bit for bit, for any number of them.
// Both loops stop early when the context is cancelled and then return false: their results are then incomplete.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>

#include "contrejour/context.h"
#include "contrejour/result.h"

namespace contrejour::inline internal {

// The error of a computation whose context was cancelled.
inline tl::unexpected<Error> interrupted() { return failure(ErrorCode::Cancelled, "interrupted"); }

// The number of threads that a context asks for.
[[nodiscard]] int thread_count(const Context& context);

// Calls body(i) for i in [0, count) on the context's threads, in any order; progress by items done.
bool parallel_for(std::size_t count, const Context& context, const std::function<void(std::size_t)>& body);

// For i in [0, count): calls produce(i) on any thread, and consume(i, product) one at a time in rising i, so that
// floating-point sums in consume do not depend on the threads. The number of products alive at once is bounded.
template <class Produce, class Consume>
bool ordered_pipeline(std::size_t count, const Context& context, Produce produce, Consume consume);

bool ordered_pipeline_erased(std::size_t count, const Context& context,
                             const std::function<std::shared_ptr<void>(std::size_t)>& produce,
                             const std::function<void(std::size_t, void*)>& consume);

// The data that one stage passes to the next; null where an item ends.
using StageItem = std::shared_ptr<void>;
// Makes an item's next form from its last one (null in the first stage).
using Stage = std::function<StageItem(std::size_t i, StageItem item)>;

// Passes items i in [0, count) through three stages. Each stage handles one item at a time, in rising i; different
// stages handle different items at once, of which at most `max_items` exist. Stages that follow a null item do not see
// it. A stage may run parallel_for. Cancelling is the stages' matter: return null to end what is left.
// middle_width: how many items the middle stage handles at once, if more than one. It then gets them in about this
// order, and may wait, for a device for example: further threads take care of the other stages.
void staged_pipeline(std::size_t count, std::size_t max_items, const std::array<Stage, 3>& stages,
                     std::size_t middle_width = 1);

template <class Produce, class Consume>
bool ordered_pipeline(std::size_t count, const Context& context, Produce produce, Consume consume) {
  using Product = decltype(produce(std::size_t{}));
  return ordered_pipeline_erased(
      count, context, [&](std::size_t i) -> std::shared_ptr<void> { return std::make_shared<Product>(produce(i)); },
      [&](std::size_t i, void* product) { consume(i, *static_cast<Product*>(product)); });
}

}  // namespace contrejour::inline internal
