"""Study `localisation`: tracking, global localisation, the kidnapped robot, and robots that see each other."""
