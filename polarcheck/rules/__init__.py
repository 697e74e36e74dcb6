"""The rules: one file each, in folders by subject; and, beside the folders, what rules are written in."""
