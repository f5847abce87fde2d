# SPDX-License-Identifier: Apache-2.0
"""How far the ghosts of lenses of one design differ, because elements are tilted and decentred: a Monte Carlo.

    python3 build_errors.py [LENS] [LENSES] [TILT_DEG] [DECENTRE_MM]
"""
import sys

import numpy as np

import contrejour

LIGHT = (12, 8)  # degrees to the right and up
SHOWN = 6


def figures(lens, **errors):
    """By ghost: its flux over the light's, and the middle of its image on the sensor."""
    found = contrejour.ghosts(lens, LIGHT, f_number=8, **errors)
    return {ghost.name: (ghost.relative_flux, *ghost.centroid_mm) for ghost in found}


def main(lens="cooke-triplet", lenses="20", tilt="0.05", decentre="0.02"):
    perfect = figures(lens)
    built = [figures(lens, tilt=float(tilt), decentre=float(decentre), build_seed=k) for k in range(int(lenses))]
    print("ghost     flux over the light's   moved, mm RMS")
    for name in sorted(perfect, key=lambda name: -perfect[name][0])[:SHOWN]:
        values = np.array([lens[name] for lens in built if name in lens])
        flux, x, y = perfect[name]
        moved = np.sqrt(np.mean((values[:, 1] - x) ** 2 + (values[:, 2] - y) ** 2))
        print(f"{name:8}  {flux:.2e} +- {np.std(values[:, 0]):.1e}     {moved:.3f}")


if __name__ == "__main__":
    main(*sys.argv[1:])
