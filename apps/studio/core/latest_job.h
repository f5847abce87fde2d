// SPDX-License-Identifier: Apache-2.0
// Work on a thread of its own that only ever answers the latest request: a new one replaces one that waits, and asks
// the one in work to stop. The interface posts requests and takes answers; neither waits for the work.
// Thread-safety: post(), take() and is_idle() from one thread; `work` runs on the job's own.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "contrejour/context.h"
#include "studio/core/thread_priority.h"

namespace contrejour::studio {

// The priority of a job's thread. A job that takes milliseconds, and that the window waits for, has the interface's;
// one that renders has a lower one.
enum class JobPriority { Background, Interface };

// All jobs of a program share these.
struct JobHost {
  std::function<void()> wake = {};  // called after each answer and each end of work, on the job's thread
  const std::atomic<bool>* hold = nullptr;  // set while the interface's thread needs the processors (Context::hold)
};

template <class Request, class Answer>
class LatestJob {
 public:
  // The job as its work sees it.
  class Control {
   public:
    explicit Control(LatestJob& job) : job_(job) {}
    // Set once a newer request was posted, or the job ends.
    [[nodiscard]] const std::atomic<bool>& is_outdated() const { return job_.outdated_; }
    // For computations that a newer request stops. threads: 0 for all cores.
    [[nodiscard]] Context context(int threads = 0) const {
      return {.threads = threads, .cancel = &job_.outdated_, .hold = job_.host_.hold};
    }
    // For those that only the job's end stops.
    [[nodiscard]] Context context_until_end() const { return {.cancel = &job_.ending_, .hold = job_.host_.hold}; }
    // Waits, and returns early with false if a newer request arrives.
    [[nodiscard]] bool rests_for(std::chrono::milliseconds time) {
      std::unique_lock lock(job_.mutex_);
      return !job_.changed_.wait_for(lock, time, [&] { return job_.outdated_.load(); });
    }
    void publish(Answer answer) {
      {
        const std::lock_guard lock(job_.mutex_);
        job_.answer_ = std::move(answer);
      }
      if (job_.host_.wake) job_.host_.wake();
    }
    // The request is answered, but the work goes on for the requests to come: nobody waits for it.
    void goes_on_for_later() {
      const std::lock_guard lock(job_.mutex_);
      job_.working_ = false;
    }

   private:
    LatestJob& job_;
  };

  using Work = std::function<void(const Request&, Control&)>;

  LatestJob(Work work, JobHost host, JobPriority priority = JobPriority::Background)
      : work_(std::move(work)), host_(std::move(host)), priority_(priority), thread_([this] { run(); }) {}

  ~LatestJob() {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
      outdated_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  LatestJob(const LatestJob&) = delete;
  LatestJob& operator=(const LatestJob&) = delete;

  void post(Request request) {
    {
      const std::lock_guard lock(mutex_);
      waiting_ = std::move(request);
      outdated_ = true;
    }
    changed_.notify_all();
  }

  // The answer published last, once.
  [[nodiscard]] std::optional<Answer> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(answer_, std::nullopt);
  }

  // Nothing is asked for, in work, or waiting to be taken.
  [[nodiscard]] bool is_idle() const {
    const std::lock_guard lock(mutex_);
    return !waiting_ && !working_ && !answer_;
  }

 private:
  void run() {
    if (priority_ == JobPriority::Background) lower_priority_of_this_thread();
    Control control(*this);
    while (auto request = next()) {
      work_(*request, control);
      {
        const std::lock_guard lock(mutex_);
        working_ = false;
      }
      if (host_.wake) host_.wake();
    }
  }

  std::optional<Request> next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return ending_.load() || waiting_.has_value(); });
    if (ending_) return std::nullopt;
    working_ = true;
    outdated_ = false;
    return std::exchange(waiting_, std::nullopt);
  }

  Work work_;
  JobHost host_;
  JobPriority priority_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Request> waiting_;
  std::optional<Answer> answer_;
  bool working_ = false;
  std::atomic<bool> outdated_ = false, ending_ = false;
  std::thread thread_;  // last: it uses all the others
};

}  // namespace contrejour::studio
