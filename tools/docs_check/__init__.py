"""Runs what the documents show: shell, console and Python blocks, missions, pictures and figures.

`python -m tools.docs_check` checks README.md, CONTRIBUTING.md and docs/*.md; with names of pages it checks those alone.
`--long` makes what takes more than a minute and stores it in docs/measured. Markers are comments before a block:

    <!-- docs-check: skip: REASON -->             the block is not run; the reason is counted and printed
    <!-- docs-check: skip /REGEX/: REASON -->     the same for the lines of a shell block that match
    <!-- docs-check: long NAME -->                stored as docs/measured/NAME.json by --long; also long NAME /REGEX/
    <!-- docs-check: mask times -->               durations of a console block are not compared
    <!-- docs-check: output -->                   the block is what the Python block before it prints
    <!-- docs-check: as FILE -->                  a YAML block is kept as this file for the blocks after it
    <!-- docs-check: with YAML -->                what a fragment of a mission needs to be one
    <!-- docs-check: made by COMMAND -->          a picture; with `long` before it, by --long alone
    <!-- docs-check: setup                        commands that readers need not see
    COMMAND -->
    <!-- docs-check: background COMMAND -->       a server, from here to the end of the page
    <!-- docs-check: numbers by COMMAND -->       up to `end`, every number with a decimal point is one that it prints
    <!-- docs-check: numbers from NAME -->        the same of docs/measured/NAME.json
    <!-- docs-check: rows -->                     up to `end`, rows of tables; their commands run (rows.py)
    <!-- docs-check: end -->

Of a page with rows `--turn N` runs a tenth of the rows, with `--since COMMIT` those besides that a change touches, and
`--every` all. Without them the rows that take minutes are left out.
"""
