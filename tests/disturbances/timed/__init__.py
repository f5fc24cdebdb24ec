"""Disturbed missions with time windows, lags, shifts, teams and relations."""
