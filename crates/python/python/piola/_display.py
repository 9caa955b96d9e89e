"""What notebooks show."""

import os


class Picture:
    """A picture that a run has written.

    path: the PNG file.
    """

    def __init__(self, path):
        self.path = os.fspath(path)

    def _repr_png_(self):
        with open(self.path, "rb") as file:
            return file.read()

    def __repr__(self):
        return f"<Picture {self.path}>"
