"""Threads of simulations in this process."""
from __future__ import annotations

from . import _core


def threads() -> int:
    """Threads that simulations in this process use (no unit)."""
    return _core.threads()


def set_threads(n: int) -> None:
    """Sets the threads that simulations in this process use; any number gives the same bits.

    A process that was forked from one that has simulated has one thread, and cannot have more.

    Arguments:
        n: threads, from 1 (no unit)
    """
    if n < 1:
        raise ValueError("the number of threads is 1 or more")
    _core.set_threads(n)
