"""The executed program as columns: a table of one element per executed block for each subject."""
