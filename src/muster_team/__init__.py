"""Task allocation without a central auctioneer: one process per robot, a protocol over an unreliable transport."""
