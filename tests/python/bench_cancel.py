# SPDX-License-Identifier: Apache-2.0
"""How long calls run on after their CancelFlag was set, in processor time of one thread: on a machine of one's own that is
the time until they return. Not part of the tests.

    PYTHONPATH=build/release/python python3 tests/python/bench_cancel.py [CANCELS [NAME ...]]
"""
import random
import sys
import threading
import time

import numpy as np

import contrejour

LENS = "canon-70-200"
LIGHT = "9,5:1000"
FRAME = {"width": 960, "height": 540, "threads": 1}


def photograph():
    picture = np.full((1080, 1920, 3), 0.1, np.float32)
    picture[::90, ::160] = 5000
    return picture


def calls():
    """By name: a call that takes a flag, and its processor time in seconds before which it is cancelled."""
    picture = photograph()

    def render(lens=LENS, light=LIGHT, **parameters):
        return lambda flag: contrejour.render(lens, light, cancel=flag, **{**FRAME, **parameters})

    return {
        "adaptive": (render(), 1.5),
        "adaptive, wide open": (render(f_number=2.9), 3.0),
        "adaptive, hundred lights": (render(light=[f"{k % 10 - 5},{k // 10 - 5}:1000" for k in range(100)]), 8.0),
        "starburst and glare": (render(starburst=True, glare=0.1), 3.0),
        "ringing": (render(ringing="fresnel"), 4.0),
        "dirt": (render(dust=300, scratches=10), 3.0),
        "light with a size": (render(light_size=2.0), 3.0),
        "tiled": (render(method="tiled"), 2.0),
        "bundle": (render(method="bundle"), 4.0),
        "polynomial": (render(method="polynomial"), 6.0),
        "reference": (render(method="reference", density=16), 5.0),
        "reference, anamorphic": (render("schneider-anamorphic-31", method="reference", density=16), 5.0),
        "wavelengths by need": (render(wavelengths="auto"), 3.0),
        "layers by ghost": (
            lambda flag: contrejour.render_layers(LENS, LIGHT, by="ghost", cancel=flag, **FRAME),
            2.5,
        ),
        "starburst alone": (
            lambda flag: contrejour.starburst(LENS, LIGHT, f_number=16, cancel=flag, width=1920, height=1080, threads=1),
            1.0,
        ),
        "ghosts": (lambda flag: contrejour.ghosts(LENS, (9, 5), cancel=flag, threads=1), 2.0),
        "apply": (lambda flag: contrejour.apply(picture, LENS, cancel=flag, threads=1), 6.0),
        "trace": (
            lambda flag: contrejour.trace(LENS, *rays(3_000_000), cancel=flag, threads=1),
            2.0,
        ),
    }


def rays(count):
    origins = np.zeros((count, 3))
    origins[:, 1] = np.linspace(-5, 5, count)
    return origins, np.tile([0.0, 0.0, 1.0], (count, 1))


def cancelled(call, after_s):
    """Processor time in ms from the flag to the call's end; None if the call ended first."""
    flag, error = contrejour.CancelFlag(), []

    def run():
        try:
            call(flag)
        except contrejour.CancelledError as cancelled_error:
            error.append(cancelled_error)

    thread = threading.Thread(target=run)
    began = time.process_time()
    thread.start()
    while time.process_time() - began < after_s and thread.is_alive():
        time.sleep(0.002)
    flagged = time.process_time()
    flag.set()
    thread.join()
    return 1e3 * (time.process_time() - flagged) if error else None


def main(cancels=8, *names):
    random.seed(1)
    for name, (call, longest_s) in calls().items():
        if names and name not in names:
            continue
        times = [cancelled(call, random.uniform(0.0, longest_s)) for _ in range(int(cancels))]
        ended = [t for t in times if t is not None]
        worst = f"{max(ended):6.1f} ms at worst, {sorted(ended)[len(ended) // 2]:6.1f} in the middle" if ended else ""
        print(f"{name:26} {len(ended):2} cancelled of {len(times)}: {worst}", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
