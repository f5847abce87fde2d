#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""number_variants.py SEEDS FOLDER: copies of the text files in SEEDS, each with one number replaced, to FOLDER.

Random changes rarely make a whole new number, and what breaks readers are numbers nobody writes: an index of -1, a
thickness of -0, a curvature of 1e-300. Of a file with many numbers some are taken, evenly spread.
"""
import pathlib
import re
import sys

NUMBER = re.compile(rb"-?\d[\d.]*(?:[eE][-+]?\d+)?")
VALUES = [b"-0.0", b"0", b"-1", b"1e9", b"-1e-300", b"1e300", b"0.30000000000000004", b"99999999999999999999", b"nan", b"inf"]
MOST_BYTES, MOST_NUMBERS = 20_000, 30


def variants(text):
    places = list(NUMBER.finditer(text))
    for place in places[:: -(-len(places) // MOST_NUMBERS) or 1]:
        for value in VALUES:
            yield text[: place.start()] + value + text[place.end() :]


def main(seeds, folder):
    out = pathlib.Path(folder)
    out.mkdir(parents=True)
    for seed in sorted(pathlib.Path(seeds).iterdir()):
        text = seed.read_bytes()
        if b"\0" in text or len(text) > MOST_BYTES:
            continue
        for k, variant in enumerate(variants(text)):
            (out / f"{seed.name}.{k}").write_bytes(variant)


main(*sys.argv[1:])
