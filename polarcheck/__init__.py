"""polarcheck: checks NC programs that use polar coordinate interpolation, before the lathe does."""

__version__ = "0.1.0"
