"""Where the executable begins."""

import multiprocessing

from polarcheck.__main__ import run

if __name__ == "__main__":
    # A worker of the process pool is this program once more; on Windows and macOS it would else check everything anew.
    multiprocessing.freeze_support()
    run()
