"""Plans as files of other programs, and missions from such files; nothing is sent to a robot."""
