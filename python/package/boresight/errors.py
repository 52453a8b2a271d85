"""Exceptions of the package."""


class BoresightError(Exception):
    """Base class of all errors of boresight."""


class InputError(BoresightError, ValueError):
    """Invalid value, file or table; the message has the name and the expected value."""


class FileError(BoresightError, OSError):
    """A file or directory that cannot be read or written."""
