// SPDX-License-Identifier: Apache-2.0
// The frames of a sequence: in order within a stage, overlapping between stages, few at a time; failures and Ctrl-C.
#include "contrejour/expert/run_frames.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <numeric>
#include <thread>
#include <utility>

#include <doctest/doctest.h>

using namespace contrejour;

namespace {

std::vector<int> frames_to(int last) {
  std::vector<int> frames(static_cast<std::size_t>(last));
  std::iota(frames.begin(), frames.end(), 1);
  return frames;
}

Result<int> number(int frame) { return frame; }
Result<int> tenfold(int, int& in, const Context&) { return 10 * in; }

}  // namespace

TEST_CASE("each stage sees every frame once, in order, with what the stage before made of it") {
  std::vector<int> read, rendered, written, values;
  const auto failures = run_frames(
      frames_to(200),
      [&](int frame) -> Result<int> {
        read.push_back(frame);
        return 3 * frame;
      },
      [&](int frame, int& in, const Context&) -> Result<double> {
        rendered.push_back(frame);
        return in + 0.5;
      },
      [&](int frame, double& out) -> Result<void> {
        written.push_back(frame);
        values.push_back(static_cast<int>(2 * out));
        return {};
      });
  REQUIRE(failures.has_value());
  CHECK(failures->empty());
  CHECK(read == frames_to(200));
  CHECK(rendered == frames_to(200));
  CHECK(written == frames_to(200));
  for (std::size_t i = 0; i < values.size(); ++i) CHECK(values[i] == 6 * static_cast<int>(i + 1) + 1);
}

TEST_CASE("no more frames exist at once than allowed") {
  std::atomic<int> alive = 0, largest = 0;
  struct Counted {
    std::atomic<int>* alive = nullptr;
    explicit Counted(std::atomic<int>& count) : alive(&count) { ++count; }
    Counted(Counted&& other) noexcept : alive(std::exchange(other.alive, nullptr)) {}
    Counted& operator=(Counted&&) = delete;
    ~Counted() {
      if (alive != nullptr) --*alive;
    }
  };
  const auto failures = run_frames(
      frames_to(50), [&](int) -> Result<Counted> { return Counted(alive); },
      [&](int, Counted& in, const Context&) -> Result<Counted> {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        largest = std::max(largest.load(), alive.load());
        return std::move(in);
      },
      [](int, Counted&) -> Result<void> { return {}; }, {false, 3});
  REQUIRE(failures.has_value());
  CHECK(largest <= 3);
  CHECK(alive == 0);
}

TEST_CASE("a failure in any stage ends the run after the frames before it, or is left behind") {
  for (const int stage : {0, 1, 2}) {
    for (const bool keep_going : {false, true}) {
      CAPTURE(stage);
      CAPTURE(keep_going);
      std::vector<int> written;
      const auto fail_at = [&](int here, int frame) { return here == stage && frame == 20; };
      const auto failed = failure(ErrorCode::Io, "broken", {"plate"});
      const auto failures = run_frames(
          frames_to(60),
          [&](int frame) -> Result<int> {
            if (fail_at(0, frame)) return failed;
            return frame;
          },
          [&](int frame, int& in, const Context&) -> Result<int> {
            if (fail_at(1, frame)) return failed;
            return in;
          },
          [&](int frame, int&) -> Result<void> {
            if (fail_at(2, frame)) return failed;
            written.push_back(frame);
            return {};
          },
          {keep_going});
      REQUIRE(failures.has_value());
      REQUIRE(failures->size() == 1);
      CHECK(failures->front().frame == 20);
      CHECK(failures->front().error.message == "broken");
      if (keep_going) {
        CHECK(written.size() == 59);
      } else {
        // Frames that were already rendered may still be written.
        CHECK(written.size() >= 19);
        CHECK(written.size() <= 22);
      }
      for (int frame = 1; frame < 20; ++frame) CHECK(written[static_cast<std::size_t>(frame - 1)] == frame);
    }
  }
}

TEST_CASE("cancelling ends the run with that error") {
  std::atomic<bool> cancel = false;
  Context context;
  context.cancel = &cancel;
  int written = 0;
  const auto failures = run_frames(
      frames_to(1000), number, tenfold,
      [&](int frame, int&) -> Result<void> {
        ++written;
        if (frame == 5) cancel = true;
        return {};
      },
      {}, context);
  REQUIRE_FALSE(failures.has_value());
  CHECK(failures.error().code == ErrorCode::Cancelled);
  CHECK(written == 5);
}

TEST_CASE("progress rises over the frames; no frames are no work") {
  std::vector<double> progress;
  Context context;
  context.progress = [&](double done) { progress.push_back(done); };
  const auto render = [](int, int& in, const Context& within) -> Result<int> {
    within.progress(0.5);
    within.progress(1.0);
    return in;
  };
  const auto write = [](int, int&) -> Result<void> { return {}; };
  REQUIRE(run_frames(frames_to(4), number, render, write, {}, context).has_value());
  CHECK(progress == std::vector<double>{0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0});
  CHECK(run_frames({}, number, render, write, {}, context).value().empty());
}

TEST_CASE("several frames are rendered at once, and written in order") {
  for (const int at_once : {2, 3}) {
    std::vector<int> read, written;
    std::atomic<int> rendering = 0, most = 0;
    const auto failures = run_frames(
        frames_to(60),
        [&](int frame) -> Result<int> {
          read.push_back(frame);
          return frame;
        },
        [&](int frame, int& in, const Context&) -> Result<int> {
          const int now = ++rendering;
          for (int before = most; before < now && !most.compare_exchange_weak(before, now);) continue;
          std::this_thread::sleep_for(std::chrono::milliseconds(1 + frame % 4));
          --rendering;
          return 10 * in;
        },
        [&](int frame, int& out) -> Result<void> {
          CHECK(out == 10 * frame);
          written.push_back(frame);
          return {};
        },
        {false, at_once + 2, at_once});
    REQUIRE(failures.has_value());
    CHECK(failures->empty());
    CHECK(read == frames_to(60));
    CHECK(written == frames_to(60));
    CHECK(most > 1);
    CHECK(most <= at_once);
  }
}

TEST_CASE("no more frames are rendered at once than are held") {
  std::atomic<int> rendering = 0;
  const auto render = [&](int, int& in, const Context&) -> Result<int> {
    CHECK(++rendering == 1);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    --rendering;
    return in;
  };
  const auto write = [](int, int&) -> Result<void> { return {}; };
  REQUIRE(run_frames(frames_to(20), number, render, write, {false, 1, 8}).has_value());
}

TEST_CASE("of frames that are rendered at once, those before a failure are finished, and all are listed") {
  for (const bool keep_going : {false, true}) {
    std::vector<int> written;
    const auto failures = run_frames(
        frames_to(60), number,
        [&](int frame, int& in, const Context&) -> Result<int> {
          std::this_thread::sleep_for(std::chrono::milliseconds(frame % 3));
          if (frame == 21 || frame == 20) return failure(ErrorCode::Io, "broken");
          return in;
        },
        [&](int frame, int&) -> Result<void> {
          written.push_back(frame);
          return {};
        },
        {keep_going, 5, 3});
    REQUIRE(failures.has_value());
    REQUIRE_FALSE(failures->empty());
    CHECK(std::ranges::is_sorted(written));
    REQUIRE(written.size() >= 19);
    for (int frame = 1; frame < 20; ++frame) CHECK(written[static_cast<std::size_t>(frame - 1)] == frame);
    if (keep_going) {
      CHECK(written.size() == 58);
      REQUIRE(failures->size() == 2);
      CHECK((*failures)[0].frame == 20);
      CHECK((*failures)[1].frame == 21);
    } else {
      CHECK(written.size() <= 23);  // some may have been begun before
      CHECK(failures->front().frame == 20);
    }
  }
}

TEST_CASE("cancelling ends frames that are rendered at once") {
  std::atomic<bool> cancel = false;
  Context context;
  context.cancel = &cancel;
  std::vector<int> written;
  const auto render = [&](int frame, int& in, const Context& within) -> Result<int> {
    while (frame > 5 && !within.cancelled()) std::this_thread::yield();
    if (within.cancelled()) return failure(ErrorCode::Cancelled, "interrupted");
    return in;
  };
  const auto failures = run_frames(
      frames_to(1000), number, render,
      [&](int frame, int&) -> Result<void> {
        written.push_back(frame);
        if (frame == 5) cancel = true;
        return {};
      },
      {false, 4, 2}, context);
  REQUIRE_FALSE(failures.has_value());
  CHECK(failures.error().code == ErrorCode::Cancelled);
  CHECK(written == frames_to(5));
}

TEST_CASE("progress never falls while several frames report theirs, and ends at 1") {
  std::vector<double> progress;
  Context context;
  context.progress = [&](double done) { progress.push_back(done); };
  const auto read = [](int frame) -> Result<int> {
    if (frame == 7) return failure(ErrorCode::Io, "broken");
    return frame;
  };
  const auto render = [](int frame, int& in, const Context& within) -> Result<int> {
    for (const double done : {0.25, 0.5, 0.25, 1.0}) {  // as a frame that is drawn anew
      within.progress(done);
      std::this_thread::sleep_for(std::chrono::microseconds(100 * (frame % 5)));
    }
    return in;
  };
  const auto write = [](int, int&) -> Result<void> { return {}; };
  const auto failures = run_frames(frames_to(40), read, render, write, {true, 5, 3}, context);
  REQUIRE(failures.has_value());
  CHECK(failures->size() == 1);
  CHECK(progress.size() == 4 * 39);
  CHECK(std::ranges::is_sorted(progress));
  CHECK(progress.front() > 0.0);
  CHECK(progress.back() == 1.0);
}
