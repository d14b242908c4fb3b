"""Files that are written whole or not at all."""
from __future__ import annotations

import os
import stat
import tempfile

from .errors import InputError


def read_regular(path: str | os.PathLike[str]) -> bytes:
    """The content of a regular file (no unit). Raises InputError for a pipe, which nobody may ever write to, or a device.

    Arguments:
        path: the file
    """
    name = os.fspath(path)
    handle = os.open(name, os.O_RDONLY | os.O_NONBLOCK)
    with os.fdopen(handle, "rb") as file:
        if not stat.S_ISREG(os.fstat(handle).st_mode):
            raise InputError(f"{os.fsdecode(name)}: is not a regular file; name a file", os.fsdecode(name))
        return file.read()


def write_whole(path: str | os.PathLike[str], content: bytes) -> None:
    """Writes a file; where that fails, the file that was there before stays.

    Arguments:
        path: the file
        content: its bytes (no unit)
    """
    target = os.path.abspath(os.fspath(path))
    handle, part = tempfile.mkstemp(prefix=os.path.basename(target) + ".part-", dir=os.path.dirname(target))
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        umask = os.umask(0)
        os.umask(umask)
        try:
            os.chmod(part, 0o666 & ~umask)
        except OSError:  # a file system without permissions
            pass
        os.replace(part, target)
    except BaseException:
        os.unlink(part)
        raise
