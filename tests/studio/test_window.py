# SPDX-License-Identifier: Apache-2.0
"""The studio's window with real input: drags, clicks, typing and keys; read back from its state and its pixels."""

from studio_program import StudioTest, run_tests


def mean_level(picture, rect):
    _, _, rows = picture
    x0, y0, x1, y1 = (int(v) for v in rect)
    levels = [sum(rows[y][3 * x0:3 * x1]) / (3 * (x1 - x0)) for y in range(y0, y1)]
    return sum(levels) / len(levels)


class Viewport(StudioTest):
    def test_drag_of_a_light_is_one_step_with_draft_and_picture(self):
        lines = [["wait"], ["state", "before.json"], ["drag", "viewport/light/1", 120, 60, 12], ["state", "dragged.json"],
                 ["wait"], ["state", "after.json"], ["key", "ctrl+z"], ["wait"], ["state", "undone.json"]]
        self.run_studio(lines)
        before, dragged, after, undone = (self.state(f"{n}.json") for n in ("before", "dragged", "after", "undone"))
        picture = self.widget(before, "viewport/picture")["rect"]
        width, height = picture[2] - picture[0], picture[3] - picture[1]
        moved = [a - b for a, b in zip(after["lights"][0]["at"], before["lights"][0]["at"])]
        self.assertAlmostEqual(moved[0] * width, 120, delta=1)
        self.assertAlmostEqual(moved[1] * height, 60, delta=1)
        self.assertEqual(after["history"]["steps"][-1], "move light 1")
        self.assertEqual(len(after["history"]["steps"]), len(before["history"]["steps"]) + 1)
        self.assertEqual(after["shown"]["kind"], "refined")
        self.assertEqual(after["shown"]["revision"], after["revision"])
        self.assertEqual(after["lights"], dragged["lights"])
        self.assertEqual(undone["lights"], before["lights"])

    def test_a_light_outside_the_frame_has_a_handle_and_ghosts(self):
        state = self.state_after([["drag", "viewport/light/1", -600, -20, 8]])
        self.assertIn("frame widths outside", self.widget(state, "viewport/light/1/outside")["value"])
        self.assertLess(state["lights"][0]["at"][0], -0.1)
        handle, viewport = self.widget(state, "viewport/light/1")["rect"], self.widget(state, "viewport")["rect"]
        self.assertGreaterEqual(handle[0], viewport[0])
        self.assertEqual(state["shown"]["kind"], "refined")
        self.assertEqual(state["problem"], "")

    def test_lights_are_added_nudged_and_removed(self):
        lines = [["double-click", "viewport/picture", 0.7, 0.6], ["wait"], ["state", "added.json"], ["key", "right"], ["key", "shift+down"],
                 ["state", "nudged.json"], ["key", "delete"]]
        state = self.state_after(lines)
        added, nudged = self.state("added.json"), self.state("nudged.json")
        self.assertEqual(len(added["lights"]), 2)
        self.assertAlmostEqual(added["lights"][1]["at"][0], 0.7, delta=0.01)
        self.assertEqual((added["selection"]["light"], added["selection"]["ghost"]), (1, ""))
        self.assertEqual(added["message"], "light 2 added; Ctrl+Z takes it away")
        self.assertAlmostEqual((nudged["lights"][1]["at"][0] - added["lights"][1]["at"][0]) * 320, 1, delta=0.01)
        self.assertAlmostEqual((nudged["lights"][1]["at"][1] - added["lights"][1]["at"][1]) * 180, 10, delta=0.01)
        self.assertEqual(len(state["lights"]), 1)

    def test_zoom_keeps_the_point_under_the_mouse_and_fit_comes_back(self):
        lines = [["wait"], ["state", "a.json"], ["wheel", "viewport/picture", 3, 0.25, 0.5], ["state", "b.json"], ["key", "z"], ["frames", 2]]
        state = self.state_after(lines)
        rect = [self.widget(self.state(n), "viewport/picture")["rect"] for n in ("a.json", "b.json")]
        at = [r[0] + 0.25 * (r[2] - r[0]) for r in rect]
        self.assertGreater(rect[1][2] - rect[1][0], 1.4 * (rect[0][2] - rect[0][0]))
        self.assertAlmostEqual(at[0], at[1], delta=1.5)
        self.assertEqual(state["zoom"], 1)

    def test_exposure_changes_the_pixels_not_the_picture(self):
        lines = [["wait"], ["screenshot", "a.png"], ["state", "a.json"], ["key", "="], ["key", "="], ["key", "="], ["key", "="], ["wait"],
                 ["screenshot", "b.png"]]
        state = self.state_after(lines, window="640x480")
        rect = self.widget(state, "viewport/picture")["rect"]
        self.assertGreater(mean_level(self.picture("b.png"), rect), mean_level(self.picture("a.png"), rect) + 3)
        self.assertAlmostEqual(state["shown"]["stops"] - self.state("a.json")["shown"]["stops"], 2, delta=0.02)


class Panels(StudioTest):
    def test_a_ghost_is_selected_in_its_list_and_in_the_picture(self):
        first = self.state_after([])
        brightest = first["ghosts"][0]
        u, v = brightest["centre"][0] / 320, brightest["centre"][1] / 180
        lines = [["click", f"ghosts/{brightest['ghost']}"], ["wait"], ["state", "list.json"], ["key", "["], ["frames", 4], ["state", "last.json"],
                 ["key", "]"], ["key", "s"], ["wait"],
                 ["move", "viewport/picture", 0.5, 0.5], ["frames", 2], ["state", "solo.json"],
                 ["key", "a"], ["key", "m"], ["wait"], ["state", "muted.json"], ["key", "]"]]
        if 0.02 < u < 0.98 and 0.02 < v < 0.98:
            lines += [["click", "viewport/picture", u, v]]
        state = self.state_after(lines)
        chosen = self.state("list.json")
        self.assertEqual(chosen["selection"]["ghost"], brightest["ghost"])
        j, i = reversed([int(part) for part in brightest["ghost"].split("-")])
        self.assertIn(f"surface {j}, then at {i}", self.widget(chosen, "section/legend")["value"])
        self.assertEqual(self.state("solo.json")["values"]["select"], [f"list:{brightest['ghost']}"])
        self.assertEqual(self.state("solo.json")["shown"]["ghosts"], 1)
        count = len(first["ghosts"])
        self.assertTrue(self.widget(self.state("solo.json"), "ghosts/summary")["value"].startswith(f"1 of {count} ghosts shown (solo)"))
        last = self.widget(self.state("last.json"), "ghosts/" + self.state("last.json")["selection"]["ghost"])
        self.assertEqual(last["value"], "selected")
        self.assertLess(last["rect"][3], self.widget(first, "status")["rect"][1])
        probe = self.widget(self.state("solo.json"), "status/probe")["value"]
        self.assertTrue(probe.endswith(("no ghost here", f"ghost {brightest['ghost']}")), probe)
        self.assertTrue(self.state("muted.json")["values"]["ghost"][0].startswith(f"{brightest['ghost']}:gain=0,"))
        self.assertNotEqual(state["selection"]["ghost"], "")

    def test_a_surface_clicked_in_the_section_is_the_row_of_the_prescription(self):
        state = self.state_after([["click", "section/surface/3"], ["key", "g"], ["key", "f3"], ["frames", 3]])
        self.assertEqual(state["values"]["select"], ["surface:3"])
        self.assertEqual(state["selection"]["surface"], 3)
        self.assertEqual(self.widget(state, "prescription/3")["value"], "selected")

    def test_a_radius_is_typed_refused_and_undone(self):
        cell = "prescription/1/radius"
        lines = [["key", "f3"], ["frames", 3], ["click", cell], ["type", "31.5"], ["key", "enter"], ["wait"], ["state", "typed.json"],
                 ["click", cell], ["type", "wide"], ["key", "enter"], ["frames", 2], ["state", "refused.json"], ["key", "ctrl+z"]]
        state = self.state_after(lines)
        typed, refused = self.state("typed.json"), self.state("refused.json")
        self.assertAlmostEqual(typed["radii"][0], 31.5)
        self.assertTrue(typed["edited"])
        self.assertEqual(typed["history"]["steps"][-1], "radius of surface 1")
        self.assertEqual(self.widget(refused, cell)["value"], "wide")
        self.assertIn("wide", refused["problem"])
        self.assertAlmostEqual(refused["radii"][0], 31.5)
        self.assertFalse(state["edited"])
        self.assertNotEqual(self.widget(state, cell)["value"], "wide")
        self.assertEqual((state["problem"], state["message"]), ("", "undone: radius of surface 1"))

    def test_a_glass_is_taken_from_the_list_by_a_click(self):
        cell = "prescription/1/glass"
        state = self.state_after([["key", "f3"], ["frames", 3], ["click", cell], ["type", "N-SF1"], ["frames", 3], ["state", "list.json"],
                                  ["click", f"{cell}/completions/N-SF11"], ["frames", 3]])
        self.widget(self.state("list.json"), f"{cell}/completions/N-SF11")
        self.assertEqual(self.widget(state, cell)["value"], "N-SF11")
        self.assertEqual(state["history"]["steps"][-1], "glass of surface 1")
        self.assertFalse([w["id"] for w in state["widgets"] if "/completions/" in w["id"]])
        self.assertEqual(state["problem"], "")

    def test_a_coating_is_typed_for_the_selected_surface(self):
        lines = [["key", "f4"], ["frames", 3], ["click", "coatings/3"], ["click", "coatings/text"], ["type", "v-coat:480"], ["key", "enter"], ["wait"],
                 ["state", "typed.json"], ["click", "coatings/design"], ["frames", 3], ["click", "coatings/design/none"]]
        bare = self.state_after(lines)
        state = self.state("typed.json")
        for each in (bare, state):
            plot, axes = (self.widget(each, f"coatings/{name}")["rect"] for name in ("plot", "axes"))
            self.assertGreater(axes[2] - axes[0], 0.6 * (plot[2] - plot[0]))
            self.assertGreater(plot[1], self.widget(each, "coatings/text")["rect"][3])
        self.assertEqual(self.widget(state, "coatings/design")["value"], "v-coat")
        self.assertEqual(bare["values"]["coating-at"], ["3:none"])
        self.assertEqual(state["values"]["coating-at"], ["3:v-coat:480"])
        self.assertEqual(state["history"]["steps"][-1], "coat surface 3")

    def test_parameters_are_the_tables_and_come_back_to_their_defaults(self):
        lines = [["key", "f7"], ["frames", 3], ["click", "parameters/filter"], ["type", "starburst"], ["frames", 2],
                 ["click", "parameters/starburst", 0.02, 0.5], ["wait"], ["state", "set.json"], ["click", "parameters/starburst/reset"],
                 ["click", "toolbar/fnumber"], ["frames", 2], ["type", "11"], ["key", "enter"]]
        state = self.state_after(lines)
        ids = [w["id"] for w in self.state("set.json")["widgets"]]
        self.assertIn("parameters/group/Rendering", ids)
        self.assertNotIn("parameters/group/Output", ids)
        self.assertEqual(state["values"]["fnumber"], ["11"])
        self.assertEqual(state["history"]["steps"][-1], "set fnumber")
        self.assertEqual(self.state("set.json")["values"]["starburst"], ["on"])
        self.assertNotIn("starburst", state["values"])

    def test_help_lists_keys_and_tab_hides_panels(self):
        lines = [["key", "f1"], ["frames", 2], ["state", "help.json"], ["key", "escape"], ["click", "ghosts/filter"], ["frames", 2],
                 ["key", "escape"], ["key", "escape"], ["frames", 2], ["key", "ctrl+="], ["frames", 3], ["state", "larger.json"], ["key", "ctrl+0"],
                 ["frames", 3], ["key", "tab"]]
        state = self.state_after(lines)
        self.assertTrue(self.state("help.json")["help"])
        self.assertFalse(state["help"])
        self.assertFalse(state["panels"])
        larger = self.state("larger.json")
        height = [s["rect"][3] - s["rect"][1] for s in (self.widget(each, "toolbar/help") for each in (state, larger))]
        self.assertEqual((larger["scale"], state["scale"]), (1.25, 1))
        self.assertAlmostEqual(height[1] / height[0], 1.25, delta=0.05)

    def test_nothing_is_clipped_at_double_size_either(self):
        bars = ("toolbar", "tab", "viewport", "dialog", "prescription/insert", "prescription/scale", "coatings/label", "lights/add", "ghosts/all")
        for scale, window in (("1", "1280x720"), ("2", "1600x900")):
            lines = [["wait"]]
            for key in ("f2", "f3", "f4", "f5", "f6", "f7"):
                lines += [["key", key], ["frames", 3], ["state", f"{key}.json"]]
            self.run_studio(lines, "--scale", scale, window=window)
            for key in ("f2", "f3", "f4", "f5", "f6", "f7"):
                with self.subTest(scale=scale, panel=key):
                    fixed = [w["id"] for w in self.state(f"{key}.json")["widgets"] if w["clipped"] and w["id"].startswith(bars)]
                    self.assertEqual(fixed, [])
            cut = [w["id"] for w in self.state("f3.json")["widgets"] if w["cut"] and w["id"].startswith("prescription/")]
            self.assertEqual(cut, [])


class Redrawing(StudioTest):
    def test_a_frame_drawn_in_parts_is_the_frame_drawn_whole(self):
        changes = [[["drag", "viewport/light/1", 60, 30, 3], ["wait"]], [["wheel", "viewport/picture", 3]], [["move", "toolbar/export"], ["frames", 2]],
                   [["key", "f4"], ["frames", 3]], [["key", "f1"], ["frames", 3]], [["key", "escape"], ["frames", 2]], [["key", "tab"], ["frames", 3]],
                   [["random", 5, 30], ["key", "escape"], ["key", "escape"], ["wait"]]]
        lines = [["wait"], ["clear-pace"], ["frames", 20], ["state", "idle.json"]]
        for k, change in enumerate(changes):
            lines += [["clear-pace"], *change, ["frames", 3], ["state", f"{k}.json"], ["screenshot", f"{k}.png"], ["redraw"], ["screenshot", f"{k}-whole.png"]]
        self.run_studio(lines, window="640x480")
        self.assertEqual(self.state("idle.json")["pace"]["drawn_part"], 0)
        self.assertLess(self.state("2.json")["pace"]["drawn_part"], 0.2)
        for k in range(len(changes)):
            with self.subTest(change=changes[k]):
                self.assertGreater(self.state(f"{k}.json")["pace"]["drawn_part"], 0)
                self.assertEqual((self.folder / f"{k}.png").read_bytes(), (self.folder / f"{k}-whole.png").read_bytes())


class RandomInput(StudioTest):
    def test_random_input_neither_ends_the_program_nor_leaves_it_busy(self):
        state = self.state_after([["random", 3, 80], ["key", "escape"], ["key", "escape"]])
        self.assertTrue(state["idle"])


if __name__ == "__main__":
    run_tests()
