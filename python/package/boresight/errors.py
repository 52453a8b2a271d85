"""What goes wrong, as exceptions."""


class BoresightError(Exception):
    """Whatever keeps boresight from giving an answer."""


class InputError(BoresightError, ValueError):
    """A value, a file or a table that is not as it should be: the message names it, and what is expected."""


class FileError(BoresightError, OSError):
    """A file or directory that cannot be read or written."""
