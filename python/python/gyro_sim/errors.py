"""What goes wrong, as exceptions that say where it is and what to do."""

from __future__ import annotations

from typing import NamedTuple, Sequence

__all__ = ["GyroError", "Mistake", "ModelError", "RequestError", "RunError", "RunWarning"]


class GyroError(Exception):
    """The exceptions of this package."""


class Mistake(NamedTuple):
    """A mistake in a model file."""

    line: int
    """Its line, from 1."""
    column: int
    """Its column in characters, from 1."""
    message: str
    """What is wrong."""
    cure: str
    """What to write instead."""


class ModelError(GyroError, ValueError):
    """A model file has mistakes; all are listed."""

    def __init__(self, text: str, file: str = "", mistakes: Sequence[tuple[int, int, str, str]] = ()) -> None:
        super().__init__(text, file, mistakes)
        self.file = file
        """The file's name."""
        self.mistakes = [Mistake(*mistake) for mistake in mistakes]
        """All mistakes, in the order of the file."""

    def __str__(self) -> str:
        return str(self.args[0])

    @property
    def line(self) -> int | None:
        """Line of the first mistake."""
        return self.mistakes[0].line if self.mistakes else None

    @property
    def cure(self) -> str | None:
        """What to write in place of the first mistake."""
        return self.mistakes[0].cure if self.mistakes else None


class RequestError(GyroError, ValueError):
    """What was asked for cannot be done; nothing was computed."""

    def __init__(self, words: str) -> None:
        super().__init__(_in_python(words))


class RunError(GyroError, RuntimeError):
    """A run or another computation failed."""

    def __init__(self, words: str) -> None:
        super().__init__(_in_python(words))


class RunWarning(UserWarning):
    """A result, or a model, is not what one would expect of it."""


def _in_python(words: str) -> str:
    """Options of the command line as the arguments that they are here."""
    import re

    words = words.replace("--verify tells", "run.verdict tells")
    return re.sub(r"--([a-z][a-z-]*)", lambda option: option[1].replace("-", "_"), words)
