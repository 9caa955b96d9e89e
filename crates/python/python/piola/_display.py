"""What notebooks show."""

import os


class Picture:
    """A picture that a run has written.

    path: the PNG file.
    """

    path: str

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = os.fspath(path)

    def _repr_png_(self) -> bytes:
        with open(self.path, "rb") as file:
            return file.read()

    def __repr__(self) -> str:
        return f"<Picture {self.path}>"
