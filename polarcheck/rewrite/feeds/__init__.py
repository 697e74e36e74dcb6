"""The highest F of each block, and the edits that write it into the program."""
