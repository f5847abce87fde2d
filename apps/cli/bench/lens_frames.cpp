// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/lens_frames.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <limits>

#include <fmt/format.h>

#include "cli/child_process.h"
#include "cli/lens_choice.h"
#include "cli/long_task.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

constexpr double kFNumber = 8.0;
constexpr const char* kLightAt = "0.7,0.35";
constexpr double kLongFrame_ms = 2000.0;  // a frame that takes longer is measured once

struct FrameScene {
  LensState lens;
  std::vector<Light> lights;
  AdaptiveOptions adaptive;
  FrameSettings settings;
};

Result<FrameScene> frame_scene(const std::string& file, const params::Values& values) {
  const auto prescription = prescription_of(file);
  if (!prescription) return tl::unexpected(prescription.error());
  auto settings = params::lens_settings(values);
  if (!settings) return tl::unexpected(settings.error());
  if (settings->f_number) settings->f_number = std::max(*settings->f_number, prescription->f_number);
  auto lens = configure_lens(*prescription, *settings);
  if (!lens) return tl::unexpected(lens.error());
  const Frame frame = params::whole_frame(values, *lens, *params::parse_size(*values.text("size")));
  auto lights = params::lights(values, *lens, frame, ColourSpace::Rec709);
  if (!lights) return tl::unexpected(lights.error());
  return FrameScene{std::move(*lens), std::move(*lights), params::adaptive_options(values),
                    params::frame_settings(values, frame, ColourSpace::Rec709)};
}

double now_ms(bool of_processor) {
  if (of_processor) return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Rendered {
  double ms = 0.0;
  int ghosts = 0;
};

Result<Rendered> render_frame_scene(const FrameScene& scene, const std::string& name, const params::Values& values,
                                    const FrameRunning& running) {
  const LongTask task(name, values.integer("threads"));
  const double start_ms = now_ms(running.processor_time);
  const auto flare = render(scene.adaptive, scene.lens, scene.lights, scene.settings, task.context());
  if (!flare) return tl::unexpected(flare.error());
  return Rendered{now_ms(running.processor_time) - start_ms, flare->statistics.ghosts_rendered};
}

// The time of the fastest of `runs` calls of `measure`; a call that takes long is not repeated.
template <class Measure>
Result<double> fastest_of(int runs, const Measure& measure) {
  double fastest_ms = std::numeric_limits<double>::infinity();
  for (int k = 0; k < runs && (k == 0 || fastest_ms < kLongFrame_ms); ++k) {
    const Result<double> ms = measure();
    if (!ms) return ms;
    fastest_ms = std::min(fastest_ms, *ms);
  }
  return fastest_ms;
}

// The arguments for a fresh process that renders the same frame.
std::vector<std::string> arguments_of(const std::string& file, const params::Values& values,
                                      const FrameRunning& running) {
  std::vector<std::string> arguments{"bench", "lenses", "--first-frame"};
  if (running.processor_time) arguments.emplace_back("--processor-time");
  for (const char* name : {"focal", "fnumber", "size", "wavelengths", "ghosts", "error", "threads"}) {
    if (values.given(name)) arguments.push_back(fmt::format("--{}={}", name, *values.text(name)));
  }
  arguments.insert(arguments.end(), {"--", file});
  return arguments;
}

Result<double> fresh_ms(const std::string& file, const params::Values& values, const FrameRunning& running) {
  const auto text = output_of_fresh_process(arguments_of(file, values, running));
  if (!text) return tl::unexpected(text.error());
  return params::parse_real(text->substr(0, text->find('\n')));
}

}  // namespace

const std::vector<FrameCase>& frame_cases() {
  static const std::vector<FrameCase> cases{
      {false, "320x180"}, {false, "1920x1080"}, {true, "320x180"}, {true, "1920x1080"}};
  return cases;
}

std::string name_of(const FrameCase& frame_case) {
  return fmt::format("{} {}", frame_case.wide_open ? "wide open" : fmt::format("f/{:g}", kFNumber), frame_case.size);
}

Result<params::Values> values_of(const BenchedLens& lens, const FrameCase& frame_case, const params::Values& values) {
  params::Values all;
  if (const auto ok = all.set("size", frame_case.size); !ok) return tl::unexpected(ok.error());
  if (!frame_case.wide_open) {
    if (const auto ok = all.set("fnumber", fmt::format("{}", kFNumber)); !ok) return tl::unexpected(ok.error());
  }
  if (lens.focal_length_mm) {
    if (const auto ok = all.set("focal", fmt::format("{}", *lens.focal_length_mm)); !ok)
      return tl::unexpected(ok.error());
  }
  return all.over(values);
}

Result<double> frame_ms(const std::string& lens, const params::Values& values, const FrameRunning& running) {
  params::Values all = values;
  if (const auto ok = all.set("light-at", kLightAt); !ok) return tl::unexpected(ok.error());
  const auto scene = frame_scene(lens, all);
  if (!scene) return tl::unexpected(scene.error());
  const auto rendered = render_frame_scene(*scene, lens, all, running);
  if (!rendered) return tl::unexpected(rendered.error());
  return rendered->ms;
}

Result<FrameCost> frame_cost(const BenchedLens& lens, const FrameCase& frame_case, const params::Values& values,
                             const FrameRunning& running) {
  const auto all = values_of(lens, frame_case, values);
  if (!all) return tl::unexpected(all.error());
  params::Values with_light = *all;
  if (const auto ok = with_light.set("light-at", kLightAt); !ok) return tl::unexpected(ok.error());
  const auto scene = frame_scene(lens.file, with_light);  // reports errors of the lens before a fresh process does
  if (!scene) return tl::unexpected(scene.error());
  FrameCost cost;
  if (!running.warm_only) {
    const auto ms = fastest_of(running.runs, [&] { return fresh_ms(lens.file, *all, running); });
    if (!ms) return tl::unexpected(ms.error());
    cost.first_ms = *ms;
  }
  cost.f_number = scene->lens.f_number;
  // One frame to warm up, then the measured frames.
  const auto render_once = [&]() -> Result<double> {
    const auto rendered = render_frame_scene(*scene, lens.file, with_light, running);
    if (!rendered) return tl::unexpected(rendered.error());
    cost.ghosts = rendered->ghosts;
    return rendered->ms;
  };
  const auto cold_ms = render_once();
  if (!cold_ms) return tl::unexpected(cold_ms.error());
  if (cost.ghosts == 0)
    return failure(ErrorCode::InvalidArgument,
                   lens.file + ": no ghost reaches the frame, so that there is no cost to measure");
  const auto warm_ms = *cold_ms < kLongFrame_ms ? fastest_of(running.runs, render_once) : cold_ms;
  if (!warm_ms) return tl::unexpected(warm_ms.error());
  cost.warm_ms = *warm_ms;
  return cost;
}

}  // namespace contrejour::cli
