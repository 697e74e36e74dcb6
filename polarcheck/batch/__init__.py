"""Many files: baselines, and which of them a change in git concerns."""
