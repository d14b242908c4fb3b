"""Files that are written whole or not at all."""
from __future__ import annotations

import os
import tempfile


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
        os.chmod(part, 0o666 & ~umask)
        os.replace(part, target)
    except BaseException:
        os.unlink(part)
        raise
