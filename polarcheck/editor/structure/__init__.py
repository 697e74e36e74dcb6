"""The structure of programs for editors: names and their uses, colors, folding, calls. It needs no check."""
