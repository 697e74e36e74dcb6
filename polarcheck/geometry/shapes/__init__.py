"""What an outline is, as a drawing would say it: a circle, a hexagon, a slot, with its sizes."""
