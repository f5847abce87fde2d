#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Render the same scenes with two programs and compare their pictures bit by bit.

    same_pictures.py OLD NEW [--looks N] [--seed N]     exit 0: all the same; 1: each scene that differs; 2: usage

OLD and NEW are `contrejour` programs, before and after a change that moves code and must not change a picture. Scenes are
every bundled lens with every method, and N random sets of options (60) over lenses, lights, irises, dirt, diffraction,
coatings and starbursts.
"""
import argparse
import json
import pathlib
import random
import subprocess
import sys
import tempfile

SIZE = ["--size", "96x64"]
METHODS = ["adaptive", "bundle", "tiled"]


def bundled_lenses(program):
    listed = subprocess.run([program, "lens", "list", "--json"], capture_output=True, text=True, check=True)
    return [lens["id"] for lens in json.loads(listed.stdout)["lenses"]]


def random_options(rng, lenses):
    """One scene: a lens and options that any lens takes."""
    options = [rng.choice(lenses), "--method", rng.choice(METHODS), "-f", str(rng.choice([5.6, 8, 11, 16, 22])), "--light-at",
               f"{rng.uniform(0.1, 0.9):.3f},{rng.uniform(0.1, 0.9):.3f}", "--wavelengths", rng.choice(["1", "3", "auto"]),
               "--ghosts", rng.choice(["all", "one-side"]), "--grid", "32"]
    choices = [
        ["--blades", str(rng.randint(3, 11)), "--curvature", f"{rng.uniform(0, 1):.2f}"],
        ["--ringing", rng.choice(["fresnel", "hullin"])],
        ["--dust", str(rng.randint(1, 60)), "--dust-size", "0.3", "--scratches", "4", "--dirt-on", rng.choice(["stop", "front"])],
        ["--coating", rng.choice(["none", "quarter-wave", "quarter-wave:450:1.38", "stack:1.38@99.6,2.1@131"])],
        ["--starburst", "--glare", "0.02"],
        ["--light-distance", rng.choice(["0.5m", "2m"])],
        ["--select", rng.choice(["brightest:5", "flux:2"])],
        ["--sensor-reflectance", "0.05"],
    ]
    for choice in choices:
        if rng.random() < 0.35:
            options += choice
    return options


def scenes(program, looks, seed):
    lenses = bundled_lenses(program)
    for lens in lenses:
        for method in METHODS:
            yield [lens, "--method", method, "-f", "8", "--light-at", "0.7,0.33", "--wavelengths", "3", "--grid", "32"]
    yield ["heliar", "--method", "reference", "-f", "16", "--light-at", "0.7,0.33", "--wavelengths", "1"]
    rng = random.Random(seed)
    for _ in range(looks):
        yield random_options(rng, lenses)


def rendered(program, options, picture):
    """The picture's bytes, or what the program says in place of one."""
    picture.unlink(missing_ok=True)
    run = subprocess.run([program, "render", *options, *SIZE, "-o", str(picture)], capture_output=True, text=True, check=False)
    return picture.read_bytes() if run.returncode == 0 else run.stderr


def main():
    parser = argparse.ArgumentParser(usage="same_pictures.py OLD NEW [--looks N] [--seed N]")
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--looks", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    different = total = refused = 0
    with tempfile.TemporaryDirectory() as folder:
        picture = pathlib.Path(folder) / "picture.exr"
        for options in scenes(args.old, args.looks, args.seed):
            old, new = (rendered(program, options, picture) for program in (args.old, args.new))
            total += 1
            refused += isinstance(old, str)
            if old != new:
                different += 1
                print("differs: render " + " ".join(options))
                if isinstance(new, str):
                    print("  " + new.strip())
    print(f"same_pictures: {total} scenes, {refused} of them refused by OLD, {different} differ")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
