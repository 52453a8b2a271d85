"""World coordinates and times as objects of astropy, which is imported only when they are requested."""

from __future__ import annotations

import importlib
import warnings
from typing import Any

from boresight.errors import InputError


def _module(name: str, what: str) -> Any:
    """Imports a module of astropy; `what` names the request in the error."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise ImportError(f"{what} requires astropy: pip install astropy ({error})") from None


def world_coordinates(header: str) -> Any:
    """World coordinates (`astropy.wcs.WCS`) of a FITS header given as text."""
    wcs = _module("astropy.wcs", "Scenario.wcs")
    fits = _module("astropy.io.fits", "Scenario.wcs")
    with warnings.catch_warnings():
        # A note that astropy has computed MJD-BEG from DATE-BEG.
        warnings.simplefilter("ignore", wcs.FITSFixedWarning)
        return wcs.WCS(fits.Header.fromstring(header))


def time_of_text(text: Any, what: str) -> Any:
    """Time (`astropy.time.Time`, UTC) of a text such as `2012-04-23T07:00:00.000000000Z`, or times of a list
    of texts."""
    time = _module("astropy.time", what).Time
    texts = text.rstrip("Z") if isinstance(text, str) else [one.rstrip("Z") for one in text]
    return time(texts, format="isot", scale="utc")


def time_of_table(table: Any, column: str) -> Any:
    """Times (`astropy.time.Time`, UTC) of a column of a table."""
    values = table[column]
    if getattr(getattr(values, "dtype", None), "kind", "") == "M":
        # Text keeps nanoseconds and the whole range of the column.
        return time_of_text([str(value) for value in values], "Table.time")
    if not isinstance(values, list) or not all(isinstance(value, str) for value in values):
        raise InputError(f"`column` is {column}, expected a column of times such as time_utc")
    try:
        return time_of_text(values, "Table.time")
    except ValueError as error:
        raise InputError(f"`column` is {column}, expected a column of times such as time_utc ({error})") from None
