"""Words that messages of several rules and pages have in common: what is written, offsets, ramps, feeds, the part."""
