"""What tests do with the command and with folders of results."""

import subprocess
import sys


def program(*arguments, **options):
    """The command of the wheel, as a process of its own."""
    command = [sys.executable, "-m", "piola", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)


def data_of(folder):
    """The bytes of all files of a run that are the same in each: no record, no report, which have times of day."""
    files = {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    return {name: data for name, data in files.items() if name not in ("run.json", "report.html")}
