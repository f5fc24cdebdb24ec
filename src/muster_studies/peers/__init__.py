"""`search` against solvers from elsewhere: OR-Tools, PyVRP, VROOM. Needs the extra `studies`."""
