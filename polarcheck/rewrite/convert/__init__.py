"""A program for another control: its polar sections, what stands around them, and both as one outcome."""
