"""Numbers that findings state and no column holds, by the groups of rules; NaN where one is not known."""
