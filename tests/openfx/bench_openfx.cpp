// SPDX-License-Identifier: Apache-2.0
// Measures the plug-in in the test host: what a frame costs beyond the library's own time, how long an abort takes, and
// whether memory stays flat over many renders. Not part of the tests; built as the target openfx_bench.
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "contrejour/expert/settings.h"
#include "contrejour/renderer.h"
#include "test_host.h"

namespace contrejour::openfx {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double processor_ms() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto ms = [](const timeval& t) {
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_usec);
  };
  return ms(usage.ru_utime) + ms(usage.ru_stime);
}

double resident_mb() {
  std::ifstream statm("/proc/self/statm");
  double pages = 0, resident = 0;
  statm >> pages >> resident;
  return resident * 4096.0 / 1e6;
}

struct Shot {
  std::unique_ptr<EffectStruct> effect;
  HostPicture output, source;
};

std::unique_ptr<Shot> make_shot(const TestHost& host, const char* context, int width, int height,
                                const std::string& lens) {
  auto shot = std::make_unique<Shot>();
  shot->output = HostPicture::of({0, 0, width, height});
  shot->source = HostPicture::of({0, 0, width, height});
  shot->effect = host.create(context, width, height);
  shot->effect->clip(clip::kOutput)->picture = &shot->output;
  if (auto* const source = shot->effect->clip(clip::kSource)) source->picture = &shot->source;
  shot->effect->choose("lens", lens);
  shot->effect->set("light1On", {1.0});
  return shot;
}

Vec2 light_at(int frame) { return {0.25 + 0.01 * (frame % 50), 0.30 + 0.008 * (frame % 40)}; }

// Processor time of the library alone for the same frames.
double library_ms(const std::string& lens, int width, int height, int frame, Renderer& renderer) {
  params::Values values;
  const Vec2 at = light_at(frame);
  static_cast<void>(values.set("light-at", std::to_string(at.x) + "," + std::to_string(1.0 - at.y) + ":20000"));
  const double before = processor_ms();
  const auto state = params::lens_of(*find_lens(lens), values);
  static_cast<void>(renderer.set_lens(*state));
  const Frame whole = params::whole_frame(values, *state, {width, height});
  const auto lights = params::lights(values, *state, whole, ColourSpace::Rec709);
  const auto flare = renderer.render(*lights, params::frame_settings(values, whole, ColourSpace::Rec709));
  return flare ? processor_ms() - before : 0.0;
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

void measure_speed(const TestHost& host, const std::string& lens, int frames, bool detects) {
  constexpr int kWidth = 1920, kHeight = 1080;
  auto renderer = Renderer::create();
  const auto generator = make_shot(host, context::kGenerator, kWidth, kHeight, lens);
  const auto filter = make_shot(host, context::kFilter, kWidth, kHeight, lens);
  filter->effect->set("detect", {detects ? 1.0 : 0.0});
  std::vector<double> library, generated, filtered;
  for (int frame = 0; frame < frames; ++frame) {
    library.push_back(library_ms(lens, kWidth, kHeight, frame, *renderer));
    for (auto [shot, times] : {std::pair(generator.get(), &generated), std::pair(filter.get(), &filtered)}) {
      const Vec2 at = light_at(frame);
      shot->effect->set("light1Position", {at.x, at.y});
      const double before = processor_ms();
      static_cast<void>(host.render(*shot->effect, {.window = shot->output.bounds}));
      times->push_back(processor_ms() - before);
    }
  }
  std::printf(
      "%s, %d frames of %d x %d, medians of processor time: library %.0f ms, generator %.0f ms, filter %.0f ms\n",
      lens.c_str(), frames, kWidth, kHeight, median(library), median(generated), median(filtered));
  host.destroy(*generator->effect);
  host.destroy(*filter->effect);
}

void measure_abort(const TestHost& host, const std::string& lens, int rounds) {
  const auto shot = make_shot(host, context::kGenerator, 1920, 1080, lens);
  std::mt19937 random(1);
  std::vector<double> latencies, processor;
  for (int round = 0; round < rounds; ++round) {
    const char* const methods[] = {"adaptive", "bundle", "tiled", "reference"};
    shot->effect->set_text("method", methods[round % 4]);
    shot->effect->set("starburst", {round % 3 == 0 ? 1.0 : 0.0});
    shot->effect->set("light_size", {round % 5 == 0 ? 0.53 : 0.0});
    shot->effect->choose("ringing", round % 7 == 0 ? "fresnel" : "none");
    const auto start = Clock::now();
    const double wanted_ms = static_cast<double>(random() % 400);
    std::atomic<bool> is_asked = false;
    Clock::time_point asked;
    double processor_when_asked = 0.0;
    shot->effect->aborts = [&] {
      if (milliseconds_since(start) < wanted_ms) return 0;
      if (!is_asked.exchange(true)) {
        asked = Clock::now();
        processor_when_asked = processor_ms();
      }
      return 1;
    };
    static_cast<void>(host.render(*shot->effect, {.window = shot->output.bounds}));
    if (!is_asked) continue;
    latencies.push_back(milliseconds_since(asked));
    processor.push_back(processor_ms() - processor_when_asked);
    if (processor.back() > 100.0)
      std::printf("round %d, %s: %.0f ms, %.0f ms of processor time\n", round, methods[round % 4], latencies.back(),
                  processor.back());
  }
  std::ranges::sort(latencies);
  std::ranges::sort(processor);
  for (const auto& [what, times] : {std::pair("waited", &latencies), std::pair("processor time", &processor)})
    if (!times->empty())
      std::printf(
          "%s, %zu aborted frames of 1920 x 1080, %s: median %.0f ms, 95 per cent within %.0f ms, worst %.0f ms\n",
          lens.c_str(), times->size(), what, median(*times), (*times)[times->size() * 95 / 100], times->back());
  host.destroy(*shot->effect);
}

void render_changing(const TestHost& host, int thread, int renders, std::atomic<int>& done) {
  std::mt19937 random(static_cast<unsigned int>(thread));
  const std::vector<std::string> lenses = {"heliar", "tessar", "planar-50", "cooke-triplet"};
  for (int k = 0; k < renders; ++k) {
    const auto shot = make_shot(host, k % 2 == 0 ? context::kGenerator : context::kFilter, 48 + (k % 3) * 16, 32,
                                lenses[random() % lenses.size()]);
    shot->effect->set_text("wavelengths", "3");
    shot->effect->set_text("error", "0.02");
    shot->effect->set("light1Position", {0.01 * (random() % 100), 0.01 * (random() % 100)});
    shot->effect->set("fnumber", {4.0 + 0.1 * (random() % 40)});
    shot->effect->set("blades", {random() % 2 == 0 ? 0.0 : 7.0});
    shot->effect->set("starburst", {random() % 4 == 0 ? 1.0 : 0.0});
    static_cast<void>(host.render(*shot->effect, {.window = shot->output.bounds}));
    host.destroy(*shot->effect);
    ++done;
  }
}

void soak(const TestHost& host, int renders) {
  constexpr int kThreads = 4;
  std::atomic<int> done = 0;
  std::vector<std::thread> threads;
  for (int k = 0; k < kThreads; ++k)
    threads.emplace_back([&, k] { render_changing(host, k, renders / kThreads, done); });
  for (int next = renders / 10; next <= renders; next += renders / 10) {
    while (done < std::min(next, renders / kThreads * kThreads))
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    std::printf("%d renders: %.0f MB resident\n", done.load(), resident_mb());
    std::fflush(stdout);
  }
  for (std::thread& thread : threads) thread.join();
}

// The lines of parameters.txt.
void list_parameters(const TestHost& host) {
  const auto described = host.describe(context::kFilter);
  for (const auto& param : described->params.params) std::printf("%s %s\n", param->name.c_str(), param->type.c_str());
}

}  // namespace
}  // namespace contrejour::openfx

int main(int argc, char** argv) {
  using namespace contrejour::openfx;
  CLI::App app("Measures the OpenFX plug-in in the test host");
  std::string lens = "heliar";
  int count = 20;
  bool detects = false;
  app.require_subcommand(1);
  app.add_option("--lens", lens);
  app.add_option("--count", count);
  app.add_flag("--detect", detects);
  const auto* const speed =
      app.add_subcommand("speed", "processor time of frames, beside the library's")->fallthrough();
  const auto* const abort = app.add_subcommand("abort", "how long aborts take")->fallthrough();
  const auto* const list = app.add_subcommand("parameters", "names and types, as parameters.txt keeps them");
  app.add_subcommand("soak", "memory over many renders on four threads")->fallthrough();
  CLI11_PARSE(app, argc, argv);
  const TestHost host;
  if (speed->parsed())
    measure_speed(host, lens, count, detects);
  else if (abort->parsed())
    measure_abort(host, lens, count);
  else if (list->parsed())
    list_parameters(host);
  else
    soak(host, count);
  return 0;
}
