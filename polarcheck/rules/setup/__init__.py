"""The state of the lathe around the section."""
