# SPDX-License-Identifier: Apache-2.0
"""How the studio starts: its first scene, its options, and what it says without a display or without OpenGL 3.3."""
import subprocess

from studio_program import PROGRAM, STUDIO, StudioTest, run_tests


class Start(StudioTest):
    def run_plainly(self, *command, **environment):
        return subprocess.run([str(c) for c in command], cwd=self.folder, env=self.environment(**environment), capture_output=True, timeout=120)

    def test_the_first_scene_is_shown_at_once_and_at_rest_refined(self):
        state = self.state_after([], start=None)
        self.assertEqual(state["lens"], "distagon-25")
        self.assertEqual(state["shown"]["kind"], "refined")
        self.assertEqual(len(state["ghosts"]), 105)
        self.assertEqual(state["problem"], "")

    def test_without_a_display_it_says_so(self):
        done = self.run_plainly(STUDIO)
        self.assertEqual(done.returncode, 1)
        self.assertIn("no display", done.stderr.decode())
        self.assertIn("contrejour render --session", done.stderr.decode())

    def test_without_opengl_3_it_says_so(self):
        done = self.run_plainly(*self.xvfb(STUDIO), MESA_GL_VERSION_OVERRIDE="2.1")
        self.assertEqual(done.returncode, 1)
        self.assertIn("OpenGL 3.3", done.stderr.decode())

    def test_contrejour_studio_starts_it(self):
        done = self.run_plainly(PROGRAM, "studio", "--list-keys")
        self.assertEqual(done.returncode, 0, done.stderr.decode())
        self.assertIn("ctrl+shift+z", done.stdout.decode())

    def test_wrong_options_and_scripts_are_refused(self):
        self.assertEqual(self.run_plainly(STUDIO, "--window", "tiny").returncode, 2)
        self.assertEqual(self.run_plainly(STUDIO, "--no-such-option").returncode, 2)
        self.assertEqual(self.run_plainly(STUDIO, "--scale", "9").returncode, 2)
        (self.folder / "bad.script").write_text('["wait"]\n["jump"]\n')
        done = self.run_plainly(STUDIO, "--script", "bad.script")
        self.assertEqual(done.returncode, 1)
        self.assertIn("bad.script:2:", done.stderr.decode())

    def test_a_script_that_asks_for_what_is_not_there_fails(self):
        done = self.run_studio([["click", "no/such/widget"]], code=1)
        self.assertIn("no/such/widget", done.stderr.decode())


if __name__ == "__main__":
    run_tests()
