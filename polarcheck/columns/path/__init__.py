"""The path: axes, coordinates, frames, arcs, cutter compensation and the moves of the tool center."""
