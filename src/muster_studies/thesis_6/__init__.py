"""[tcf-thesis], chapter 6: plans carried out, Tables 6.2, 6.3 and 6.6 to 6.11."""
