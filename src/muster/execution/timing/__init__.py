"""When tasks begin: prerequisites, time windows, teams that must meet, the forecast of all this, and lateness."""
