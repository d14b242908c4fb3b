"""Scenes: everything that one run needs."""
from __future__ import annotations

import copy
import os
import re
import tomllib
from collections.abc import Mapping
from typing import Any, Optional, Union

from . import _core
from .errors import InputError
from .state import Elements, Floats, State
from .toml import toml_of

_FORMAT = "ropewalk-scene-1"


def _absolute(keys: Mapping[str, Any], folder: str) -> dict[str, Any]:
    """The same with the files that it names by their whole paths."""

    def whole(name: Any) -> Any:
        path = os.path.abspath(os.path.join(folder, name)) if isinstance(name, (str, os.PathLike)) else ""
        return path if os.path.isfile(path) else name

    out = copy.deepcopy(dict(keys))
    if "parameters" in out:
        names = out["parameters"]
        out["parameters"] = [whole(n) for n in names] if isinstance(names, (list, tuple)) else whole(names)
    if isinstance(out.get("state"), Mapping) and "file" in out["state"]:
        out["state"]["file"] = whole(out["state"]["file"])
    return out


class Scene:
    """A scene: tubes, their parameter sets, loads, and how they are run. `ropewalk help scene` lists all keys.

    A scene does not change; `changed` makes another one. What is wrong raises InputError: keys at once, and what depends
    on the elements together (overlaps, loads on elements that are not there) when they are first asked for.

    Example:
        Scene({"parameters": "cnt-10-10-tersoff", "rope": {"tubes": 7, "length_nm": 14}, "run": {"duration_ps": 2}})
    """

    _of_a_run = False

    def __init__(self, source: Mapping[str, Any] | str | os.PathLike[str], *, folder: str | os.PathLike[str] = "") -> None:
        """Reads a scene.

        Arguments:
            source: a dict of the keys of a scene, each with its unit in its name (`format` may be left out), or a file
            folder: where files are that a dict names, if not in the current directory
        """
        self._path: Optional[str] = None
        self._folder = os.path.abspath(folder)
        if isinstance(source, Mapping):
            self._core = self._of_keys(source)
        else:
            self._path = os.path.abspath(source)
            self._folder = os.path.dirname(self._path)
            self._core = _core.Scene.read(os.fspath(source))

    def _of_keys(self, keys: Mapping[str, Any]) -> _core.Scene:
        text = toml_of({"format": _FORMAT, **_absolute(keys, self._folder)})
        try:
            return _core.Scene.of_text(text, "scene")
        except InputError as e:  # nobody has seen the lines of the text
            line = str(e).replace(f"scene:{e.line}: ", "scene: ", 1)
            raise InputError(re.sub(r'(?<=") in line \d+', "", line), e.file, 0, e.key) from None

    @classmethod
    def from_toml(cls, text: str, *, folder: str | os.PathLike[str] = "") -> Scene:
        """Reads the text of a scene.

        Arguments:
            text: as the file of a scene; errors name its lines as those of "scene"
            folder: where files are that it names, if not in the current directory
        """
        scene = cls.__new__(cls)
        scene._path = None
        scene._folder = os.path.abspath(folder)
        scene._core = _core.Scene.of_text(text, os.path.join(folder, "scene") if folder else "scene")
        return scene

    @classmethod
    def _of_run(cls, directory: str) -> Scene:
        scene = cls.__new__(cls)
        scene._path = None
        scene._folder = os.path.abspath(directory)
        scene._core = _core.Scene.of_run(directory)
        scene._of_a_run = True
        return scene

    def _whole_keys(self) -> dict[str, Any]:
        """The keys with its name, and with the files that it names by their whole paths."""
        keys: dict[str, Any] = {"name": self.name, **_absolute(self.keys, self._folder)}
        if self._of_a_run:  # which keeps copies of them
            sets = [os.path.abspath(path) for path in self.parameter_sets]
            keys["parameters"] = sets if len(sets) > 1 else sets[0]
            if "state" in keys:
                keys["state"]["file"] = os.path.join(self._folder, "state.csv")
        return keys

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled by its text; units stand in the names of its keys."""
        return _scene_again, (self.text, self._path, self._folder, self._of_a_run)

    def __eq__(self, other: object) -> bool:
        """Whether `other` has the same name, keys and files; units stand in the names of the keys."""
        return isinstance(other, Scene) and self._whole_keys() == other._whole_keys()

    def __hash__(self) -> int:
        """Equal for equal scenes (no unit)."""
        return hash(self.name)

    def __getitem__(self, name: str) -> Any:
        """The value that it gives to a key, in the unit of its name; KeyError where the key is left out and has its default.

        Arguments:
            name: with the table before it, "rope.tubes"; `grip.1.end` is of the second [[grip]]
        """
        at: Any = self.keys
        for key in name.split("."):
            try:
                at = at[int(key)] if isinstance(at, list) else at[key]
            except (LookupError, TypeError, ValueError):
                raise KeyError(f"{name} does not stand in this scene") from None
        return at

    __iter__: None = None  # it is no sequence

    def __contains__(self, name: object) -> bool:
        """Whether it gives a value to the key `name` (no unit)."""
        try:
            self[str(name)]
        except KeyError:
            return False
        return True

    def _to_run(self) -> _core.Scene:
        """The scene as a run keeps it: one without a file has its name in it, and files by their whole paths."""
        return self._core if self._path is not None else self._of_keys(self._whole_keys())

    def __repr__(self) -> str:
        """Its name (no unit)."""
        return f"<Scene {self.name}>"

    @property
    def name(self) -> str:
        """Its name: the key `name`, or that of the file (no unit)."""
        return self._core.name

    @property
    def text(self) -> str:
        """The scene as TOML; units stand in the names of its keys."""
        return self._core.text

    @property
    def keys(self) -> dict[str, Any]:
        """The keys that it gives, as a dict of its own; units stand in their names. Those left out have their defaults."""
        return tomllib.loads(self.text)

    def changed(self, changes: Mapping[str, Any]) -> Scene:
        """Another scene, with other values of some keys.

        Arguments:
            changes: values by key, with the table before it: {"rope.tubes": 19, "twist.moment_nN_nm": 30}; None takes a
                key away. `grip.1.end` is of the second [[grip]]. Units stand in the names of the keys.
        """
        keys = self._whole_keys()
        for name, value in changes.items():
            *tables, last = name.split(".")
            at: Any = keys
            for table in tables:
                at = at[int(table)] if isinstance(at, list) else at.setdefault(table, {})
            if value is None:
                at.pop(last, None)
            else:
                at[last] = value
        return Scene(keys, folder=self._folder)

    @property
    def parameter_sets(self) -> list[str]:
        """Files of the parameter sets, one for each type of tube (no unit)."""
        return list(self._core.sets)

    @property
    def grades(self) -> list[str]:
        """How far each parameter set holds: "NAME: good", limited or unfit, with the reasons (no unit)."""
        return list(self._core.grades)

    @property
    def tubes(self) -> int:
        """Number of tubes (no unit)."""
        return len(self._core.tube_begin) - 1

    @property
    def elements(self) -> int:
        """Number of elements of all tubes (no unit)."""
        return int(self._core.tube_begin[-1])

    @property
    def element_length_nm(self) -> float:
        """Length of an element, nm."""
        return self._core.element_length

    @property
    def radius_nm(self) -> Floats:
        """Radius of each tube, (tubes,), nm."""
        return self._core.radius

    @property
    def spacing_nm(self) -> float:
        """Distance of neighbouring tubes at the start, nm; 0 where there is none."""
        return self._core.spacing

    @property
    def time_step_fs(self) -> float:
        """Time step, fs."""
        return 1000 * self._core.time_step

    @property
    def duration_ps(self) -> float:
        """Time that a run of it lasts, ps."""
        return self._core.duration

    @property
    def start(self) -> State:
        """The state at time zero: positions in nm, velocities in nm/ps, angular velocities in rad/ps."""
        return State(Elements(*self._core.start()), self._core.tube_begin, self.element_length_nm)

    def notes(self) -> list[str]:
        """What `ropewalk run` says of the scene before it starts, a sentence each, with units."""
        return list(self._core.notes())


def _scene_again(text: str, path: Optional[str], folder: str, of_a_run: bool) -> Scene:
    if of_a_run:
        return Scene._of_run(folder)
    scene = Scene.from_toml(text, folder=folder)
    if path is not None:
        scene._path, scene._core = path, _core.Scene.of_text(text, path)
    return scene


SceneLike = Union[Scene, Mapping[str, Any], str, "os.PathLike[str]"]


def as_scene(source: SceneLike) -> Scene:
    """The scene itself, or what Scene() makes of a dict or a file.

    Arguments:
        source: a scene, a dict of its keys (units stand in their names), or a file
    """
    return source if isinstance(source, Scene) else Scene(source)
