# SPDX-License-Identifier: Apache-2.0
"""Pairs of pictures with and without flare, for training: random lenses, f-numbers, dirt, lights and exposures.

    python3 data_set.py FOLDER [COUNT] [SEED] [WIDTH] [PROCESSES]

Each pair depends on the seed and its number alone, so that any number of processes makes the same files. manifest.json
lists the pairs with all that was chosen.
"""
import json
import multiprocessing
import pathlib
import sys

import numpy as np

import contrejour


def scene(random, height, width):
    """A dim, smooth background with a few lights, linear, white at 1. Put photographs here."""
    y, x = np.mgrid[0:height, 0:width] / max(height, width)
    waves = sum(np.sin(random.uniform(2, 9) * (x * np.cos(a) + y * np.sin(a)) + a) for a in random.uniform(0, 6.3, 4))
    picture = (0.15 + 0.03 * waves)[..., None] * random.uniform(0.5, 1.0, 3)
    for _ in range(random.integers(1, 4)):
        row, column = random.integers(1, height - 1), random.integers(1, width - 1)
        level = 10 ** random.uniform(2.5, 4.0)
        picture[row - 1 : row + 2, column - 1 : column + 2] = level * random.uniform(0.6, 1.0, 3)
    return picture.astype(np.float32)


def make_pair(job):
    folder, seed, number, width = job
    random = np.random.default_rng([seed, number])
    lens = str(random.choice(contrejour.bundled_lenses()))
    widest = contrejour.find_lens(lens).f_number
    chosen = {
        "f_number": round(float(widest * 2 ** random.uniform(0, 2)), 2),
        "blades": int(random.integers(5, 10)),
        "dust": round(float(random.uniform(0, 20)), 1),
        "dirt_seed": int(random.integers(1, 1000000)),
        "stops": round(float(random.uniform(0, 3)), 2),
    }
    clean = scene(random, width * 2 // 3, width)
    flared = contrejour.apply(clean, lens, threads=1, max_lights=4, **chosen)
    names = {kind: f"{number:05}_{kind}.exr" for kind in ("clean", "flare")}
    contrejour.write_picture(folder / names["clean"], clean, half=True)
    contrejour.write_picture(folder / names["flare"], flared.image, half=True)
    lights = [light.centroid_px for light in flared.lights]
    return {"number": number, "lens": lens, **chosen, "lights_px": lights, **names}


def main(folder, count="8", seed="1", width="240", processes="1"):
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    jobs = [(folder, int(seed), number, int(width)) for number in range(int(count))]
    with multiprocessing.get_context("spawn").Pool(int(processes)) as pool:
        pairs = pool.map(make_pair, jobs)
    manifest = {"seed": int(seed), "contrejour": contrejour.__version__, "pairs": pairs}
    (folder / "manifest.json").write_text(json.dumps(manifest, indent=1) + "\n", encoding="utf-8")
    print(f"{folder}: {len(pairs)} pairs")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(*sys.argv[1:])
