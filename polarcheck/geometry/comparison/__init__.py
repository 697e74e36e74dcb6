"""The finished part compared with a drawing or a shape with its numbers."""
