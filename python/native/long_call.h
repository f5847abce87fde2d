// SPDX-License-Identifier: Apache-2.0
// A call that takes long: it runs without Python's lock, reports progress to a Python function, and ends when this
// function raises or when Ctrl-C is pressed.
#pragma once

#include <atomic>
#include <exception>
#include <utility>

#include <pybind11/pybind11.h>

#include "contrejour/context.h"
#include "native/errors.h"

namespace contrejour::python {

namespace py = pybind11;

// While it lives, Ctrl-C sets the flag, and Python learns of it as well. Python calls its handlers in its main thread
// only, so nothing happens in any other, nor where the program ignores Ctrl-C.
class InterruptWatch {
 public:
  explicit InterruptWatch(std::atomic<bool>& flag);
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

 private:
  bool is_watching_ = false;
};

class LongCall {
 public:
  // progress: a function of one number from 0 to 1, or None. Python's lock is held.
  LongCall(int threads, py::object progress) : progress_(std::move(progress)) {
    context_.threads = threads;
    context_.cancel = &stop_;
    if (!progress_.is_none()) context_.progress = [this](double done) { report(done); };
  }
  LongCall(const LongCall&) = delete;
  LongCall& operator=(const LongCall&) = delete;

  // Calls compute(context) without Python's lock: it returns a Result and touches no Python object. Throws its error,
  // the progress function's exception, or KeyboardInterrupt.
  template <class Compute>
  auto run(const Compute& compute) {
    const InterruptWatch watch(stop_);
    auto result = [&] {
      const py::gil_scoped_release unlocked;
      return compute(context_);
    }();
    if (raised_) std::rethrow_exception(std::exchange(raised_, nullptr));
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    return value_of(std::move(result));
  }

 private:
  // Runs on any thread, one at a time.
  void report(double done) {
    const py::gil_scoped_acquire locked;
    if (raised_) return;
    try {
      progress_(done);
    } catch (const py::error_already_set&) {
      raised_ = std::current_exception();
      stop_.store(true);
    }
  }

  py::object progress_;
  std::atomic<bool> stop_{false};
  std::exception_ptr raised_;  // by the progress function
  Context context_;
};

}  // namespace contrejour::python
