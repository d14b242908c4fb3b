"""Writes dicts as TOML."""
from __future__ import annotations

import os
import re
from collections.abc import Mapping
from typing import Any

_BARE = re.compile(r"[A-Za-z0-9_-]+(\.[A-Za-z0-9_-]+)*\Z")  # "rope.tubes" stays what it is: a key in a table


def _text(value: str) -> str:
    escaped = value.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + re.sub(r"[\x00-\x1f\x7f]", lambda m: f"\\u{ord(m.group()):04x}", escaped) + '"'


def _key(key: str) -> str:
    return key if _BARE.match(key) else _text(key)


def _value(value: Any) -> str:
    if hasattr(value, "tolist"):  # numpy
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value)
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, os.PathLike):
        return _text(os.fspath(value))
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(str(k))} = {_value(v)}" for k, v in value.items()) + " }"
    if isinstance(value, (list, tuple, range)):
        return "[" + ", ".join(_value(v) for v in value) + "]"
    raise TypeError(f"{value!r} is no value of TOML")


def _is_tables(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and bool(value) and all(isinstance(v, Mapping) for v in value)


def toml_of(keys: Mapping[str, Any]) -> str:
    """The text of a dict: numbers and texts first, then a [table] for every dict, a [[table]] for every list of dicts.

    Arguments:
        keys: numbers, texts, lists, dicts and arrays of numpy (no unit; those of scenes stand in the keys)
    """
    lines = [f"{_key(k)} = {_value(v)}" for k, v in keys.items() if not isinstance(v, Mapping) and not _is_tables(v)]
    for key, value in keys.items():
        tables = [value] if isinstance(value, Mapping) else value if _is_tables(value) else []
        header = f"[{_key(key)}]" if isinstance(value, Mapping) else f"[[{_key(key)}]]"
        for table in tables:
            lines += ["", header]
            lines += [f"{_key(str(k))} = {_value(v)}" for k, v in table.items()]
    return "\n".join(lines) + "\n"
