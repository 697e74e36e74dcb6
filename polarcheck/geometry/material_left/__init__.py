"""What compensated contours leave standing: ribs on an outline, strips between passes. Import late."""
