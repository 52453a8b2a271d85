"""Progress of long calls: a bar in a notebook or on a terminal, and nothing elsewhere."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable
from typing import Any, Protocol

from boresight.errors import InputError

WIDTH = 40
"""Length of the bar on a terminal, characters."""


class Bar(Protocol):
    """Display of progress."""

    def show(self, done: int) -> None: ...
    def close(self) -> None: ...


class TqdmBar:
    """Bar of tqdm: a widget in a notebook that has ipywidgets, text elsewhere."""

    def __init__(self, tqdm: Any, total: int, unit: str, name: str) -> None:
        self.bar = tqdm(total=total, unit=f" {unit}", desc=name, leave=False)

    def show(self, done: int) -> None:
        self.bar.update(done - self.bar.n)

    def close(self) -> None:
        self.bar.close()


class WidgetBar:
    """Bar of ipywidgets."""

    def __init__(self, widgets: Any, total: int, unit: str, name: str) -> None:
        from IPython.display import display  # type: ignore[import-not-found, unused-ignore]

        self.total, self.unit = total, unit
        self.bar = widgets.IntProgress(max=total, description=name)
        self.label = widgets.Label()
        self.box = widgets.HBox([self.bar, self.label])
        display(self.box)  # type: ignore[no-untyped-call, unused-ignore]

    def show(self, done: int) -> None:
        self.bar.value = done
        self.label.value = f"{done} of {self.total} {self.unit}"

    def close(self) -> None:
        self.box.close()


class TextBar:
    """Line on standard error, erased at the end."""

    def __init__(self, total: int, unit: str, name: str) -> None:
        self.total, self.unit, self.name = total, unit, name
        self.length = 0

    def show(self, done: int) -> None:
        filled = WIDTH * done // max(self.total, 1)
        line = f"{self.name} [{'#' * filled}{' ' * (WIDTH - filled)}] {done}/{self.total} {self.unit}"
        self.length = max(self.length, len(line))
        print(f"\r{line}", end="", file=sys.stderr, flush=True)

    def close(self) -> None:
        print(f"\r{' ' * self.length}\r", end="", file=sys.stderr, flush=True)


class CallableBar:
    """Function of the caller, of (done, total)."""

    def __init__(self, function: Callable[[int, int], object], total: int) -> None:
        self.function, self.total = function, total

    def show(self, done: int) -> None:
        self.function(done, self.total)

    def close(self) -> None:
        pass


def in_notebook() -> bool:
    """Returns true in the kernel of a notebook."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return shell is not None and hasattr(shell, "kernel")


def tqdm_bar(total: int, unit: str, name: str) -> Bar | None:
    try:
        with warnings.catch_warnings():
            # In a notebook without ipywidgets, tqdm warns and shows text.
            warnings.simplefilter("ignore")
            from tqdm.auto import tqdm  # type: ignore[import-untyped, import-not-found, unused-ignore]

            return TqdmBar(tqdm, total, unit, name)
    except ImportError:
        return None


def notebook_bar(total: int, unit: str, name: str) -> Bar | None:
    """Bar by tqdm or ipywidgets; None if neither is installed."""
    bar = tqdm_bar(total, unit, name)
    if bar is not None:
        return bar
    try:
        import ipywidgets  # type: ignore[import-untyped, import-not-found, unused-ignore]
    except ImportError:
        return None
    return WidgetBar(ipywidgets, total, unit, name)


def progress_bar(progress: Any, total: int, unit: str, name: str) -> Bar | None:
    """Display for a call's argument `progress`; None if nothing is displayed.

    `progress` is None (a notebook with tqdm or ipywidgets, or a terminal), True (standard error even where it
    is no terminal), False, or a function of (done, total).
    """
    if progress is False:
        return None
    if callable(progress):
        return CallableBar(progress, total)
    if progress is not None and progress is not True:
        raise InputError(f"`progress` is {progress!r}, expected None, True, False or a function of (done, total)")
    if in_notebook():
        return notebook_bar(total, unit, name) or (TextBar(total, unit, name) if progress else None)
    if progress or (sys.stderr is not None and sys.stderr.isatty()):
        return tqdm_bar(total, unit, name) or TextBar(total, unit, name)
    return None
