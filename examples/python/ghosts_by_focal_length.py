# SPDX-License-Identifier: Apache-2.0
"""The brightest ghosts of a zoom lens at each focal length, as a table, and as a plot where Matplotlib is installed.

    python3 ghosts_by_focal_length.py [LENS] [STEPS] [PLOT.png]
"""
import sys

import numpy as np

import contrejour

SHOWN = 4


def main(lens="canon-70-200", steps="6", plot=""):
    prescription = contrejour.find_lens(lens)
    focal_lengths_mm = np.geomspace(prescription.zoom_mm[0], prescription.zoom_mm[-1], int(steps))
    flux = {}
    for k, focal_mm in enumerate(focal_lengths_mm):
        # The light stays at the same place of the picture.
        for ghost in contrejour.ghosts(prescription, focal=focal_mm, f_number=8, light_at="0.7,0.33"):
            flux.setdefault(ghost.name, np.zeros(len(focal_lengths_mm)))[k] = ghost.relative_flux
    brightest = sorted(flux, key=lambda name: -flux[name].max())[:SHOWN]
    print("focal mm  " + "".join(f"{name:>10}" for name in brightest))
    for k, focal_mm in enumerate(focal_lengths_mm):
        print(f"{focal_mm:8.1f}  " + "".join(f"{flux[name][k]:10.2e}" for name in brightest))
    if plot:
        draw(plot, focal_lengths_mm, {name: flux[name] for name in brightest})


def draw(file, focal_lengths_mm, flux):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    for name, values in flux.items():
        pyplot.loglog(focal_lengths_mm, values, label=name)
    pyplot.xlabel("focal length, mm")
    pyplot.ylabel("flux of the ghost over the light's")
    pyplot.legend()
    pyplot.savefig(file)


if __name__ == "__main__":
    main(*sys.argv[1:])
