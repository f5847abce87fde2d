// SPDX-License-Identifier: Apache-2.0
#include "studio/core/view.h"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace contrejour::studio {
namespace {

constexpr double kMostFrames = 100000;

}  // namespace

std::string json_of_view(const View& view) {
  return nlohmann::json{{"zoom", view.zoom},
                        {"pan", {view.pan.x, view.pan.y}},
                        {"transform", static_cast<int>(view.transform)},
                        {"colour-view", {view.colour.display, view.colour.view}},
                        {"interface-scale", view.interface_scale},
                        {"handles", view.shows_handles},
                        {"ghosts", view.shows_ghosts},
                        {"frame", view.frame},
                        {"frames", {view.first_frame, view.last_frame}},
                        {"frames-per-second", view.frames_per_second}}
      .dump();
}

View view_of_json(const std::string& text) {
  View view;
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) return view;
  const auto number = [&](const char* key, double otherwise) {
    const auto found = json.find(key);
    return found != json.end() && found->is_number() ? found->get<double>() : otherwise;
  };
  const auto pair = [&](const char* key, Vec2 otherwise) {
    const auto found = json.find(key);
    const bool is_pair = found != json.end() && found->is_array() && found->size() == 2 && (*found)[0].is_number() &&
                         (*found)[1].is_number();
    return is_pair ? Vec2{(*found)[0].get<double>(), (*found)[1].get<double>()} : otherwise;
  };
  const auto flag = [&](const char* key) {
    const auto found = json.find(key);
    return found == json.end() || !found->is_boolean() || found->get<bool>();
  };
  const auto colour_view = [&] {
    const auto found = json.find("colour-view");
    const bool is_pair = found != json.end() && found->is_array() && found->size() == 2 && (*found)[0].is_string() &&
                         (*found)[1].is_string();
    return is_pair ? ColourViewName{(*found)[0].get<std::string>(), (*found)[1].get<std::string>()} : ColourViewName{};
  };
  const auto frame = [](double value) { return static_cast<int>(std::clamp(value, 0.0, kMostFrames)); };
  view.zoom = std::clamp(number("zoom", 1.0), 0.1, 32.0);
  view.pan = pair("pan", {});
  view.transform = static_cast<ViewTransform>(std::clamp(static_cast<int>(number("transform", 0)), 0, 3));
  view.colour = colour_view();
  const double scale = number("interface-scale", 0);
  view.interface_scale = scale > 0 ? std::clamp(scale, 0.75, 3.0) : 0;
  view.shows_handles = flag("handles");
  view.shows_ghosts = flag("ghosts");
  const Vec2 frames = pair("frames", {1, 48});
  view.first_frame = frame(frames.x);
  view.last_frame = std::max(view.first_frame, frame(frames.y));
  view.frame = frame(number("frame", view.first_frame));
  view.frames_per_second = std::clamp(number("frames-per-second", 24.0), 1.0, 240.0);
  return view;
}

}  // namespace contrejour::studio
