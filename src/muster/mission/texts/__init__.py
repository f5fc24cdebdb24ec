"""Texts: files of text, files that ship beside modules, the word nearest to a misspelt one, and counts in words."""
