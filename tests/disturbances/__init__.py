"""Random missions carried out under random disturbances."""
