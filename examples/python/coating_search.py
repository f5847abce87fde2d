# SPDX-License-Identifier: Apache-2.0
"""The thicknesses of a coating of three films with which a lens has the least flux in its ghosts.

    python3 coating_search.py [LENS] [TRIALS] [SEED]

An evolution strategy of one parent and one child (Rechenberg 1973): it needs no gradient. Steps grow after a success
and shrink otherwise, so that about one in five succeeds.
"""
import sys

import numpy as np

import contrejour

LIGHT = (12, 8)  # degrees to the right and up
FILMS = ("MgF2", "ZrO2", "Al2O3")  # from the air to the glass
START_NM = (100.0, 130.0, 80.0)  # about a quarter of 550 nm in each, half of it in the middle one


def text(thicknesses_nm):
    return "stack:" + ",".join(f"{film}@{nm:.2f}" for film, nm in zip(FILMS, thicknesses_nm))


def ghost_flux(state, coating):
    """All ghosts' luminous flux over the light's."""
    return sum(ghost.relative_flux for ghost in contrejour.ghosts(state, LIGHT, coating=coating))


def search(state, trials, seed):
    random = np.random.default_rng(seed)
    best_nm, step = np.array(START_NM), 0.2
    best = ghost_flux(state, text(best_nm))
    for _ in range(trials):
        child_nm = np.clip(best_nm * np.exp(step * random.standard_normal(len(best_nm))), 5.0, 500.0)
        flux = ghost_flux(state, text(child_nm))
        if flux < best:
            best_nm, best, step = child_nm, flux, step * 1.5
        else:
            step *= 1.5**-0.25
    return text(best_nm), best


def main(lens="cooke-triplet", trials="80", seed="1"):
    state = contrejour.configure_lens(lens, f_number=8)
    for name in ("none", "quarter-wave:550:1.38", text(START_NM)):
        print(f"{ghost_flux(state, name):.3e}  {name}")
    coating, flux = search(state, int(trials), int(seed))
    print(f"{flux:.3e}  {coating}, found in {trials} trials")


if __name__ == "__main__":
    main(*sys.argv[1:])
