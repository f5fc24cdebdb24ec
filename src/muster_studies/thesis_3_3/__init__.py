"""[tcf-thesis], section 3.3: the evaluation of its task allocation algorithms, Tables 3.2 to 3.22."""
