"""Sites in the files that people have of them: tables, maps, tracks; read as missions."""
