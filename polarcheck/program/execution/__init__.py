"""Which block runs next, and with which values: programs, calls, macro statements, block skip."""
