"""What all pictures share: axes and legends, styles of robots, fonts, placement of labels, and files of pictures."""
