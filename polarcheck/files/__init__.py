"""Many files: their settings, workers, cache, git and baselines."""
