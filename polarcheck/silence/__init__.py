"""Allow comments: what they name, in which blocks they suppress findings, and the findings they suppress."""
