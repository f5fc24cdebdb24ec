"""Tests of the pages of missions and plans; a package, so that what they share ends with the last of them."""
