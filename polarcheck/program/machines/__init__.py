"""The control, the lathe and the job on it: profiles as data with sources, tool offsets, stock."""
