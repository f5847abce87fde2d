// SPDX-License-Identifier: Apache-2.0
#include "native/long_call.h"

#include <csignal>

namespace contrejour::python {
namespace {

// The signal handler touches these: the flag of the main thread's call, and the handler that was there before.
std::atomic<std::atomic<bool>*> flag_of_interrupt{nullptr};
std::atomic<PyOS_sighandler_t> handler_before{nullptr};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<std::atomic<bool>*>::is_always_lock_free &&
                  std::atomic<PyOS_sighandler_t>::is_always_lock_free,
              "a signal handler may only touch lock-free atomics");

extern "C" void on_interrupt(int number) {
  if (std::atomic<bool>* const flag = flag_of_interrupt.load()) flag->store(true);
  if (const PyOS_sighandler_t before = handler_before.load()) before(number);
}

bool is_main_thread() {
  const py::object main = py::module_::import("threading").attr("main_thread")();
  return main.attr("ident").cast<unsigned long>() == PyThread_get_thread_ident();
}

}  // namespace

InterruptWatch::InterruptWatch(std::atomic<bool>& flag) {
  if (!is_main_thread() || flag_of_interrupt.load() != nullptr) return;
  const PyOS_sighandler_t before = PyOS_getsig(SIGINT);
  if (before == SIG_DFL || before == SIG_IGN || before == SIG_ERR) return;
  flag_of_interrupt.store(&flag);
  handler_before.store(before);
  PyOS_setsig(SIGINT, on_interrupt);
  is_watching_ = true;
}

InterruptWatch::~InterruptWatch() {
  if (!is_watching_) return;
  PyOS_setsig(SIGINT, handler_before.load());
  flag_of_interrupt.store(nullptr);
}

void add_long_calls(py::module_& module) {
  py::class_<CancelFlag>(module, "CancelFlag",
                         "A flag that ends long calls from another thread: render(..., cancel=flag).\n\n"
                         "Calls that were given the flag raise CancelledError within a moment after set(), and so do\n"
                         "those that begin before clear(). Several calls may share one.")
      .def(py::init<>())
      .def("set", &CancelFlag::set, "Ends the calls.")
      .def("clear", &CancelFlag::clear, "Lets later calls run.")
      .def("is_set", &CancelFlag::is_set);
}

}  // namespace contrejour::python
