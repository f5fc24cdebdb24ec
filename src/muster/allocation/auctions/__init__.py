"""Auctions and markets in one process: bids, winners, books of sales."""
