"""Teams without a map: ways that they find, tasks that they do, and how fast they explore."""
