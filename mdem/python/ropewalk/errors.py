"""The exceptions of this package."""
from __future__ import annotations


class Error(Exception):
    """What all exceptions of this package are."""


class InputError(Error, ValueError):
    """Wrong input. The text is the line that `ropewalk` prints: file, line, key, what is wrong, what to do.

    Attributes:
        file: the file, or "" (no unit)
        line: the line in it from 1, or 0 where it is not known (no unit)
        key: the key, option or column, or "" (no unit)
    """

    def __init__(self, text: str, file: str = "", line: int = 0, key: str = "") -> None:
        super().__init__(text)
        self.file = file
        self.line = line
        self.key = key


class NumericalError(Error, ArithmeticError):
    """The calculation went wrong: a number is not finite, a bond slips, a relaxation tears the tubes.

    Attributes:
        step: the time step, or -1 where it is not known (no unit)
        element: the element, or -1 (no unit)
    """

    def __init__(self, text: str, step: int = -1, element: int = -1) -> None:
        super().__init__(text)
        self.step = step
        self.element = element


class BusyError(Error, RuntimeError):
    """Another thread moves the simulation, or a hook of its own asks for what moves it."""


class ProgramError(Error, RuntimeError):
    """A program of Ropewalk is missing, or ended for a reason that is neither of the other two.

    Attributes:
        exit_code: its exit code, or -1 where it was not started (no unit)
    """

    def __init__(self, text: str, exit_code: int = -1) -> None:
        super().__init__(text)
        self.exit_code = exit_code
