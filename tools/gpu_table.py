#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Time frames on a device against the CPU: a table for docs/gpu.md, on any machine.

    gpu_table.py PROGRAM [--size WxH] [--grid N] [--runs N] [--lens NAME ...] [--method NAME ...] [--moving]

Each row is a lens and a method: the median time of a frame on the CPU and on the device, their ratio, the device's part
of its frame, and the difference of the pictures in dB; then the rays and polygons of both, the invocations of the
device's shaders (counted on processors acting as GPUs only), and the megabytes that it received and sent. A lens may
have options: --lens "nikon-80-200 --focal 140 -f 8". A frame is timed after one of the same sequence has warmed the
program: every run renders three frames, and the last is taken. As both sides keep the pupils of a light that stands
still, --moving moves it from frame to frame. CONTREJOUR_DEVICE chooses the device.
"""
import argparse
import json
import pathlib
import shlex
import statistics
import subprocess
import sys
import tempfile

LENSES = ["heliar", "canon-70-200", "nikon-80-200"]
METHODS = ["bundle", "tiled"]  # of the target; `adaptive` may be asked for
MOVING_LIGHT = """[[light]]
name = "lamp"
at = { 1 = [0.28, 0.30], 3 = [0.31, 0.32] }
"""


def run(program, arguments):
    done = subprocess.run([program, *arguments], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"gpu_table.py: {' '.join(arguments)}: {done.stderr.strip()}")
    return done.stdout


def last_frame(options, lens, method, device, folder):
    """The statistics of the last of three frames, and its file."""
    output = folder / f"{device}.####.exr"
    lights = folder / "lights.toml"
    lights.write_text(MOVING_LIGHT)
    moving = ["--lights", str(lights)] if options.moving else []
    lines = run(options.program, ["render", *shlex.split(lens), *moving, "-o", str(output), "--frames", "1-3", "--json",
                                  "--method", method, "--device", device, "--size", options.size,
                                  "--grid", str(options.grid),
                                  "--wavelengths", str(options.wavelengths)]).splitlines()
    frames = [json.loads(line) for line in lines if '"statistics"' in line]
    return frames[-1]["statistics"], folder / f"{device}.0003.exr"


def row(options, lens, method, folder):
    times = {"cpu": [], "vulkan": []}
    files, latest = {}, {}
    for _ in range(options.runs):
        for device in times:
            latest[device], files[device] = last_frame(options, lens, method, device, folder)
            times[device].append(dict(latest[device]["time_ms"])["total"])
    cpu, gpu = (statistics.median(times[device]) for device in ("cpu", "vulkan"))
    drawn = dict(latest["vulkan"]["time_ms"]).get("device", float("nan"))
    difference = json.loads(run(options.program, ["compare", str(files["cpu"]), str(files["vulkan"]), "--json"]))
    counts = [f"{latest['cpu'][name]}, {latest['vulkan'][name]}" for name in ("rays", "primitives")]
    device = latest["vulkan"]
    return (f"| {lens} | {method} | {cpu:.1f} | {gpu:.1f} | {gpu / cpu:.2f} | {drawn:.1f} | "
            f"{difference['psnr_db']:.1f} | {counts[0]} | {counts[1]} | {device['device_invocations'] / 1e6:.2f} | "
            f"{device['device_bytes'] / 1e6:.2f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--size", default="1920x1080")
    parser.add_argument("--grid", type=int, default=256)
    parser.add_argument("--wavelengths", type=int, default=3)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--lens", nargs="*", default=LENSES, help="names, each with options of render")
    parser.add_argument("--method", nargs="*", default=METHODS)
    parser.add_argument("--moving", action="store_true", help="a light that moves from frame to frame")
    options = parser.parse_args()
    devices = json.loads(run(options.program, ["devices", "--json"]))
    usable = [f"{device['name']} ({device['driver']})" for device in devices if device["usable"]]
    print(f"{options.size}, {options.grid} rays a side, {options.wavelengths} wavelengths; devices: {', '.join(usable)}\n")
    print("| Lens | Method | CPU, ms | Device, ms | Ratio | of it drawing, ms | dB | Rays, CPU and device | "
          "Polygons, CPU and device | Invocations, 1e6 | Transfers, MB |")
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for lens in options.lens:
            for method in options.method:
                print(row(options, lens, method, pathlib.Path(folder)), flush=True)


if __name__ == "__main__":
    main()
