"""Traffic: who goes where when. Paths of several robots that share a map."""
