"""Threads of simulations in this process."""
from __future__ import annotations

from typing import Optional

from . import _core
from .numbers import whole

_forked = False


def _have_one_thread() -> None:
    """Threads of OpenMP do not outlive a fork, and who waits for them waits for ever."""
    global _forked
    _forked = True
    _core.set_threads(1)


def threads_at_most(n: Optional[int]) -> Optional[int]:
    """The number itself, or 1 in a forked process, which gives the same bits.

    Arguments:
        n: threads that are asked for; None: as many as there are (no unit)
    """
    return 1 if _forked and n is not None and n > 1 else n


def threads() -> int:
    """Threads that simulations in this process use (no unit)."""
    return _core.threads()


def set_threads(n: int) -> None:
    """Sets the threads that simulations in this process use; any number gives the same bits.

    A process that was forked from one that has simulated has one thread, and cannot have more.

    Arguments:
        n: threads, 1 to 1024 (no unit)
    """
    _core.set_threads(whole(n, "the number of threads", 1, _core.most_threads))
