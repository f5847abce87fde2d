# SPDX-License-Identifier: Apache-2.0
"""Names of a sequence's files. No part of Blender is needed here."""
from __future__ import annotations

import re

_HASHES = re.compile(r"#+(?=[^#/\\]*$)")


def frame_file(pattern: str, frame: int) -> str:
    """The pattern with its last #### replaced by the frame's number; without one, the number precedes the extension."""
    if not pattern.lower().endswith(".exr"):
        pattern += ".exr"
    if not _HASHES.search(pattern):
        pattern = f"{pattern[:-4]}####{pattern[-4:]}"
    return _HASHES.sub(lambda hashes: f"{frame:0{len(hashes.group())}d}", pattern)
