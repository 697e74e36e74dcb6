"""Areas of the plane, with shapely: faces between walls, finished parts, what a cutter clears. Import late."""
