# SPDX-License-Identifier: Apache-2.0
"""Starts Blender on tests of the add-on, where there is one that can load the Python package; exit 77: there is none.

    run_in_blender.py MODULE[.CLASS[.TEST]] ...
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).parent
SKIPPED = 77


def blender_command(environment=None):
    """How to start it, or None and the reason why not."""
    blender = shutil.which(os.environ.get("BLENDER", "blender"))
    if blender is None:
        return None, "SKIPPED: there is no Blender here (./dev blender installs Debian's)"
    command = [blender, "--background", "--factory-startup", "--python-exit-code", "1"]
    tried = subprocess.run([*command, "--python-expr", "import contrejour"], capture_output=True, text=True,
                           env={**os.environ, **(environment or {})})
    if tried.returncode != 0:
        return None, f"SKIPPED: {blender} has a Python that does not load the package\n{tried.stdout}{tried.stderr}"
    return command, ""


def main(names):
    command, reason = blender_command()
    if command is None:
        print(reason)
        return SKIPPED
    with tempfile.TemporaryDirectory() as scripts:  # where presets are kept
        environment = {**os.environ, "BLENDER_USER_SCRIPTS": scripts}
        command += ["--python", str(HERE / "inside_blender.py"), "--", *names]
        done = subprocess.run(command, capture_output=True, text=True, env=environment)
    lines = (done.stdout + done.stderr).splitlines()
    print("\n".join(line for line in lines if not line.startswith(("Fra:", "Saved:", " Time:"))))
    return done.returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
