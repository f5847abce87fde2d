// SPDX-License-Identifier: Apache-2.0
#include "studio/ui/script_reader.h"

#include <cmath>
#include <random>
#include <utility>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "contrejour/expert/output_file.h"
#include "contrejour/image_io.h"

namespace contrejour::studio {
namespace {

using ScriptLine = nlohmann::json;

constexpr double kLongestWait_s = 60;
constexpr int kQuietFrames = 3;
constexpr double kRestWhileIdle_s = 0.1;

Result<void> write_file(const std::string& file, const std::string& text) {
  auto out = OutputFile::create(file);
  if (!out) return tl::unexpected(out.error());
  if (auto ok = out->write(text); !ok) return ok;
  return out->commit();
}

}  // namespace

void ScriptReader::add(Action action) { script.actions_.push_back(std::move(action)); }

void ScriptReader::push(InputEvent event) {
  add([event](Host& host) -> Result<bool> {
    host.window.input().push(event);
    return true;
  });
}

void ScriptReader::frames(int count) {
  for (int k = 0; k < count; ++k) add([](Host&) -> Result<bool> { return true; });
}

void ScriptReader::move(const std::string& id, double across, double down) {
  add([=](Host& host) -> Result<bool> {
    const WidgetRecord* w = host.interface.widgets().find(id);
    if (w == nullptr) return failure(ErrorCode::InvalidArgument, fmt::format("the window has no widget \"{}\"", id));
    if (w->is_hidden) return failure(ErrorCode::InvalidArgument, fmt::format("\"{}\" is out of sight", id));
    host.window.input().push(
        MouseMoved{static_cast<double>(w->min.x) + across * static_cast<double>(w->max.x - w->min.x),
                   static_cast<double>(w->min.y) + down * static_cast<double>(w->max.y - w->min.y)});
    return true;
  });
  frames(1);
}

void ScriptReader::click(const std::string& id, double across, double down, int times) {
  move(id, across, down);
  for (int k = 0; k < times; ++k) {
    push(MouseButton{0, true});
    push(MouseButton{0, false});
  }
  frames(2);
}

void ScriptReader::drag(const std::string& id, double x, double y, int steps, double across, double down) {
  move(id, across, down);
  push(MouseButton{0, true});
  const auto from = std::make_shared<std::pair<double, double>>();
  add([=](Host& host) -> Result<bool> {
    const WidgetRecord* w = host.interface.widgets().find(id);
    if (w == nullptr) return failure(ErrorCode::InvalidArgument, fmt::format("the window has no widget \"{}\"", id));
    *from = {static_cast<double>(w->min.x) + across * static_cast<double>(w->max.x - w->min.x),
             static_cast<double>(w->min.y) + down * static_cast<double>(w->max.y - w->min.y)};
    return true;
  });
  for (int k = 1; k <= steps; ++k)
    add([=](Host& host) -> Result<bool> {
      const double part = static_cast<double>(k) / steps;
      host.window.input().push(MouseMoved{from->first + x * part, from->second + y * part});
      return true;
    });
  push(MouseButton{0, false});
  frames(2);
}

void ScriptReader::orbit(const std::string& id, double radius, double seconds) {
  move(id, 0.5, 0.5);
  push(MouseButton{0, true});
  const auto start = std::make_shared<double>(-1);
  add([=](Host& host) -> Result<bool> {
    const WidgetRecord* picture = host.interface.widgets().find("viewport/picture");
    if (picture == nullptr) return failure(ErrorCode::InvalidArgument, "there is no picture");
    const double now = glfwGetTime();
    if (*start < 0) *start = now;
    const double t = now - *start;
    const double x = 0.5 * static_cast<double>(picture->min.x + picture->max.x),
                 y = 0.5 * static_cast<double>(picture->min.y + picture->max.y);
    const double reach = radius * static_cast<double>(picture->max.y - picture->min.y);
    host.window.input().push(MouseMoved{x + 1.5 * reach * std::cos(1.3 * t), y + reach * std::sin(1.3 * t)});
    return t >= seconds;
  });
  push(MouseButton{0, false});
  frames(2);
}

void ScriptReader::key(const std::string& chord) {
  const auto keys = keys_of_chord(chord);
  for (const int k : keys)
    if (k != 0) push(KeyChanged{k, true});
  for (auto k = keys.rbegin(); k != keys.rend(); ++k)
    if (*k != 0) push(KeyChanged{*k, false});
  frames(2);
}

void ScriptReader::type(const std::string& text) {
  for (const char c : text) push(CharacterTyped{static_cast<unsigned char>(c)});
  frames(2);
}

void ScriptReader::wait_until_idle() {
  const auto quiet = std::make_shared<int>(0);
  const auto start = std::make_shared<double>(-1);
  add([=](Host& host) -> Result<bool> {
    if (*start < 0) *start = glfwGetTime();
    if (glfwGetTime() - *start > kLongestWait_s) return failure(ErrorCode::Io, "the studio has not come to rest");
    const bool idle = host.interface.studio().is_idle() && host.window.input().is_empty();
    *quiet = idle ? *quiet + 1 : 0;
    host.script.rest_s_ = idle ? 0 : kRestWhileIdle_s;
    return *quiet > kQuietFrames;
  });
}

void ScriptReader::wait_until_shown() {
  add([](Host& host) -> Result<bool> { return host.interface.studio().shown_count() > 0; });
  frames(1);
}

void ScriptReader::wait_seconds(double seconds) {
  const auto start = std::make_shared<double>(-1);
  add([=](Host&) -> Result<bool> {
    if (*start < 0) *start = glfwGetTime();
    return glfwGetTime() - *start >= seconds;
  });
}

void ScriptReader::save_picture(const std::string& file) {
  add([file](Host& host) -> Result<bool> {
    const auto image = host.interface.studio().shown().picture.image;
    if (!image) return failure(ErrorCode::Io, "there is no picture yet");
    if (auto ok = write_exr(file, *image); !ok) return tl::unexpected(ok.error());
    return true;
  });
}

void ScriptReader::random_input(unsigned seed, int count) {
  const auto random = std::make_shared<std::mt19937>(seed);
  const auto left = std::make_shared<int>(count);
  add([=](Host& host) -> Result<bool> {
    auto& input = host.window.input();
    const auto below = [&](unsigned n) { return static_cast<int>((*random)() % n); };
    const double x = below(static_cast<unsigned>(host.window.width())),
                 y = below(static_cast<unsigned>(host.window.height()));
    switch (below(6)) {
      case 0: input.push(MouseMoved{x, y}); break;
      case 1:
      case 2:
        input.push(MouseMoved{x, y});
        input.push(MouseButton{0, true});
        input.push(MouseButton{0, false});
        break;
      case 3: input.push(MouseButton{0, below(2) == 0}); break;
      case 4: input.push(MouseWheel{0, static_cast<double>(below(5) - 2)}); break;
      default: input.push(CharacterTyped{static_cast<unsigned>('0' + below(10))}); break;
    }
    return --*left <= 0;
  });
  push(MouseButton{0, false});
  frames(2);
}

Result<void> ScriptReader::read(const ScriptLine& line) {
  const auto text = [&](std::size_t k) {
    return line.size() > k && line[k].is_string() ? line[k].get<std::string>() : std::string();
  };
  const auto number = [&](std::size_t k, double otherwise) {
    return line.size() > k && line[k].is_number() ? line[k].get<double>() : otherwise;
  };
  const std::string what = text(0), id = text(1);
  if (what == "click")
    click(id, number(2, 0.5), number(3, 0.5), 1);
  else if (what == "double-click")
    click(id, number(2, 0.5), number(3, 0.5), 2);
  else if (what == "move")
    move(id, number(2, 0.5), number(3, 0.5));
  else if (what == "drag")
    drag(id, number(2, 0), number(3, 0), static_cast<int>(number(4, 10)), number(5, 0.5), number(6, 0.5));
  else if (what == "orbit")
    orbit(id, number(2, 0.3), number(3, 2));
  else if (what == "key")
    key(id);
  else if (what == "type")
    type(id);
  else if (what == "wheel") {
    move(id, number(3, 0.5), number(4, 0.5));
    push(MouseWheel{0, number(2, 1)});
    frames(2);
  } else if (what == "wait")
    wait_until_idle();
  else if (what == "shown")
    wait_until_shown();
  else if (what == "sleep")
    wait_seconds(number(1, 1));
  else if (what == "frames")
    frames(static_cast<int>(number(1, 1)));
  else if (what == "random")
    random_input(static_cast<unsigned>(number(1, 1)), static_cast<int>(number(2, 100)));
  else if (what == "picture")
    save_picture(id);
  else if (what == "clear-pace")
    add([](Host& host) -> Result<bool> {
      host.interface.pace().clear();
      return true;
    });
  else if (what == "redraw") {
    add([](Host& host) -> Result<bool> {
      host.window.redraw();
      return true;
    });
  } else if (what == "close")
    add([](Host& host) -> Result<bool> {
      host.interface.ask_to_quit();
      return true;
    });
  else if (what == "autosave")
    add([](Host& host) -> Result<bool> {
      host.interface.studio().autosave_now();
      return true;
    });
  else if (what == "state")
    add([id](Host& host) -> Result<bool> {
      if (auto ok = write_file(id, host.interface.state_json()); !ok) return tl::unexpected(ok.error());
      return true;
    });
  else if (what == "screenshot") {
    add([id](Host& host) -> Result<bool> {
      host.script.screenshot_ = id;
      host.window.prepare_reading();
      return true;
    });
    frames(1);
  } else if (what == "quit")
    add([](Host& host) -> Result<bool> {
      host.script.quits_ = true;
      return true;
    });
  else
    return failure(ErrorCode::Parse, fmt::format("\"{}\" is not a command of a script (docs/studio.md)", what));
  return {};
}

}  // namespace contrejour::studio
