# SPDX-License-Identifier: Apache-2.0
"""Runs the studio by a script under Xvfb, and reads what it wrote. Exits with 77 where there is no Xvfb."""
import json
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
import exr  # noqa: E402  of the tests of the command line

STUDIO = os.environ.get("CONTREJOUR_STUDIO", "contrejour-studio")
PROGRAM = os.environ.get("CONTREJOUR", "contrejour")
SKIPPED = 77


def read_exr(path):
    return exr.Picture(path).channels



def scene(lens="heliar", **values):
    """A small session's text: quick to render."""
    values = {"size": "320x180", "fnumber": "8", "light-at": ["0.3,0.3:20000"], "starburst": "off", **values}
    return json.dumps({"contrejour-session": 1, "lens": lens, "values": values})


class StudioTest(unittest.TestCase):
    environment_more = {}

    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)
        (self.folder / "start.session.json").write_text(scene())

    def environment(self, **more):
        keep = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
        return {**keep, "XDG_STATE_HOME": str(self.folder / "state"), "XDG_DATA_HOME": str(self.folder / "data"),
                "XDG_CACHE_HOME": str(self.folder / "cache"), "LIBGL_ALWAYS_SOFTWARE": "1", **self.environment_more, **more}

    def xvfb(self, *command):
        return ["xvfb-run", "-a", "-s", "-screen 0 1600x900x24 -nolisten tcp", *map(str, command)]

    def script(self, lines):
        file = self.folder / "test.script"
        file.write_text("\n".join(json.dumps(line) for line in [*lines, ["quit"]]))
        return file

    def run_studio(self, lines, *arguments, code=0, start="start.session.json", window="800x560"):
        """Runs the lines; a line ["state", NAME] or ["screenshot", NAME] writes into the test's folder."""
        arguments = [*([start] if start else []), "--window", window, "--no-vsync", *arguments]
        # The program's own exit code: xvfb-run's is 5 where it fails to remove its temporary folder.
        own = self.folder / "studio.code"
        command = self.xvfb("sh", "-c", '"$@"; echo $? > "$0"', own, STUDIO, *arguments, "--script", self.script(lines))
        done = subprocess.run(command, cwd=self.folder, env=self.environment(), capture_output=True, timeout=240)
        self.assertEqual(own.read_text().strip(), str(code), done.stdout.decode() + done.stderr.decode())
        return done

    def state(self, name="state.json"):
        return json.loads((self.folder / name).read_text())

    def state_after(self, lines, *arguments, **options):
        self.run_studio([["wait"], *lines, ["wait"], ["state", "state.json"]], *arguments, **options)
        return self.state()

    def widget(self, state, name):
        found = [w for w in state["widgets"] if w["id"] == name]
        self.assertTrue(found, f"no widget {name}")
        return found[0]

    def picture(self, name):
        return read_png((self.folder / name).read_bytes())


def read_png(data):
    """An 8-bit RGB PNG as (width, height, rows of bytes). From the PNG specification; shares no code with the program."""
    at, header, packed = 8, None, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", data[at + 8:at + 8 + length])
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    width, height = header[:2]
    assert header[2:4] == (8, 2), header
    raw, rows, before = zlib.decompress(packed), [], bytes(3 * width)
    for y in range(height):
        line = bytearray(raw[y * (3 * width + 1) + 1:(y + 1) * (3 * width + 1)])
        before = unfiltered(raw[y * (3 * width + 1)], line, before)
        rows.append(before)
    return width, height, rows


def unfiltered(method, line, above):
    if method == 2:
        return bytes((a + b) & 255 for a, b in zip(line, above))
    for k in range(len(line) if method else 0):
        left = line[k - 3] if k >= 3 else 0
        corner = above[k - 3] if k >= 3 else 0
        line[k] = (line[k] + {1: left, 3: (left + above[k]) // 2, 4: paeth(left, above[k], corner)}[method]) & 255
    return bytes(line)


def paeth(left, above, corner):
    guess = left + above - corner
    return min((abs(guess - left), 0, left), (abs(guess - above), 1, above), (abs(guess - corner), 2, corner))[2]


def run_tests():
    if shutil.which("xvfb-run") is None:
        print("SKIPPED: xvfb-run is not installed (Debian: xvfb, xauth)")
        sys.exit(SKIPPED)
    unittest.main()
