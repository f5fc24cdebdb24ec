"""Options that several verbs share, those that follow from the fields of a request, and those of other packages."""
