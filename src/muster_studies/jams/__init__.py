"""Where robots that avoid each other by what they see jam: scenes for teams in narrow places, for every method."""
