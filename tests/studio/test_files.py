# SPDX-License-Identifier: Apache-2.0
"""Sessions, exports and the command lines that make the same picture; work that is offered again after a crash."""
import json
import os
import shlex
import signal
import subprocess
import time

from studio_program import PROGRAM, STUDIO, StudioTest, read_exr, run_tests, scene


class SamePicture(StudioTest):
    def render(self, command):
        done = subprocess.run(command, cwd=self.folder, capture_output=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr.decode())

    def test_the_picture_shown_is_the_command_lines_bit_for_bit(self):
        lines = [["wait"], ["drag", "viewport/light/1", 90, 30, 6], ["key", "]"], ["key", "m"], ["key", "f3"], ["frames", 3],
                 ["click", "prescription/2/semi-diameter"], ["type", "9.5"], ["key", "enter"], ["wait"], ["key", "ctrl+s"], ["wait"],
                 ["picture", "shown.exr"], ["state", "state.json"]]
        self.run_studio(lines)
        state = self.state()
        self.assertTrue(state["edited"])
        self.assertTrue(state["history"]["saved"])
        self.render([PROGRAM, "render", "--session", "start.session.json", "-o", "cli.exr"])
        self.assertEqual(read_exr(self.folder / "cli.exr"), read_exr(self.folder / "shown.exr"))
        self.render([PROGRAM, "render", "--session", "start.session.json", "-f", "11", "-o", "other.exr"])
        self.assertNotEqual(read_exr(self.folder / "other.exr"), read_exr(self.folder / "shown.exr"))

    def test_the_command_of_all_values_makes_it_too(self):
        (self.folder / "start.session.json").write_text(scene("distagon-25", starburst="on", blades="7", ghost=["2-3:gain=0"]))
        state = self.state_after([["drag", "viewport/light/1", 40, 30, 4], ["wait"], ["picture", "shown.exr"]])
        command = shlex.split(state["command"])
        self.assertEqual(command[0], "contrejour")
        self.render([PROGRAM, *command[1:]])
        self.assertEqual(read_exr(self.folder / "flare.exr"), read_exr(self.folder / "shown.exr"))

    def test_a_session_stands_where_a_lens_may(self):
        done = subprocess.run([PROGRAM, "lens", "info", "start.session.json", "--json"], cwd=self.folder, capture_output=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr.decode())
        self.assertIn("Heliar", done.stdout.decode())

    def test_apply_takes_a_session_without_a_lens(self):
        self.render([PROGRAM, "render", "heliar", "--starburst", "--size", "64x48", "-o", "plate.exr"])
        self.render([PROGRAM, "apply", "--session", "start.session.json", "--no-detect", "plate.exr", "-o", "out.exr"])
        self.assertNotEqual(read_exr(self.folder / "out.exr"), read_exr(self.folder / "plate.exr"))

    def test_wrong_sessions_are_refused_by_name(self):
        (self.folder / "bad.session.json").write_text('{"contrejour-session": 1, "values": {"fnumber": "wide"}}')
        done = subprocess.run([PROGRAM, "render", "--session", "bad.session.json", "-o", "a.exr"], cwd=self.folder, capture_output=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("bad.session.json:1: fnumber", done.stderr.decode())
        done = subprocess.run([PROGRAM, "render", "--session", "bad.json", "-o", "a.exr"], cwd=self.folder, capture_output=True)
        self.assertEqual(done.returncode, 2)

    def test_export_by_the_keyboard_alone(self):
        lines = [["key", "ctrl+e"], ["frames", 3], ["state", "dialog.json"], ["type", "out.exr"], ["key", "enter"], ["wait"], ["picture", "shown.exr"]]
        state = self.state_after(lines)
        self.assertTrue(self.widget(self.state("dialog.json"), "export/command")["value"].startswith("contrejour render heliar"))
        self.assertEqual(state["dialog"], 0)
        self.assertEqual(read_exr(self.folder / "out.exr"), read_exr(self.folder / "shown.exr"))

    def test_a_lens_is_opened_and_an_unknown_one_refused_in_the_dialog(self):
        lines = [["key", "ctrl+o"], ["frames", 3], ["type", "no-such-lens"], ["key", "enter"], ["frames", 3], ["state", "refused.json"],
                 ["click", "dialog/path"], ["key", "ctrl+a"], ["type", "tessar"], ["key", "enter"], ["wait"], ["state", "opened.json"],
                 ["key", "ctrl+o"], ["frames", 4], ["type", str(self.folder / "lenses")], ["key", "enter"], ["frames", 4], ["state", "listed.json"],
                 ["type", "mine.session.json"], ["key", "enter"], ["wait"], ["key", "ctrl+o"], ["frames", 4], ["state", "again.json"], ["key", "escape"],
                 ["frames", 2], ["key", "escape"], ["frames", 2], ["click", "toolbar/lens"], ["frames", 3], ["type", "color-h"], ["frames", 2],
                 ["state", "found.json"], ["key", "enter"], ["wait"], ["key", "ctrl+s"], ["frames", 4]]
        (self.folder / "lenses").mkdir()
        (self.folder / "lenses" / "mine.session.json").write_text(scene("distagon-25"))
        (self.folder / "lenses" / "picture.png").write_bytes(b"")
        state = self.state_after(lines)
        self.assertEqual(self.state("opened.json")["lens"], "tessar")
        listed, again, found = (self.state(f"{name}.json") for name in ("listed", "again", "found"))
        self.assertNotEqual(listed["dialog"], 0)
        self.assertEqual([w["id"] for w in listed["widgets"] if w["id"].startswith("folder/")], ["folder/mine.session.json"])
        self.assertEqual(self.widget(listed, "dialog/all-files")["value"], "1")
        self.assertEqual(self.widget(again, "dialog/path")["value"], str(self.folder / "lenses") + "/")
        self.assertEqual([w["id"] for w in found["widgets"] if w["id"].startswith("toolbar/lens/") and w["id"] != "toolbar/lens/find"],
                         ["toolbar/lens/heliar"])
        self.assertNotEqual(self.state("refused.json")["dialog"], 0)
        self.assertIn("no-such-lens", self.state("refused.json")["problem"])
        self.assertEqual(state["lens"], "heliar")


class Recovery(StudioTest):
    def killed_with_unsaved_work(self):
        """Runs the studio, changes the light, and kills it without warning."""
        lines = [["wait"], ["drag", "viewport/light/1", 50, 50, 5], ["autosave"], ["state", "killed.json"], ["sleep", 60]]
        command = self.xvfb(STUDIO, "start.session.json", "--script", self.script(lines))
        running = subprocess.Popen(command, cwd=self.folder, env=self.environment(), start_new_session=True)
        try:
            for _ in range(600):
                time.sleep(0.1)
                if (self.folder / "killed.json").exists():
                    break
        finally:
            for pid in children_of(running.pid):
                os.kill(pid, signal.SIGKILL)
            running.wait(timeout=60)
        return json.loads((self.folder / "killed.json").read_text())

    def test_killed_work_is_offered_and_recovered(self):
        killed = self.killed_with_unsaved_work()
        lines = [["frames", 4], ["state", "offered.json"], ["click", "recover/1"]]
        state = self.state_after(lines, start=None)
        self.assertIn("recover/1", [w["id"] for w in self.state("offered.json")["widgets"]])
        self.assertEqual(state["lights"], killed["lights"])
        self.assertEqual(state["file"], "start.session.json")
        self.assertFalse(state["history"]["saved"])

    def test_unsaved_changes_are_asked_about(self):
        self.run_studio([["wait"], ["drag", "viewport/light/1", 50, 50, 5], ["autosave"], ["close"], ["frames", 3], ["state", "asked.json"],
                         ["click", "quit/cancel"], ["frames", 2], ["state", "state.json"], ["key", "ctrl+q"], ["frames", 3], ["click", "quit/discard"],
                         ["frames", 3], ["state", "later.json"]])
        state = self.state()
        self.assertIn("quit/discard", [w["id"] for w in self.state("asked.json")["widgets"]])
        self.assertEqual(state["dialog"], 0)
        self.assertFalse((self.folder / "later.json").exists())
        self.assertEqual(list((self.folder / "state").rglob("autosave*")), [])


def children_of(pid):
    """The studio among the children of xvfb-run, by its own name."""
    found = []
    for line in subprocess.run(["ps", "-o", "pid=,comm=", "--ppid", str(pid)], capture_output=True, text=True).stdout.splitlines():
        number, name = line.split(None, 1)
        if name.startswith("contrejour-stu"):
            found.append(int(number))
    return found


if __name__ == "__main__":
    run_tests()
