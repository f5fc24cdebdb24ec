"""Edits a mission's text as little as possible: comments, order and layout stay as they are.

Workers alone do it, as the text is a stranger's.

| part | what it does |
|---|---|
| `nodes` | where each value stands in a text of YAML |
| `edits` | setting, adding and removing values in a text |
| `changes` | what a map and a form change |
| `zones` | zones that are drawn |
"""
