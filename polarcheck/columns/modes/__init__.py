"""States: codes in force, polar sections and what stands around them, tools, offsets, spindles."""
