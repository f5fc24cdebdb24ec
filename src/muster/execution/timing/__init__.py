"""When tasks begin: what they wait for, the robots that must be there, the forecast of all this, and lateness."""
