"""Known findings: the baseline file, and the findings of later runs that it suppresses."""
