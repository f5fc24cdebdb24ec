"""[auction-thesis], chapter 5: its three scenarios, Tables 5.2 to 5.23."""
