"""Cutter compensation: the programmed path in, the path of the tool center out."""
