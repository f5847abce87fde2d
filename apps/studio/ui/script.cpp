// SPDX-License-Identifier: Apache-2.0
#include "studio/ui/script.h"

#include <fstream>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "studio/ui/screenshot.h"
#include "studio/ui/script_reader.h"

namespace contrejour::studio {
namespace {

constexpr double kMouseReport_s = 1.0 / 125;

}  // namespace

Result<Script> Script::read(const std::string& file) {
  std::ifstream in(file);
  if (!in) return failure(ErrorCode::Io, "the script cannot be read", {file});
  Script script;
  ScriptReader reader{script};
  std::string text;
  for (int number = 1; std::getline(in, text); ++number) {
    if (text.empty() || text[0] == '#') continue;
    const nlohmann::json line = nlohmann::json::parse(text, nullptr, false);
    if (!line.is_array() || line.empty())
      return failure(ErrorCode::Parse, "a line of a script is a JSON array", {file, number});
    if (auto ok = reader.read(line); !ok) return failure(ErrorCode::Parse, ok.error().message, {file, number});
  }
  return script;
}

Result<void> Script::step(Window& window, Interface& interface) {
  if (actions_.empty()) return {};
  Host host{window, interface, *this};
  rest_s_ = kMouseReport_s;
  const auto done = actions_.front()(host);
  if (!done) return tl::unexpected(done.error());
  if (*done) rest_s_ = 0;
  if (*done) actions_.pop_front();
  return {};
}

Result<void> Script::after_frame(const Window& window) {
  if (screenshot_.empty()) return {};
  return write_screenshot(std::exchange(screenshot_, {}), window.width(), window.height());
}

}  // namespace contrejour::studio
