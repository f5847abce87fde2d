// SPDX-License-Identifier: Apache-2.0
// contrejour-studio: the desktop program. `contrejour studio` starts it.
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "studio/ui/interface.h"
#include "studio/ui/keys.h"
#include "studio/ui/script.h"
#include "studio/ui/window.h"

namespace contrejour::studio {
namespace {

constexpr int kDone = 0, kFailed = 1, kUsage = 2;
constexpr double kIdleWait_s = 0.5;  // autosave and the caret need no more
constexpr double kBusyWait_s = 1.0 / 60;
constexpr int kSettlingFrames = 3;
// While pictures are rendered, the interface draws as often as a display shows frames, and less often where drawing
// takes longer than this part of the time: without a graphics card each frame takes from the pictures.
constexpr double kMostOfTime = 0.4;
constexpr double kLeastFrameRate = 30;

struct Options {
  std::string file, script, state_folder;
  WindowSettings window;
  bool lists_keys = false;
};

int fail(const Error& error) {
  fmt::print(stderr, "contrejour-studio: {}\n", error.to_string());
  return kFailed;
}

void list_keys() {
  for (const KeyCommand& key : all_keys())
    if (*key.what != '\0') fmt::print("{:<14} {:<8} {}\n", key.chord, key.group, key.what);
}

std::string title_of(const Studio& studio) {
  const std::string name = studio.file().empty() ? studio.document().lens_name : studio.file();
  return fmt::format("{}{} \u2013 Contrejour", name, studio.is_saved() ? "" : " *");
}

// Sets a flag while the interface's thread needs a processor (JobHost::hold). The system does not stop a thread that
// renders at once: up to three times in a frame, a frame on two cores waited 4 ms for one.
class ProcessorTurn {
 public:
  explicit ProcessorTurn(std::atomic<bool>& is_on) : is_on_(is_on) { is_on_ = true; }
  ~ProcessorTurn() { end(); }
  ProcessorTurn(const ProcessorTurn&) = delete;
  ProcessorTurn& operator=(const ProcessorTurn&) = delete;
  void end() { is_on_ = false; }

 private:
  std::atomic<bool>& is_on_;
};

// One frame from input to the screen; its time without the wait for input. draws: set meanwhile.
Result<void> run_frame(Window& window, Interface& interface, std::optional<Script>& script, std::atomic<bool>& draws) {
  ProcessorTurn turn(draws);
  const double start = glfwGetTime(), processor_start = processor_time_s();
  if (script)
    if (auto ok = script->step(window, interface); !ok) return ok;
  const std::uint64_t revision = interface.studio().revision(), shown = interface.pictures_drawn();
  window.begin_frame();
  interface.draw_frame();
  Result<void> saved;
  window.end_frame([&] {
    if (script) saved = script->after_frame(window);
    if (window.waits_in_swap()) turn.end();
  });
  const double end = glfwGetTime();
  interface.pace().frame(start, end, processor_time_s() - processor_start, window.drawn_part());
  if (interface.studio().revision() != revision) interface.pace().changed(interface.studio().revision(), start);
  if (interface.pictures_drawn() != shown) interface.pace().shown(interface.studio().shown().picture.revision, end);
  return saved;
}

// Waits until input comes, something new can be shown, or the time is over. Jobs wake the window more often than there
// is something to show, and a frame takes as long as a draft where there is no graphics card.
void wait_for_reason(Window& window, Studio& studio, double seconds) {
  const double until = glfwGetTime() + seconds;
  const std::uint64_t changes = studio.changes();
  double left = seconds;
  do {
    window.wait(left);
    studio.update();
    left = until - glfwGetTime();
  } while (left > 0 && window.input().is_empty() && studio.changes() == changes && !window.wants_attention());
}

// The options of the window itself.
void answer_window(Window& window, Interface& interface) {
  if (window.wants_to_close()) {
    window.refuse_to_close();
    interface.ask_to_quit();
  }
  if (const std::string file = window.dropped_file(); !file.empty()) interface.open_file(file);
}

// The time between the starts of two frames while something is rendered.
class FrameRate {
 public:
  void frame(double from_s, double to_s) {
    constexpr double kWeight = 0.1;
    started_s_ = from_s;
    duration_s_ += kWeight * (to_s - from_s - duration_s_);
  }
  [[nodiscard]] double next_start_s() const {
    return started_s_ + std::clamp(duration_s_ / kMostOfTime, kBusyWait_s, 1 / kLeastFrameRate);
  }

 private:
  double started_s_ = 0, duration_s_ = 0;
};

// A picture that comes meanwhile is shown at once.
void rest_until(double time_s, Window& window, Studio& studio) {
  const std::uint64_t shown = studio.shown_count();
  for (double left = time_s - glfwGetTime(); left > 0 && studio.shown_count() == shown; left = time_s - glfwGetTime()) {
    window.rest(left);
    studio.update();
  }
}

// Until the user, or the script, quits.
int run_frames(Window& window, Interface& interface, std::optional<Script>& script, bool as_fast_as_possible,
               std::atomic<bool>& draws) {
  int settling = 0;  // frames until what an input has opened or lit up is drawn
  FrameRate rate;
  while (!interface.wants_to_quit() && !(script && script->wants_to_quit())) {
    const bool scripted = script && !script->is_done();
    const bool busy = settling > 0 || interface.needs_frame();
    const std::uint64_t shown = interface.studio().shown_count();
    wait_for_reason(window, interface.studio(), scripted ? script->rest_s() : busy ? kBusyWait_s : kIdleWait_s);
    if (!as_fast_as_possible && !interface.studio().is_idle() && interface.studio().shown_count() == shown)
      rest_until(rate.next_start_s(), window, interface.studio());
    answer_window(window, interface);
    settling = window.input().is_empty() ? std::max(0, settling - 1) : kSettlingFrames;
    window.set_scale(static_cast<float>(interface.scale()));
    const double start = glfwGetTime();
    if (auto ok = run_frame(window, interface, script, draws); !ok) return fail(ok.error());
    rate.frame(start, glfwGetTime());
    window.set_title(title_of(interface.studio()));
  }
  return kDone;
}

int run(const Options& options) {
  std::optional<Script> script;
  if (!options.script.empty()) {
    auto read = Script::read(options.script);
    if (!read) return fail(read.error());
    script = std::move(*read);
  }
  auto window = Window::open(options.window);
  if (!window) return fail(window.error());
  const std::filesystem::path copies =
      options.state_folder.empty() ? state_folder() : std::filesystem::path(options.state_folder);
  std::atomic<bool> draws = false;
  Studio studio("first scene", first_document(), {{Window::wake, &draws}, copies, usual_look_folders()});
  Interface interface(studio, static_cast<double>(options.window.scale));
  if (!options.file.empty()) interface.open_file(options.file);
  return run_frames(**window, interface, script, !options.window.waits_for_display, draws);
}

int run_checked(int argc, char** argv) {
  Options options;
  std::string size = "1600x900";
  CLI::App app("The studio of Contrejour: drag the light, see what makes the flare.", "contrejour-studio");
  app.set_version_flag("--version", "contrejour-studio " CONTREJOUR_VERSION);
  app.add_option("FILE", options.file, "a bundled lens, a lens file, a session (.session.json) or a plate");
  app.add_option("--window", size, "size of the window")->option_text("WxH");
  app.add_option("--scale", options.window.scale, "scale of the interface")->check(CLI::Range(0.75, 3.0));
  app.add_flag("--high-contrast", options.window.high_contrast, "white on black");
  app.add_flag("--list-keys", options.lists_keys, "print all keys");
  app.add_option("--script", options.script, "do what a file says, for tests (docs/studio.md)")->option_text("FILE");
  app.add_option("--state-folder", options.state_folder, "where copies of unsaved work are kept")
      ->option_text("FOLDER");
  bool as_fast_as_possible = false;
  app.add_flag("--no-vsync", as_fast_as_possible, "do not wait for the display, for measurements");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    app.exit(error);
    return kUsage;
  }
  if (std::sscanf(size.c_str(), "%dx%d", &options.window.width, &options.window.height) != 2 ||
      options.window.width < 320 || options.window.height < 240 || options.window.width > 16384 ||
      options.window.height > 16384) {
    fmt::print(stderr, "contrejour-studio: --window: give a size such as 1600x900, of 320x240 at least\n");
    return kUsage;
  }
  options.window.waits_for_display = !as_fast_as_possible;
  if (options.lists_keys) {
    list_keys();
    return kDone;
  }
  return run(options);
}

}  // namespace
}  // namespace contrejour::studio

int main(int argc, char** argv) {
  try {
    return contrejour::studio::run_checked(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "contrejour-studio: {}\n", error.what());
    return 1;
  }
}
