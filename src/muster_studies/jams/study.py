JAMS = None
