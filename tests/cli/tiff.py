# SPDX-License-Identifier: Apache-2.0
"""Uncompressed TIFF 6.0 in plain Python."""
import struct


def write(path, values, width, height, channels=3, claimed=None):
    """One strip of 16-bit values. claimed: a size that the file states falsely."""
    tags = [(256, 4, (claimed or (width, height))[0]), (257, 4, (claimed or (width, height))[1]), (258, 3, 16), (259, 3, 1),
            (262, 3, 2 if channels == 3 else 1), (273, 4, 0), (277, 3, channels), (278, 4, height), (279, 4, 2 * len(values))]
    size = 8 + 2 + 12 * len(tags) + 4
    bits = struct.pack("<3H", 16, 16, 16)
    out = struct.pack("<2sHIH", b"II", 42, 8, len(tags))
    for tag, kind, value in tags:
        if tag == 258 and channels == 3:
            out += struct.pack("<HHII", tag, 3, 3, size)
        else:
            out += struct.pack("<HHII", tag, kind, 1, size + len(bits) if tag == 273 else value)
    path.write_bytes(out + struct.pack("<I", 0) + bits + struct.pack(f"<{len(values)}H", *values))
