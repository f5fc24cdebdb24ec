"""Small missions with time windows, lags, teams and relations: every plan of them, and all that must be true."""
