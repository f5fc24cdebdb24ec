"""The outputs of runs that need bodies: films, stills, pictures of cameras."""
