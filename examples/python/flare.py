# SPDX-License-Identifier: Apache-2.0
"""The flare of a lens with a light in front of it, as an image.

    python3 flare.py [LENS] [OUTPUT.exr] [SIZE]
"""
import sys

import contrejour


def main(lens="heliar", output="flare.exr", width="960"):
    width = int(width)
    state = contrejour.configure_lens(lens, f_number=8, blades=7)
    print(state)
    flare = contrejour.render(state, "12,8:1000", width=width, height=width * 2 // 3)
    contrejour.write_picture(output, flare.image, half=True)
    print(f"{output}: {flare.statistics['ghosts_rendered']} ghosts, {flare.statistics['time_ms']['total']:.0f} ms")


if __name__ == "__main__":
    main(*sys.argv[1:])
