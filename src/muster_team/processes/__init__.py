"""The processes of robots: a node with its memory file in each, started and observed for a team on one machine."""
