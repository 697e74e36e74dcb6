"""The settings of a program: options over the nearest job file over the machine, and where each value comes from."""
