"""The exceptions of the package."""


class Error(Exception):
    """A failure of exitance.

    message  one sentence that contains the offending values
    where    place of the error, such as "room.obj:41"; may be empty
    hint     suggested action; may be empty
    code     "usage", "bad_input", "cannot_read", "cannot_write", "limit" or "failure"
    """

    def __init__(self, message: str, where: str = "", hint: str = "", code: str = "failure") -> None:
        super().__init__((f"{where}: " if where else "") + message + (f" ({hint})" if hint else ""))
        self.message = message
        self.where = where
        self.hint = hint
        self.code = code

    def __reduce__(self) -> "tuple[type[Error], tuple[str, str, str, str]]":
        return type(self), (self.message, self.where, self.hint, self.code)


class UsageError(Error, ValueError):
    """An argument is wrong."""
