"""
The functions for Python: what a command finds, as values. docs/api.md promises them.

Each takes what a job file can say as keywords (`keywords.py`). Nothing is printed, no variable of the environment is
read, and no limit is set to the process. A fault of the caller or of a file is a PolarcheckError.
"""
