"""A program rewritten for another control, without the mode or into it; with cutter compensation or without it."""
