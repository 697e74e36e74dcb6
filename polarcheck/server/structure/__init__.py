"""The structure of programs for editors: names and their uses, colours, folding, calls. It needs no check."""
