"""The ledgers of all sites, plans and instances of the repository are complete, as other programs count."""

import pytest

from tests.import_ledger import FOLDERS, main


@pytest.mark.parametrize("folders", [("tests/data",), pytest.param(FOLDERS, marks=pytest.mark.long)])
def test_every_element_of_every_file_is_accounted_for(folders, capsys):
    assert main(folders) == 0
    assert capsys.readouterr().out.splitlines()[-1].endswith(" files, 0 differ")
