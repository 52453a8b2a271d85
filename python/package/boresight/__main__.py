"""Entry point of the command `boresight` of the package: `python -m boresight ARGUMENTS`, or the installed
script `boresight`.
"""

from __future__ import annotations

import os
import shutil
import signal
import sys

from boresight._boresight import command


def main() -> int:
    """Runs the command of this process's arguments and gives its exit status."""
    # Python would hold Ctrl-C back until the command has ended.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    # Interpreter that `study run --engine dask` starts here, and the command that it starts on workers.
    os.environ.setdefault("BORESIGHT_PYTHON", sys.executable)
    script = shutil.which("boresight", path=os.path.dirname(sys.executable))
    if script:
        os.environ.setdefault("BORESIGHT_PROGRAM", script)
    return command(sys.argv[1:])


if __name__ == "__main__":
    sys.exit(main())
