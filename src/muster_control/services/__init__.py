"""What mission control can do, one service per file. The API and the pages call the same services."""
