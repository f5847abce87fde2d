// Threads for long computations: the same result, bit for bit, for any number of them.
// Both loops stop early when the context is cancelled and then return false: what they were to fill is filled in part.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "contrejour/context.h"
#include "contrejour/result.h"

namespace contrejour {

// What a computation returns whose context was cancelled.
inline tl::unexpected<Error> interrupted() { return failure(ErrorCode::Cancelled, "interrupted"); }

// Calls body(i) for i in [0, count) on the context's threads, in any order; progress by items done.
bool parallel_for(std::size_t count, const Context& context, const std::function<void(std::size_t)>& body);

// For i in [0, count): produce(i) on any thread, consume(i, product) one at a time in rising i. A bounded
// number of products is alive at once. So floating-point sums in consume never depend on the threads.
template <class Produce, class Consume>
bool ordered_pipeline(std::size_t count, const Context& context, Produce produce, Consume consume);

namespace detail {
bool ordered_pipeline_erased(std::size_t count, const Context& context,
                             const std::function<std::shared_ptr<void>(std::size_t)>& produce,
                             const std::function<void(std::size_t, void*)>& consume);
}  // namespace detail

template <class Produce, class Consume>
bool ordered_pipeline(std::size_t count, const Context& context, Produce produce, Consume consume) {
  using Product = decltype(produce(std::size_t{}));
  return detail::ordered_pipeline_erased(
      count, context, [&](std::size_t i) -> std::shared_ptr<void> { return std::make_shared<Product>(produce(i)); },
      [&](std::size_t i, void* product) { consume(i, *static_cast<Product*>(product)); });
}

}  // namespace contrejour
