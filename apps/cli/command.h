// SPDX-License-Identifier: Apache-2.0
// What every sub-command provides: a function that adds it to the command line and sets the action for when it is
// chosen.
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include "contrejour/result.h"

namespace contrejour::cli {

inline constexpr int kDone = 0;
inline constexpr int kFailed = 1;
inline constexpr int kUsage = 2;
inline constexpr int kInterrupted = 130;  // 128 + SIGINT, as shells report it

// The action of the parsed command line; its value is the exit code.
using Action = std::function<Result<int>()>;

void add_render(CLI::App& app, Action& action);
void add_apply(CLI::App& app, Action& action);
void add_lens(CLI::App& app, Action& action);
void add_glass(CLI::App& app, Action& action);
void add_ghosts(CLI::App& app, Action& action);
void add_compare(CLI::App& app, Action& action);
void add_preset(CLI::App& app, Action& action);
void add_bench(CLI::App& app, Action& action);
void add_coating(CLI::App& app, Action& action);
void add_measure(CLI::App& app, Action& action);
void add_polynomial(CLI::App& app, Action& action);
void add_lights(CLI::App& app, Action& action);
void add_farm(CLI::App& app, Action& action);
void add_devices(CLI::App& app, Action& action);
void add_studio(CLI::App& app, Action& action);

void add_lens_list(CLI::App& lens, Action& action);
void add_lens_info(CLI::App& lens, Action& action);
void add_lens_draw(CLI::App& lens, Action& action);
void add_lens_convert(CLI::App& lens, Action& action);
void add_lens_check(CLI::App& lens, Action& action);
void add_lens_trace(CLI::App& lens, Action& action);
void add_lens_browse(CLI::App& lens, Action& action);

void add_glass_list(CLI::App& glass, Action& action);
void add_glass_show(CLI::App& glass, Action& action);
void add_glass_closest(CLI::App& glass, Action& action);
void add_coating_show(CLI::App& coating, Action& action);
void add_coating_fit(CLI::App& coating, Action& action);

void add_measure_protocol(CLI::App& measure, Action& action);
void add_measure_merge(CLI::App& measure, Action& action);
void add_measure_fit(CLI::App& measure, Action& action);
void add_measure_coatings(CLI::App& measure, Action& action);
void add_measure_adjust(CLI::App& measure, Action& action);
void add_measure_demo(CLI::App& measure, Action& action);
void add_measure_predict(CLI::App& measure, Action& action);

void add_polynomial_at(CLI::App& polynomial, Action& action);
void add_polynomial_export(CLI::App& polynomial, Action& action);

void add_lights_track(CLI::App& lights, Action& action);
void add_lights_import(CLI::App& lights, Action& action);

void add_farm_slurm(CLI::App& farm, Action& action);
void add_farm_commands(CLI::App& farm, Action& action);

void add_bench_tables(CLI::App& bench, Action& action);
void add_bench_effects(CLI::App& bench, Action& action);
void add_bench_lenses(CLI::App& bench, Action& action);
void add_bench_hullin(CLI::App& bench, Action& action);
void add_bench_flicker(CLI::App& bench, Action& action);
void add_bench_device(CLI::App& bench, Action& action);
void add_bench_polynomial(CLI::App& bench, Action& action);

}  // namespace contrejour::cli
