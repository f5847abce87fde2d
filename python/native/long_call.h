// SPDX-License-Identifier: Apache-2.0
// A call that takes long: it runs without Python's lock, reports progress to a Python function, and ends when this
// function raises, when Ctrl-C is pressed, or when a flag of the caller's is set.
#pragma once

#include <atomic>
#include <exception>
#include <utility>
#include <vector>

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

// Ends the calls that were given it. Python's lock is held whenever one of its functions is called.
class CancelFlag {
 public:
  void set() {
    is_set_ = true;
    for (std::atomic<bool>* const stop : running_) stop->store(true);
  }
  void clear() { is_set_ = false; }
  [[nodiscard]] bool is_set() const { return is_set_; }

  // A call that begins, and one that has ended: `stop` ends it.
  void add(std::atomic<bool>& stop) {
    running_.push_back(&stop);
    if (is_set_) stop.store(true);
  }
  void remove(std::atomic<bool>& stop) { std::erase(running_, &stop); }

 private:
  bool is_set_ = false;
  std::vector<std::atomic<bool>*> running_;
};

// The keyword arguments by which a call is followed and stopped: a function of one number from 0 to 1 or None, and a
// flag or null.
struct CallControls {
  py::object progress;
  CancelFlag* cancel = nullptr;
};

class LongCall {
 public:
  // Python's lock is held.
  LongCall(int threads, CallControls controls) : controls_(std::move(controls)) {
    context_.threads = threads;
    context_.cancel = &stop_;
    if (!controls_.progress.is_none()) context_.progress = [this](double done) { report(done); };
    if (controls_.cancel != nullptr) controls_.cancel->add(stop_);
  }
  ~LongCall() {
    if (controls_.cancel != nullptr) controls_.cancel->remove(stop_);
  }
  LongCall(const LongCall&) = delete;
  LongCall& operator=(const LongCall&) = delete;

  // Calls compute(context) without Python's lock: it returns a Result and touches no Python object. Throws its error,
  // which is Cancelled after the flag was set, the progress function's exception, or KeyboardInterrupt.
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
      controls_.progress(done);
    } catch (const py::error_already_set&) {
      raised_ = std::current_exception();
      stop_.store(true);
    }
  }

  CallControls controls_;
  std::atomic<bool> stop_{false};
  std::exception_ptr raised_;  // by the progress function
  Context context_;
};

void add_long_calls(py::module_& module);

}  // namespace contrejour::python
