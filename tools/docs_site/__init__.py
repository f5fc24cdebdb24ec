"""Builds the documentation site from README.md, CONTRIBUTING.md, CHANGELOG.md and docs/, as they are: `make docs`.

The pages stay Markdown that a forge shows. What a site needs beyond that is made while it is built:

| module | what it makes |
|---|---|
| `conf` | the settings of Sphinx |
| `navigation` | the tables of contents, from the sections of docs/index.md |
| `reference` | the Python reference, from the names on docs/python-reference.md and the docstrings of their objects |
| `tutorials` | notebooks to download, from the pages in docs/tutorials |
| `remarks` | pages without the markers of the check of documents |
| `finish` | a front page, small pictures, the list of links that leave the site |
"""
