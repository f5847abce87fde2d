// SPDX-License-Identifier: Apache-2.0
// Works through the frames of a sequence: reading, rendering and writing of different frames overlap, while each of the
// three handles one frame at a time, in the given order; several are rendered at once where the options say so, and are
// written in order all the same. The memory in use is that of a few frames.
// Thread-safety: the three functions are called from different threads, each from one at a time, and rendering from
// frames_rendered_at_once; so what two of them share must be safe for two threads. Progress is reported by one thread
// at a time.
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

struct RunFramesOptions {
  bool keep_going = false;  // renders the frames after one that failed
  int max_frames_held = 3;  // at once, from reading to writing
  int frames_rendered_at_once = 1;  // no more than are held; frames may then begin in a slightly different order
};

struct FrameFailure {
  int frame = 0;
  Error error;
};

// The data of one frame, of any type.
using FrameData = Result<std::shared_ptr<void>>;

// The three functions of run_frames, for data of any type: each takes what the one before returned.
struct FrameStages {
  std::function<FrameData(int frame)> read;
  std::function<FrameData(int frame, void* data, const Context& context)> render;
  std::function<Result<void>(int frame, void* data)> write;
};

// run_frames for such functions.
[[nodiscard]] CONTREJOUR_API Result<std::vector<FrameFailure>> run_stages(const std::vector<int>& frames,
                                                                          const FrameStages& stages,
                                                                          const RunFramesOptions& options,
                                                                          const Context& context);

// Calls for each frame:
//   Result<In> read(int frame), Result<Out> render(int frame, In& in, const Context&), Result<void> write(int frame,
//   Out& out).
// After a failure no further frame is begun, unless options.keep_going; frames before it are finished. Progress is that
// of rendering, and rises. Returns the frames that failed. Errors: Cancelled.
template <class Read, class Render, class Write>
Result<std::vector<FrameFailure>> run_frames(const std::vector<int>& frames, Read read, Render render, Write write,
                                             const RunFramesOptions& options = {}, const Context& context = {}) {
  using In = typename decltype(read(0))::value_type;
  using Out = typename decltype(render(0, std::declval<In&>(), context))::value_type;
  const auto erased = [](auto result) -> FrameData {
    using Value = typename decltype(result)::value_type;
    if (!result) return tl::unexpected(std::move(result.error()));
    return std::make_shared<Value>(std::move(*result));
  };
  return run_stages(
      frames,
      {[&](int frame) { return erased(read(frame)); },
       [&](int frame, void* in, const Context& within) { return erased(render(frame, *static_cast<In*>(in), within)); },
       [&](int frame, void* out) { return write(frame, *static_cast<Out*>(out)); }},
      options, context);
}

}  // namespace contrejour
