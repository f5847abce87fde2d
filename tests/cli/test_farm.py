#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A sequence in chunks for a render farm: command lines, Slurm's script, and a real cluster of Slurm."""
import json
import os
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest

import slurm
from program import PROGRAM, ProgramTest

RENDER = ["render", "heliar", "-f", "8", "--size", "96x64", "--light-at", "0.6,0.3", "-o", "out.####.exr"]


class Farm(ProgramTest):
    def listed(self, *arguments):
        return self.run_program(*RENDER, *arguments, "--list-frames").stdout.decode()

    def frames_alone(self, frames):
        """The bytes of the frames as one machine renders them."""
        alone = self.folder / "alone"
        alone.mkdir()
        self.run_program(*RENDER, "--frames", frames, folder=alone)
        return {file.name: file.read_bytes() for file in alone.glob("out.*.exr")}

    def frames_here(self):
        return {file.name: file.read_bytes() for file in self.folder.glob("out.*.exr")}

    def test_frames_that_are_left(self):
        self.assertEqual(self.listed("--frames", "1-4,9"), "1-4,9\n")
        self.assertEqual(self.files(), [])
        self.run_program(*RENDER, "--frames", "2,3")
        self.assertEqual(self.listed("--frames", "1-4", "--resume"), "1,4\n")
        self.assertEqual(self.listed("--frames", "2-3", "--resume"), "")
        self.assertIn("sequence", self.error_of("render", "heliar", "-o", "a.exr", "--list-frames", code=1))

    def test_command_lines(self):
        folder = self.folder / "it's a shot"
        folder.mkdir()
        lines = self.run_program("farm", "commands", "--chunk", "2", "--", *RENDER, "--frames=1-5", folder=folder)
        lines = lines.stdout.decode().splitlines()
        self.assertEqual(len(lines), 3)
        for line in reversed(lines):
            subprocess.run(["sh", "-c", line], check=True, cwd="/", capture_output=True, timeout=300)
        rendered = {file.name: file.read_bytes() for file in folder.glob("out.*.exr")}
        self.assertEqual(rendered, self.frames_alone("1-5"))
        self.assertEqual(self.run_program("farm", "commands", "--", *RENDER, "--frames", "1-5", folder=folder).stdout, b"")

    def test_script(self):
        script = self.run_program("farm", "slurm", "--chunk", "10", "--cpus", "4", "--at-once", "3", "--logs", "50% \"done\"",
                                  "--sbatch=--partition=night", "--program", "/opt/contrejour", "--", *RENDER,
                                  "--frames", "1001-1025", "--resume").stdout.decode()
        for line in ("#SBATCH --array=0-2%3", "#SBATCH --cpus-per-task=4", "#SBATCH --partition=night",
                     '#SBATCH --output="50%% \\"done\\"/%A-%a.txt"', "0) frames=1001-1010 ;;", "2) frames=1021-1025 ;;"):
            self.assertIn(line + "\n", script)
        self.assertEqual(script.count("--resume"), 1)
        self.assertIn("exec /opt/contrejour render heliar -f 8", script)
        subprocess.run(["sh", "-n"], input=script.encode(), check=True)

    def test_bad_commands(self):
        self.assertIn("--layer-ghosts", self.error_of("farm", "commands", "--", *RENDER, "--layers", "ghost", code=1))
        self.assertIn("`lens`", self.error_of("farm", "commands", "--", "lens", "list", code=1))
        done = self.run_program("farm", "slurm", "--", "render", "no-such-lens", "-o", "o.#.exr", "--frames", "1", code=1)
        self.assertIn("no-such-lens", done.stderr.decode())
        self.assertIn("####", self.error_of_last("farm", "commands", "--", "render", "heliar", "-o", "o.exr"))
        environment = dict(os.environ, PATH=str(self.folder))
        done = subprocess.run([PROGRAM, "farm", "slurm", "--submit", "--", *RENDER, "--frames", "1"], env=environment,
                              cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("contrejour: sbatch: the program cannot be started", done.stderr)

    def error_of_last(self, *arguments):
        """The messages of a command and of the one that ran it."""
        return self.run_program(*arguments, code=1).stderr.decode()

    @unittest.skipIf(slurm.reason_against(), f"SKIPPED: {slurm.reason_against()}")
    def test_a_cluster_renders_what_one_machine_does(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        with self.cluster_in(holder.name + "/cluster") as cluster:
            run = subprocess.Popen(
                [PROGRAM, "farm", "slurm", "--wait", "--poll", "1", "--chunk", "3", "--json", "--", *RENDER, "--frames", "1-12"],
                cwd=self.folder, env=cluster.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            self.assertTrue(self.kill_a_task(run), "no task was seen")
            out, error = run.communicate(timeout=300)
        self.assertEqual(run.returncode, 0, error.decode() + cluster.logs())
        report = json.loads(out)
        self.assertEqual((report["frames"], report["failed"]), (12, ""))
        self.assertGreaterEqual(len(report["jobs"]), 2, "the frames of the killed task were not submitted again")
        self.assertIn("are submitted again", error.decode())
        self.assertEqual(self.frames_here(), self.frames_alone("1-12"))

    def cluster_in(self, folder):
        """A cluster that has started. A machine may forbid what its daemons need."""
        cluster = slurm.Cluster(folder)
        try:
            cluster.start()
        except (RuntimeError, OSError, subprocess.TimeoutExpired) as error:
            self.skipTest(f"SKIPPED: no cluster can be started here: {error}")
        return cluster

    def kill_a_task(self, run):
        """Kills the first task that runs, as it is seen, with no chance to clean up."""
        while run.poll() is None:
            for entry in pathlib.Path("/proc").glob("[0-9]*"):
                try:
                    words = (entry / "cmdline").read_bytes().split(b"\0")
                    here = os.readlink(entry / "cwd") == str(self.folder)
                except OSError:
                    continue  # the process has ended
                if here and any(word.startswith(b"--frames=") for word in words) and b"--list-frames" not in words:
                    os.kill(int(entry.name), signal.SIGKILL)
                    return True
            time.sleep(0.005)
        return False


if __name__ == "__main__":
    unittest.main()
