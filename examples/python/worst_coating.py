# SPDX-License-Identifier: Apache-2.0
"""Which surface of a lens causes most of its ghosts, and what a better coating there would change.

    python3 worst_coating.py [LENS] [BETTER COATING]
"""
import sys
from collections import defaultdict

import contrejour

LIGHT = (12, 8)  # degrees to the right and up


def flux_by_surface(lens, **parameters):
    """The flux of all ghosts over the light's, and for each surface the part that reflects there."""
    total, by_surface = 0.0, defaultdict(float)
    for ghost in contrejour.ghosts(lens, LIGHT, **parameters):
        total += ghost.relative_flux
        for surface in ghost.surfaces:
            by_surface[surface] += ghost.relative_flux
    return total, by_surface


def main(lens="heliar", better="broadband-5"):
    state = contrejour.configure_lens(lens, f_number=8)
    total, by_surface = flux_by_surface(state)
    surfaces = state.prescription.surfaces
    worst = max(by_surface, key=by_surface.get)
    print(f"{state.name}: all ghosts together have {total:.2e} of the light's flux")
    for surface, flux in sorted(by_surface.items(), key=lambda item: -item[1]):
        print(f"  surface {surface:2}: {100 * flux / total:5.1f} % of it, coated with {surfaces[surface - 1].coating}")
    changed, _ = flux_by_surface(state, coating_at=f"{worst}:{better}")
    print(f"with {better} on surface {worst}: {changed:.2e}, {100 * (1 - changed / total):.0f} % less")


if __name__ == "__main__":
    main(*sys.argv[1:])
