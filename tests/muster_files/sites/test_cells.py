"""What stands in cells, as people and spreadsheets write it: numbers, amounts, durations, moments, places, lists."""

import datetime

import pytest

from muster_files.sites.cells import CellError, amount, duration, lat_lon, moment, number, pairs, words


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("12,5", 12.5),
        ("1.234,5", 1234.5),
        ("1,234.5", 1234.5),
        ("1 234,5", 1234.5),
        ("\u22123e2", -300),
        ("1'234", 1234),
    ],
)
def test_numbers_as_people_write_them(text, value):
    assert number(text) == value


@pytest.mark.parametrize("text", ["", "nan", "inf", "1,2,3", "12 bananas", "1.2.3", "0x10"])
def test_what_is_no_number(text):
    with pytest.raises(CellError, match="a number"):
        number(text)


@pytest.mark.parametrize(
    ("told", "read"),
    [
        ("12,5", 12.5),
        ("500 g", 0.5),
        ("-2", -2),
        ("2 parcels", {"parcels": 2}),
        ("2 parcels, 1.5 water_l", {"parcels": 2, "water_l": 1.5}),
    ],
)
def test_amounts(told, read):
    assert amount(told) == read


@pytest.mark.parametrize("told", ["much", "2 parcels, some", "2 3", "1 a, 2 a", True])
def test_what_is_no_amount(told):
    with pytest.raises(CellError, match="a number, 12 kg, or amounts by commodity"):
        amount(told)


@pytest.mark.parametrize(
    ("value", "seconds"),
    [
        ("90", 90), ("90 s", 90), ("15 min", 900), ("1 h 30 min", 5400), ("00:15", 900), ("00:15:30", 930),
        ("PT15M", 900), ("1,5 h", 5400), (90, 90), (datetime.time(0, 15), 900), (datetime.timedelta(minutes=2), 120),
    ],
)  # fmt: skip
def test_durations(value, seconds):
    assert duration(value) == seconds


@pytest.mark.parametrize("value", ["soon", "-5", "1:75", "3 m", True, "5 min 3 kg"])
def test_what_is_no_duration(value):
    with pytest.raises(CellError, match="a duration"):
        duration(value)


@pytest.mark.parametrize(
    ("told", "read"),
    [
        ("01.03.2027 08:30", "2027-03-01T08:30:00"),
        ("1.3.2027, 8:30:15 Uhr", "2027-03-01T08:30:15"),
        ("8:30 Uhr", "08:30"),
        ("8.30 Uhr", "08:30"),
        ("17 uhr", "17:00"),
        ("24:00", "24:00"),
    ],
)
def test_moments_as_germans_write_them(told, read):
    assert moment(told) == read


@pytest.mark.parametrize("told", ["31.02.2027 08:30", "01.13.2027 08:30", "24:01", "25 Uhr", "03/01/2027 08:30"])
def test_what_is_no_moment(told):
    with pytest.raises(CellError, match="a clock time"):
        moment(told)


def test_moments_and_windows():
    assert [moment(one) for one in ("9:30", "2:30 pm", "12 am", "600", datetime.time(10, 0))] == [
        "09:30", "14:30", "00:00", 600.0, "10:00:00",
    ]  # fmt: skip
    assert pairs("10:00 - 11:00; 15:00\u201316:00") == [["10:00", "11:00"], ["15:00", "16:00"]]
    assert pairs("600 1200; 2000 inf") == [[600.0, 1200.0], [2000.0, None]]
    assert pairs([600, None]) == [[600, None]]
    with pytest.raises(CellError, match="a clock time"):
        moment("25:00")


@pytest.mark.parametrize(
    "text",
    [
        "35.53, 24.06",
        "35,53; 24,06",
        "35.53 24.06",
        "N35.53 E24.06",
        "35\u00b031'48\"N, 24\u00b03'36\"E",
        [35.53, 24.06],
    ],
)
def test_latitude_and_longitude_in_one_cell(text):
    assert lat_lon(text) == pytest.approx((35.53, 24.06))


def test_lists():
    assert words("camera; gripper arm") == ["camera", "gripper arm"]
    assert words("[1,18]") == ["1", "18"]
    assert words('["a,b", "c"]') == ["a,b", "c"]
