# SPDX-License-Identifier: Apache-2.0
"""What Python costs beside C++: processor time of frames, and of a million rays, by both in turn, on one thread. Rays go
into new arrays, and into those of an earlier call; the C++ loop writes into memory it has. Not part of the tests.

    cmake --build build/release --target python_bench_native contrejour_python
    PYTHONPATH=build/release/python python3 tests/python/bench_speed.py build/release/bin/python_bench_native
"""
import statistics
import subprocess
import sys
import time

import numpy as np

import contrejour


def native(program, *arguments):
    done = subprocess.run([program, *map(str, arguments)], check=True, capture_output=True, text=True)
    return [float(line) for line in done.stdout.split()]


def python_render(lens, width, height, frames):
    times = []
    for frame in range(frames):
        before = time.process_time()
        contrejour.render(lens, f"{4 + frame % 5},5:1000", width=width, height=height, threads=1)
        times.append(1e3 * (time.process_time() - before))
    return times


def python_trace(state, origins, directions, out=None):
    before = time.process_time()
    contrejour.trace(state, origins, directions, out=out, threads=1)
    return 1e3 * (time.process_time() - before)


def report(what, in_python, in_cpp):
    python, cpp = statistics.median(in_python), statistics.median(in_cpp)
    print(f"{what}: Python {python:.1f} ms, C++ {cpp:.1f} ms of processor time (medians of {len(in_python)}): "
          f"{python / cpp:.3f} times the time, {100 * cpp / python:.0f} per cent of the speed; quickest of each "
          f"{100 * min(in_cpp) / min(in_python):.0f} per cent")


def main(program, lens="heliar", rounds=7):
    frames_in_python, frames_in_cpp, rays_in_python, rays_again, rays_in_cpp = [], [], [], [], []
    state = contrejour.configure_lens(lens)
    k = np.arange(1000 * 1000)
    origins = np.stack([8 * (k % 1000) / 1000 - 4, 8 * (k // 1000) / 1000 - 4, np.full(k.size, -20.0)], axis=1)
    directions = np.tile([0.0, 0.0, 1.0], (k.size, 1))
    results = contrejour.trace(state, origins, directions)
    for _ in range(int(rounds)):
        frames_in_cpp += native(program, "render", lens, 640, 360, 2)[1:]
        frames_in_python += python_render(lens, 640, 360, 2)[1:]
        rays_in_cpp += native(program, "trace", lens, k.size, 2)[1:]
        rays_in_python.append(python_trace(state, origins, directions))
        rays_again.append(python_trace(state, origins, directions, results))
    report(f"a frame of 640 x 360 of {lens}", frames_in_python, frames_in_cpp)
    report(f"a million rays through {lens}", rays_in_python, rays_in_cpp)
    report(f"a million rays through {lens} into arrays that exist", rays_again, rays_in_cpp)


if __name__ == "__main__":
    main(*sys.argv[1:])
