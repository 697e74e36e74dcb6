"""The polar plane, rates of C, cutter compensation and contours: arrays in, arrays out, nothing of programs."""
