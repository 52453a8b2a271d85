"""Values of Python and numpy as JSON and CSV, which carry every bit of a number."""

from __future__ import annotations

import csv
import dataclasses
import hashlib
import inspect
import io
import json
import math
import numbers
import secrets
from collections.abc import Mapping
from typing import Any

from boresight._boresight import Table
from boresight.answers import Detection, NoSolution, Pose, RangeOnly
from boresight.errors import InputError

WHOLE = {"frame", "field", "n_stars"}
"""Columns of integers: pandas stores those with gaps as floating-point numbers."""


def plain(value: Any) -> Any:
    """Converts a number or an array of numpy to a Python value."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} is neither a number, a text, a list nor a dictionary")


def to_json(what: str, value: Any) -> str:
    """A value as JSON; `what` names it in errors."""
    try:
        return json.dumps(value, default=plain, allow_nan=False)
    except (TypeError, ValueError) as error:
        raise InputError(f"`{what}` is {value!r}, expected a value of a scenario ({error})") from None


def answer_line(answer: Any, key: str, number: int) -> str:
    """A pipeline's answer to frame (or field) `number` as a line of the protocol of
    docs/external-pipeline.md."""
    given = answer
    if answer is None:
        answer = NoSolution()
    if isinstance(answer, (Detection, NoSolution, Pose, RangeOnly)):
        named = {field.name: getattr(answer, field.name) for field in dataclasses.fields(answer)}
        # Missing values add no key to the answer, so that a Detection for a docking field is refused by its
        # status.
        answer = {"status": answer.status} | {name: value for name, value in named.items() if value is not None}
    elif not isinstance(answer, Mapping):
        of = "Pose, RangeOnly, NoSolution" if key == "field" else "Detection, NoSolution"
        raise TypeError(f"it returned {given!r}, expected {of}, None or a dictionary")
    try:
        return json.dumps({key: number, **answer}, default=plain, allow_nan=False)
    except (TypeError, ValueError) as error:
        raise type(error)(f"it returned {given!r}, expected finite numbers and text ({error})") from None


def estimates_line(answers: Any) -> str:
    """A navigator's answers as a line of the protocol of docs/navigation.md."""
    try:
        entries = [{"no_estimate": answer} if isinstance(answer, str) else answer for answer in answers]
        return json.dumps({"estimates": entries}, default=plain, allow_nan=False)
    except (TypeError, ValueError) as error:
        raise type(error)(f"it returned {answers!r:.200}, expected a list of dictionaries or texts ({error})") from None


def callable_hash(given: Any) -> bytes:
    """SHA-256 of name and source of a Python pipeline; random if the source is unavailable."""
    known = given if inspect.isclass(given) or inspect.isroutine(given) else type(given)
    try:
        source = inspect.getsource(known)
    except (OSError, TypeError):
        source = secrets.token_hex()
    named = (getattr(known, "__module__", ""), getattr(known, "__qualname__", ""), source)
    return hashlib.sha256(json.dumps(named).encode()).digest()


def columns_of(table: Any) -> Mapping[str, Any]:
    """Columns of a table of boresight, pyarrow, polars or pandas, or of a dictionary."""
    columns: Mapping[str, Any]
    if isinstance(table, Mapping):
        columns = table
    elif isinstance(table, Table):
        columns = table.to_dict()
    elif hasattr(table, "to_pydict"):  # pyarrow
        columns = table.to_pydict()
    elif hasattr(table, "get_columns"):  # polars
        columns = table.to_dict(as_series=False)
    elif hasattr(table, "iloc") and hasattr(table, "columns"):  # pandas
        columns = table.to_dict("list")
    else:
        raise InputError(
            f"`measurements` is of type {type(table).__name__}, expected a file, a table of boresight, polars, pandas or pyarrow, "
            "or a dictionary of columns"
        )
    return columns


def cell(name: str, value: Any) -> str:
    """Cell of CSV; empty for a missing value."""
    if hasattr(value, "item"):
        value = value.item()
    if value is None or (isinstance(value, float) and math.isnan(value)) or str(value) == "<NA>":
        return ""
    if name in WHOLE and isinstance(value, float) and value.is_integer():
        return str(int(value))
    if isinstance(value, numbers.Real) and not isinstance(value, numbers.Integral):
        return repr(float(value))
    return str(value)


def csv_text(table: Any) -> str:
    """A table of measurements as CSV."""
    columns = {str(name): list(column) for name, column in columns_of(table).items()}
    lengths = {name: len(column) for name, column in columns.items()}
    if len(set(lengths.values())) > 1:
        raise InputError(f"`measurements` has columns of {lengths} rows, expected columns of one length")
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([cell(name, value) for name, value in zip(columns, row)] for row in zip(*columns.values()))
    return out.getvalue()
