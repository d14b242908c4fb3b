"""Scenes from dicts, texts and files, and what is wrong with them."""
from __future__ import annotations

import os
import pathlib
import subprocess
import unittest

import numpy as np
from support import ROPE, FolderTest

import ropewalk
from ropewalk.programs import find_program
from ropewalk.toml import toml_of


class SceneTest(FolderTest):
    def test_dict_text_and_file_are_the_same(self):
        one = ropewalk.Scene(ROPE)
        pathlib.Path("rope.toml").write_text(one.text)
        for other in (ropewalk.Scene.from_toml(one.text), ropewalk.Scene("rope.toml"),
                      ropewalk.Scene(pathlib.Path("rope.toml"))):
            self.assertEqual(other.keys, one.keys)
            self.assertEqual((other.tubes, other.elements, other.duration_ps), (7, 70, 2.0))
        self.assertEqual(one.name, "scene")
        self.assertEqual(ropewalk.Scene("rope.toml").name, "rope")

    def test_start_is_a_hexagonal_rope(self):
        scene = ropewalk.Scene(ROPE)
        start = scene.start
        self.assertEqual(start.position.shape, (7, 10, 3))
        middle = start.position[:, 5, :2]
        distances = np.linalg.norm(middle[1:] - middle[0], axis=1)
        np.testing.assert_allclose(distances, scene.spacing_nm)
        np.testing.assert_allclose(start.axis, np.broadcast_to([0, 0, 1.0], (7, 10, 3)), atol=1e-12)
        np.testing.assert_allclose(scene.radius_nm, 0.6888, atol=1e-3)

    def test_values_of_all_kinds_become_toml(self):
        text = toml_of({
            "a": True, "b": np.int64(3), "c": np.array([0.1, 2.0]), "d": 'say "x"\\\n', "t": {"k": [1, {"x": 1}]},
            "rows": [{"y": 1e-7}, {"y": -0.0}],
        })
        import tomllib
        self.assertEqual(tomllib.loads(text), {
            "a": True, "b": 3, "c": [0.1, 2.0], "d": 'say "x"\\\n', "t": {"k": [1, {"x": 1}]},
            "rows": [{"y": 1e-7}, {"y": -0.0}],
        })
        with self.assertRaises(TypeError):
            toml_of({"a": object()})

    def test_errors_are_those_of_the_program(self):
        bad = ropewalk.Scene(ROPE).text.replace("moment_nN_nm = 5", "moment_nN_nm = -5")
        pathlib.Path("bad.toml").write_text(bad)
        said = subprocess.run([find_program(), "check", "bad.toml"], capture_output=True, text=True)
        with self.assertRaises(ropewalk.InputError) as caught:
            ropewalk.Scene("bad.toml")
        self.assertEqual(said.stderr, f"ropewalk: {caught.exception}\n")
        self.assertEqual((caught.exception.file, caught.exception.key), ("bad.toml", "twist.moment_nN_nm"))
        self.assertGreater(caught.exception.line, 1)
        self.assertIsInstance(caught.exception, ValueError)

    def test_errors_of_a_dict_name_no_line(self):
        with self.assertRaises(ropewalk.InputError) as caught:
            ropewalk.Scene({**ROPE, "rope": {"tubs": 7, "length_nm": 14}})
        self.assertEqual(str(caught.exception), 'scene: rope.tubes: is missing; did you mean it by "tubs"?')

    def test_what_depends_on_the_elements_is_found_when_they_are_made(self):
        scene = ropewalk.Scene({**ROPE, "run": {"duration_ps": 2, "time_step_fs": 900}})
        with self.assertRaisesRegex(ropewalk.InputError, "stability limit"):
            scene.time_step_fs

    def test_keys_are_read_as_they_are_changed(self):
        scene = ropewalk.Scene({**{k: v for k, v in ROPE.items() if k != "twist"}, "grip": [{"end": "lower"}]})
        self.assertEqual((scene["rope.tubes"], scene["rope"], scene["grip.0.end"]), (7, ROPE["rope"], "lower"))
        self.assertIn("rope.length_nm", scene)
        for name in ("rope.tubs", "grip.1.end", "rope.tubes.x", "run.mode"):
            self.assertNotIn(name, scene)
            with self.assertRaises(KeyError):
                scene[name]

    def test_changed_sets_keys_anywhere(self):
        scene = ropewalk.Scene({**{k: v for k, v in ROPE.items() if k != "twist"}, "grip": [
            {"end": "lower"}, {"end": "upper", "about_z": {"rotation_deg": [[0, 0], [10, 20]]}}]})
        other = scene.changed({"rope.tubes": 19, "grip.1.about_z.rotation_deg": [[0, 0], [10, 30]],
                               "run.frames_every_ps": None, "contact.law": "none"})
        self.assertEqual((scene.tubes, other.tubes), (7, 19))
        self.assertEqual(other.keys["grip"][1]["about_z"]["rotation_deg"][1][1], 30)
        self.assertNotIn("frames_every_ps", other.keys["run"])
        self.assertEqual(other.keys["contact"], {"law": "none"})
        self.assertEqual(other.name, scene.name)

    def test_files_are_found_beside_it(self):
        os.mkdir("there")
        shipped = ropewalk.ParameterSet("cnt-5-5-tersoff").path
        pathlib.Path("there/mine.toml").write_text(pathlib.Path(shipped).read_text())
        scene = ropewalk.Scene({**ROPE, "parameters": "mine.toml"}, folder="there")
        self.assertEqual(scene.parameter_sets, [os.path.abspath("there/mine.toml")])
        self.assertEqual(scene.changed({"rope.tubes": 19}).parameter_sets, scene.parameter_sets)
        with self.assertRaisesRegex(ropewalk.InputError, "no parameter set"):
            ropewalk.Scene({**ROPE, "parameters": "mine.toml"})

    def test_unequal_tubes_have_flat_arrays(self):
        start = self.unequal_scene().start
        self.assertEqual(start.flat.position.shape, (22, 3))
        self.assertEqual([len(t) for t in start.tubes], [10, 12])
        self.assertEqual(start.tubes[1].position.shape, (12, 3))
        np.testing.assert_array_equal(np.bincount(start.tube), [10, 12])
        with self.assertRaisesRegex(ropewalk.Error, r"10 to 12 elements: take flat.position or tubes\[i\].position"):
            start.position

    def test_states_written_here_are_read(self):
        angles = np.linspace(0, 1, 5)
        position = np.stack([np.stack([3.0 * t + 0 * angles, 0 * angles, 1.357 * np.arange(5)], axis=1) for t in (0, 1)])
        orientation = np.zeros((2, 5, 4))
        orientation[..., 0], orientation[..., 3] = np.cos(angles / 20), np.sin(angles / 20)
        ropewalk.write_state("two.csv", position, orientation)
        scene = ropewalk.Scene({"parameters": "cnt-10-10-tersoff", "state": {"file": "two.csv"},
                                "run": {"duration_ps": 1}})
        np.testing.assert_array_equal(scene.start.position, position)
        np.testing.assert_allclose(scene.start.orientation, orientation, atol=1e-15)
        with self.assertRaisesRegex(ValueError, "are needed"):
            ropewalk.write_state("two.csv", position, orientation[..., :3])


if __name__ == "__main__":
    unittest.main()
