# SPDX-License-Identifier: Apache-2.0
"""The library's errors. Their text says what is wrong, where, and what to do."""


class Error(Exception):
    """Every error of the library."""


class InvalidArgumentError(Error, ValueError):
    """A value out of its range."""


class ParseError(Error, ValueError):
    """A file that is not what its format says; the message names the line."""


class IoError(Error, OSError):
    """A file that cannot be opened, read or written."""


class UnsupportedError(Error, NotImplementedError):
    """Understood, but not modelled."""


class CancelledError(Error):
    """The computation was stopped."""
