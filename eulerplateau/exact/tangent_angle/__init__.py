"""exact/tangent_angle."""
