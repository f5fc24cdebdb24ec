"""[tcf-thesis], section 6.1: tags that drones find, Tables 6.2 to 6.5."""
