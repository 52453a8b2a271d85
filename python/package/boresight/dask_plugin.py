"""Plugin that writes the files of a study on every worker of a Dask cluster. Imported only where Dask is
installed.
"""

from __future__ import annotations

import os

from distributed import Worker, WorkerPlugin

from boresight.dask_engine import unpack


class StudyFiles(WorkerPlugin):
    """Writes the files of a study into the folder of every worker, of those that come later too."""

    def __init__(self, files: dict[str, bytes], folder: str) -> None:
        self.name = folder
        self.files, self.folder = files, folder

    def setup(self, worker: Worker) -> None:
        unpack(self.files, os.path.join(worker.local_directory, self.folder))
