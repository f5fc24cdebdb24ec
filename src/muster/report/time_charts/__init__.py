"""Charts over time: a row for each robot, of a plan or of a recorded mission, with the limits of a mission."""
