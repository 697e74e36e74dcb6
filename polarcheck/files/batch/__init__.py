"""Many files: which, checked by this process or several workers, baselines, what a change in git concerns."""
