#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""apply on a sequence: names, ranges, frames that are missing or damaged, resuming after any end, JSON."""
import json
import math
import random
import resource
import signal
import subprocess
import time
import unittest

import exr
from program import PROGRAM, ProgramTest

WIDTH, HEIGHT = 96, 64
LENS = ["heliar", "-f", "8", "--error", "0.003"]


class Sequence(ProgramTest):
    def write_frame(self, number, name="plate.{:04d}.exr", width=WIDTH):
        """A dim picture with a light that moves to the right."""
        values = [0.01] * (width * HEIGHT)
        values[20 * width + 20 + number % 40] = 5000.0
        exr.write(self.folder / name.format(number), {c: (exr.HALF, values) for c in "RGB"}, width, HEIGHT)

    def write_frames(self, *numbers):
        for number in numbers:
            self.write_frame(number)

    def apply(self, *arguments, code=0):
        return self.run_program("apply", *LENS, "plate.####.exr", "-o", "out.####.exr", *arguments, code=code)

    def outputs(self):
        return [name for name in self.files() if name.startswith("out.")]

    def test_each_frame_is_that_of_a_still(self):
        self.write_frames(1, 2, 3)
        lines = self.apply("--flare-only", "flare.%04d.exr", "--json").stdout.decode().splitlines()
        reports = [json.loads(line) for line in lines]
        self.assertEqual([report["frame"] for report in reports], [1, 2, 3])
        self.assertEqual([report["output"] for report in reports], ["out.0001.exr", "out.0002.exr", "out.0003.exr"])
        self.assertEqual([report["lights"][0]["centroid_px"] for report in reports], [[21.5, 20.5], [22.5, 20.5], [23.5, 20.5]])
        for number in (1, 2, 3):
            self.run_program("apply", *LENS, f"plate.{number:04d}.exr", "-o", "still.exr", "--flare-only", "alone.exr")
            for still, ours in (("still.exr", f"out.{number:04d}.exr"), ("alone.exr", f"flare.{number:04d}.exr")):
                self.assertEqual((self.folder / still).read_bytes(), (self.folder / ours).read_bytes())

    def test_ranges_and_other_spellings(self):
        self.write_frames(*range(1, 8))
        self.run_program("apply", *LENS, "plate.@@@@.exr", "-o", "out.%02d.png", "--frames", "1-5x2,7")
        self.assertEqual(self.outputs(), ["out.01.png", "out.03.png", "out.05.png", "out.07.png"])
        self.assertIn("not a range", self.error_of("apply", *LENS, "plate.#.exr", "-o", "out.#.exr", "--frames", "5-1", code=1))
        self.assertIn("####", self.error_of("apply", *LENS, "plate.####.exr", "-o", "out.exr", code=1))
        self.assertIn("no files", self.error_of("apply", *LENS, "other.####.exr", "-o", "out.#.exr", code=1))

    def test_a_file_with_such_a_name_is_a_still(self):
        self.write_frame(1, "shot#{}.exr")
        (self.folder / "shot#1.exr").rename(self.folder / "shot#.exr")
        self.run_program("apply", *LENS, "shot#.exr", "-o", "out.exr")
        self.assertEqual(self.outputs(), ["out.exr"])

    def test_missing_frames(self):
        self.write_frames(1, 2, 5)
        error = self.error_of("apply", *LENS, "plate.####.exr", "-o", "out.####.exr", "--frames", "1-5", code=1)
        self.assertIn("frames 3-4 are missing", error)
        self.assertEqual(self.outputs(), [])
        self.apply("--frames", "1-5", "--missing", "skip")
        self.assertEqual(self.outputs(), ["out.0001.exr", "out.0002.exr", "out.0005.exr"])
        self.apply("--frames", "1-5", "--missing", "black")
        self.assertEqual(len(self.outputs()), 5)
        black = exr.Picture(self.folder / "out.0003.exr")
        self.assertEqual((len(black.channels["G"]), set(black.channels["G"])), (WIDTH * HEIGHT, {0.0}))

    def test_bad_frames(self):
        self.write_frames(1, 2, 4, 5)
        self.write_frame(3, width=WIDTH + 6)
        whole = (self.folder / "plate.0004.exr").read_bytes()
        (self.folder / "plate.0004.exr").write_bytes(whole[:2000])
        done = self.apply(code=1)
        self.assertIn("frame 3: plate.0003.exr: the picture has 102 x 64 pixels, but frame 1", done.stderr.decode())
        self.assertEqual(self.outputs(), ["out.0001.exr", "out.0002.exr"])
        errors = self.apply("--keep-going", code=1).stderr.decode()
        self.assertIn("frame 3: plate.0003.exr", errors)
        self.assertIn("frame 4: plate.0004.exr", errors)
        self.assertIn("2 of 5 frames failed", errors)
        self.assertEqual(self.outputs(), ["out.0001.exr", "out.0002.exr", "out.0005.exr"])

    def test_resume_keeps_what_is_done_and_only_that(self):
        self.write_frames(1, 2, 3)
        self.apply()
        times = {name: (self.folder / name).stat().st_mtime_ns for name in self.outputs()}

        def changed(*arguments):
            self.apply("--resume", *arguments)
            now = {name: (self.folder / name).stat().st_mtime_ns for name in self.outputs()}
            different = [name for name in now if now[name] != times.get(name)]
            times.update(now)
            return different

        self.assertEqual(changed(), [])
        self.assertEqual(changed("--threads", "1"), [])
        self.write_frame(2)
        self.assertEqual(changed(), ["out.0002.exr"])
        (self.folder / "out.0003.exr").unlink()
        self.assertEqual(changed(), ["out.0003.exr"])
        (self.folder / "out.0001.exr").write_bytes(b"")
        self.assertEqual(changed(), ["out.0001.exr"])
        self.assertEqual(len(changed("--gain", "2")), 3)
        self.assertEqual(len(changed("--gain", "2", "--compression", "rle")), 3)

    def test_killed_at_any_moment(self):
        """After kill -9 or Ctrl-C every frame is whole, and --resume makes the rest: the same bits."""
        numbers = range(1, 13)
        self.write_frames(*numbers)
        started = time.monotonic()
        self.apply()
        whole = time.monotonic() - started
        expected = {name: (self.folder / name).read_bytes() for name in self.outputs()}
        command = [PROGRAM, "apply", *LENS, "plate.####.exr", "-o", "out.####.exr", "--resume"]
        moments = random.Random(5)
        for turn in range(8):
            for name in self.outputs():
                (self.folder / name).unlink()
            for _ in range(3):
                with subprocess.Popen(command, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as running:
                    time.sleep(moments.uniform(0, whole))
                    running.send_signal(signal.SIGKILL if turn % 2 else signal.SIGINT)
                    running.communicate(timeout=60)
                for name in self.outputs():
                    self.assertEqual((self.folder / name).read_bytes(), expected[name], name)
            self.apply("--resume")
            self.assertEqual({name: (self.folder / name).read_bytes() for name in self.outputs()}, expected)
            self.assertEqual([name for name in self.files() if "part" in name], [])

    def test_an_output_that_cannot_be_written(self):
        self.write_frames(1, 2, 3)
        (self.folder / "out.0002.exr").mkdir()
        done = self.apply("--keep-going", code=1)
        self.assertIn("frame 2: out.0002.exr", done.stderr.decode())
        self.assertTrue((self.folder / "out.0003.exr").is_file())

    def test_a_disk_that_is_full(self):
        """No file may become as large as a frame, as on a full disk: errors name frames, and finished ones stay."""
        self.write_frames(1, 2, 3)
        self.apply("--frames", "1")
        finished = (self.folder / "out.0001.exr").read_bytes()

        def with_little_room():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (len(finished) // 2, len(finished) // 2))
        command = [PROGRAM, "apply", *LENS, "plate.####.exr", "-o", "out.####.exr", "--keep-going"]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, timeout=60, preexec_fn=with_little_room)
        self.assertEqual(done.returncode, 1, done.stderr.decode())
        for number in (1, 2, 3):
            self.assertIn(f"frame {number}: ", done.stderr.decode())
        self.assertEqual(self.outputs(), ["out.0001.exr"])
        self.assertEqual((self.folder / "out.0001.exr").read_bytes(), finished)

    def write_shot(self):
        (self.folder / "lights.toml").write_text(
            '[parameters]\nfnumber = { 1 = 8, 4 = 11 }\n[[light]]\nat = { 1 = [0.4, 0.4], 4 = [0.7, 0.4] }\n'
            'value = 5000\non = { 1 = true, 4 = false }\n')

    def render(self, *arguments, code=0):
        return self.run_program("render", "heliar", "--size", "96x64", "--lights", "lights.toml", *arguments, code=code)

    def test_rendered_frames_are_those_of_stills(self):
        self.write_shot()
        lines = self.render("-o", "out.####.exr", "--frames", "1-4", "--json").stdout.decode().splitlines()
        self.assertEqual([(r["frame"], r["output"], r["lights"]) for r in map(json.loads, lines)],
                         [(n, f"out.{n:04d}.exr", int(n < 4)) for n in range(1, 5)])
        self.run_program("render", "heliar", "--size", "96x64", "-f", "10", "--light-at", "0.6,0.4:5000", "-o", "still.exr")
        self.assertEqual((self.folder / "out.0003.exr").read_bytes(), (self.folder / "still.exr").read_bytes())
        self.assertEqual(set(exr.Picture(self.folder / "out.0004.exr").channels["G"]), {0.0})
        self.assertIn("4 of 4 frames are done", self.render("-o", "out.####.exr", "--frames", "1-4", "--resume").stderr.decode())
        self.render("-o", "first.exr")  # a still: the first frame that has a key
        self.assertEqual((self.folder / "first.exr").read_bytes(), (self.folder / "out.0001.exr").read_bytes())

    def test_frames_in_flight_are_those_of_stills(self):
        if not any(device["usable"] for device in self.json_of("devices")):
            self.skipTest("no device is usable")
        self.write_shot()
        device = ["--device", "vulkan"]
        for count in (1, 2, 3):
            done = self.render("-o", f"of{count}.#.exr", "--frames", "1-6", "--json", "--frames-in-flight", count, *device)
            reports = [json.loads(line) for line in done.stdout.decode().splitlines()]
            self.assertEqual([report["frame"] for report in reports], list(range(1, 7)))
            self.assertNotEqual(reports[0]["statistics"]["device"], "cpu")
        for number in range(1, 7):
            for count in (2, 3):
                self.assertEqual((self.folder / f"of{count}.{number}.exr").read_bytes(),
                                 (self.folder / f"of1.{number}.exr").read_bytes(), (count, number))
        self.run_program("render", "heliar", "--size", "96x64", *device, "-f", "10", "--light-at", "0.6,0.4:5000", "-o", "still.exr")
        self.assertEqual((self.folder / "of2.3.exr").read_bytes(), (self.folder / "still.exr").read_bytes())
        done = self.render("-o", "of2.#.exr", "--frames", "1-6", "--resume", "--frames-in-flight", "1", *device)
        self.assertIn("6 of 6 frames are done", done.stderr.decode())
        self.write_frames(1, 2, 3, 5)
        for count in (1, 2):
            self.run_program("apply", *LENS, "plate.####.exr", "-o", f"on{count}.#.exr", "--device", "vulkan", "--frames", "1-5",
                             "--missing", "black", "--frames-in-flight", count)
        for number in range(1, 6):
            self.assertEqual((self.folder / f"on1.{number}.exr").read_bytes(), (self.folder / f"on2.{number}.exr").read_bytes())

    def test_the_number_of_frames_in_flight_is_checked(self):
        self.write_shot()
        for count in ("0", "9"):
            self.render("-o", "out.#.exr", "--frames", "1", "--frames-in-flight", count, code=2)

    def test_a_rendered_sequence_names_its_frames(self):
        self.write_shot()
        self.assertIn("--frames", self.render("-o", "out.####.exr", code=1).stderr.decode())
        self.assertIn("####", self.render("-o", "out.exr", "--frames", "1-4", code=1).stderr.decode())
        self.assertEqual(self.outputs(), [])

    def test_an_open_shutter_keeps_the_light_and_spreads_it(self):
        self.write_shot()
        sums, peaks = [], []
        for arguments in ([], ["--shutter-angle", "360"]):
            self.render("-o", "out.#.exr", "--frames", "2", *arguments)
            green = exr.Picture(self.folder / "out.2.exr").channels["G"]
            sums.append(sum(green))
            peaks.append(max(green))
        self.assertAlmostEqual(sums[1] / sums[0], 1.0, delta=0.15)
        self.assertLess(peaks[1], 0.7 * peaks[0])

    def blurred_and_mean(self, command, keys, light, sharp=32, degrees="360"):
        """PSNR in dB of a blurred frame against the mean of sharp ones; how often it was drawn."""
        def write(last):
            lines = "\n".join(f"{name} = {{ 0 = {a}, {last} = {b} }}" for name, (a, b) in keys.items())
            (self.folder / "lights.toml").write_text(
                f"[parameters]\n{lines}\n[[light]]\nat = {{ 0 = {light[0]}, {last} = {light[1]} }}\nvalue = 5000\n")
        write(sharp)
        run = [*command, "--lights", "lights.toml", "--error", "0.001"]
        self.run_program(*run, "-o", "sharp.#.exr", "--frames", f"0-{sharp}")
        pictures = [exr.Picture(self.folder / f"sharp.{k}.exr").channels for k in range(sharp + 1)]
        weights = [0.5 / sharp if k in (0, sharp) else 1 / sharp for k in range(sharp + 1)]
        write(1)
        run[-1] = "0.003"
        done = self.run_program(*run, "-o", "blurred.#.exr", "--frames", "0", "--shutter-angle", degrees, "--json")
        ours = exr.Picture(self.folder / "blurred.0.exr").channels
        self.run_program(*run, "-o", "still.exr", "--shutter-angle", degrees)
        self.assertEqual((self.folder / "still.exr").read_bytes(), (self.folder / "blurred.0.exr").read_bytes())
        means = [sum(w * value for w, value in zip(weights, values))
                 for c in "RGB" for values in zip(*(p[c] for p in pictures))]
        got = [value for c in "RGB" for value in ours[c]]
        peak = sorted(means)[int(0.999 * len(means))]
        mse = sum((min(a, peak) - min(b, peak)) ** 2 for a, b in zip(means, got)) / len(means)
        return 10 * math.log10(peak ** 2 / mse), json.loads(done.stdout)["drawn"]

    def test_a_zoom_is_blurred(self):
        command = ["render", "canon-70-200", "--select", "brightest:4", "--size", "96x64", "--wavelengths", "3", "-f", "8"]
        psnr, drawn = self.blurred_and_mean(command, {"focal": (135, 150)}, ([0.7, 0.33], [0.7, 0.33]))
        self.assertGreater(psnr, 45)
        self.assertLess(drawn, 32)
        _, drawn = self.blurred_and_mean(command, {"focal": (135, 135.01)}, ([0.7, 0.33], [0.7, 0.33]), sharp=1)
        self.assertEqual(drawn, 2)
        _, drawn = self.blurred_and_mean(command, {"focal": (135, 135.01)}, ([0.5, 0.33], [0.7, 0.33]), sharp=1)
        self.assertEqual(drawn, 3)  # the light on its way at once

    def test_focus_aperture_and_a_moving_light_are_blurred(self):
        command = ["render", "heliar", "--size", "96x64", "--wavelengths", "3"]
        psnr, drawn = self.blurred_and_mean(command, {"fnumber": (8, 11), "focus": (900, 2000)},
                                            ([0.6, 0.33], [0.7, 0.4]))
        self.assertGreater(psnr, 45)
        self.assertLess(drawn, 40)

    def test_a_photographs_flare_is_blurred_in_layers(self):
        self.write_frames(0)
        (self.folder / "lights.toml").write_text("[parameters]\nfnumber = { 0 = 8, 1 = 11 }\ngain = { 0 = 1, 1 = 3 }\n")
        run = ["apply", "heliar", "plate.0000.exr", "-o", "out.exr", "--flare-only", "flare.exr", "--lights", "lights.toml",
               "--shutter-angle", "180"]
        self.run_program(*run, "--layers", "ghost", "--layer-count", "3")
        channels = exr.Picture(self.folder / "flare.exr").channels
        layers = [values for name, values in channels.items() if name.endswith(".G")]
        self.assertEqual(len(layers), 4)
        for whole, *parts in zip(channels["G"], *layers):
            self.assertAlmostEqual(whole, sum(parts), delta=1e-6 * max(channels["G"]))
        (self.folder / "lights.toml").write_text("[parameters]\ngain = { 0 = 1, 1 = 3 }\n")
        self.run_program(*run, "-f", "8")
        blurred = exr.Picture(self.folder / "flare.exr").channels["G"]
        self.run_program("apply", "heliar", "plate.0000.exr", "-o", "out.exr", "--flare-only", "one.exr", "-f", "8")
        one = exr.Picture(self.folder / "one.exr").channels["G"]
        self.assertAlmostEqual(sum(blurred) / sum(one), 1.5, delta=1e-3)

    def test_resuming_follows_what_changes_in_the_exposure(self):
        def write(fnumber):
            (self.folder / "lights.toml").write_text(
                f"[parameters]\nfnumber = {{ 1 = 8, 2 = {fnumber} }}\n[[light]]\nat = [0.4, 0.4]\nvalue = 5000\n")
        run = ["-o", "out.#.exr", "--frames", "1-2", "--shutter-angle", "180"]
        write(11)
        self.render(*run)
        self.assertIn("2 of 2 frames are done", self.render(*run, "--resume").stderr.decode())
        write(16)
        self.assertNotIn("2 of 2", self.render(*run, "--resume").stderr.decode())


if __name__ == "__main__":
    unittest.main()
