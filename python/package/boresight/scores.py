"""Scores: dictionaries that are displayed as tables."""

from __future__ import annotations

import html
from collections.abc import Iterator, Mapping
from typing import Any

Row = tuple[str, str, str, str]

HEADINGS: Row = ("figure", "value", "95 % interval", "count")


class Score(dict[str, Any]):
    """Dictionary of score.json, described in docs/score.md, that is displayed as a table.

    Rates are 0 to 1; the units of other figures are in their names. `count` is the number of measurements of
    a figure, of all that could have it. Figures without a value are omitted from the table.
    """

    def __repr__(self) -> str:
        parts = [self._title()]
        for name, rows in self._tables():
            parts.append(name)
            parts.append(_text([HEADINGS, *rows]))
        parts += [f"{title}: {text}" for title, text in self._counts()]
        return "\n".join(part for part in parts if part)

    def _repr_html_(self) -> str:
        parts = [f"<p>{html.escape(self._title())}</p>"]
        for name, rows in self._tables():
            caption = f"<caption>{html.escape(name)}</caption>" if name else ""
            head = _html_row("th", HEADINGS)
            body = "".join(_html_row("td", row) for row in rows)
            parts.append(f"<table>{caption}<thead>{head}</thead><tbody>{body}</tbody></table>")
        parts += [f"<p>{html.escape(title)}: {html.escape(text)}</p>" for title, text in self._counts()]
        return "".join(parts)

    def _title(self) -> str:
        return f"Score of {self.get('scenario', 'a run')}: {self.get('frames', 0)} frames"

    def _tables(self) -> Iterator[tuple[str, list[Row]]]:
        """Named tables with at least one row: all frames, or each group if no figure of all frames has a value.
        """
        rows = _rows(self.get("figures"))
        if rows:
            yield "", rows
            return
        groups = self.get("groups")
        for name, group in groups.items() if isinstance(groups, Mapping) else ():
            rows = _rows(group.get("figures")) if isinstance(group, Mapping) else []
            if rows:
                yield f"group {name}: {group.get('frames', 0)} frames", rows

    def _counts(self) -> Iterator[tuple[str, str]]:
        """Numbers by cause, in descending order."""
        for key, title in (("misses", "misses by cause"), ("wrong", "wrong measurements by cause")):
            causes = self.get(key)
            if isinstance(causes, Mapping):
                found = [(cause, count) for cause, count in causes.items() if isinstance(count, int) and count]
                found.sort(key=lambda entry: -entry[1])
                yield title, ", ".join(f"{count} {cause}" for cause, count in found) or "none"


def _rows(figures: Any) -> list[Row]:
    """Rows of the figures that have a value."""
    if not isinstance(figures, Mapping):
        return []
    return [
        (str(name), _number(figure["value"]), _interval(figure), f"{figure.get('count')} of {figure.get('of')}")
        for name, figure in figures.items()
        if isinstance(figure, Mapping) and figure.get("value") is not None
    ]


def _number(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _interval(figure: Mapping[str, Any]) -> str:
    low, high = figure.get("low"), figure.get("high")
    return "" if low is None or high is None else f"{_number(low)} to {_number(high)}"


def _text(rows: list[Row]) -> str:
    """Table in text: the first column to the left, the others to the right."""
    widths = [max(len(cell) for cell in column) for column in zip(*rows)]
    return "\n".join(
        "  ".join(cell.rjust(width) if at else cell.ljust(width) for at, (cell, width) in enumerate(zip(row, widths)))
        for row in rows
    )


def _html_row(tag: str, row: Row) -> str:
    return "<tr>" + "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in row) + "</tr>"
