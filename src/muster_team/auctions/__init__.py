"""The auction of one epoch, as each robot computes it: bids, sales round by round, bundles, and its limits."""
