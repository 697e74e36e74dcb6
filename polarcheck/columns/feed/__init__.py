"""F, rates of the axes, accelerations and times."""
