# SPDX-License-Identifier: Apache-2.0
"""Values with keys, in files of lights."""


def at_frame(value, frame):
    """What a value of the file is at a frame: linear between numbers, the earlier key's text or switch."""
    if not isinstance(value, dict):
        return value
    keys = sorted((int(key), item) for key, item in value.items() if key != "between")
    before = [key for key in keys if key[0] <= frame]
    after = [key for key in keys if key[0] > frame]
    if not before:
        return keys[0][1]
    (start, a) = before[-1]
    if not after or isinstance(a, (bool, str)):
        return a
    (end, b) = after[0]
    t = (frame - start) / (end - start)
    if isinstance(a, list):
        return [x + t * (y - x) for x, y in zip(a, b)]
    return a + t * (b - a)
