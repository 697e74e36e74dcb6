"""Many files: which they are, and their check by this process, by several workers, or by a cluster."""
