"""Who does what, agreed without a centre: one process a robot, a protocol over a transport."""
