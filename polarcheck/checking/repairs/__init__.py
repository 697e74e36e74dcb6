"""What to write instead: a file for each rule whose findings can be mended, with a function of its name."""
