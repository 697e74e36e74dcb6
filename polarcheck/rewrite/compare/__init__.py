"""Two revisions of a program compared by what they do at the lathe, not by their text."""
