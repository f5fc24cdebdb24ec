"""The calendar, read again by the library icalendar."""

from datetime import UTC, datetime

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.muster_files.sheets.crew import CREW, crew

from muster import MissionError
from muster.planning.export_formats import ExportOptions
from muster.planning.exporting import exported
from muster_files.sheets.appointments import escaped, folded


def texts(folder, text=CREW, **options):
    mission, verdict, plan = crew(folder, text)
    return exported(mission, verdict, "ics", ExportOptions(**options), plan).texts


def events(text):
    import icalendar

    calendar = icalendar.Calendar.from_ical(text)
    assert not calendar.errors
    return list(calendar.walk("VEVENT"))


def robots_of(event):
    return [str(name) for name in event["CATEGORIES"].cats]


def test_an_event_for_each_task_with_its_robots_and_for_each_stop_at_a_station(tmp_path):
    found = events(texts(tmp_path)["plan.ics"])
    assert [(str(event["SUMMARY"]), robots_of(event)) for event in found] == [
        ("pier (r)", ["r"]),
        ("[pad] (r)", ["r"]),
        ("buoy (r)", ["r"]),
        ("[pad] (s)", ["s"]),
        ("beam (t, u)", ["t", "u"]),
        ("scan (t)", ["t"]),
        ("check (u)", ["u"]),
    ]
    beam = found[4]
    assert beam.start == datetime(2027, 3, 1, 22, 59, 20, tzinfo=UTC)
    assert beam.end == datetime(2027, 3, 1, 22, 59, 30, tzinfo=UTC)
    assert beam["DTSTAMP"].dt == datetime(2027, 3, 1, 22, 59, tzinfo=UTC)
    assert "t: number 1, arrives 23:59:10, waits for u" in beam["DESCRIPTION"]
    assert str(beam["LOCATION"]) == "(10, 100) m"
    assert beam["GEO"].latitude == pytest.approx(35.5309, abs=1e-4)


def test_a_stop_without_duration_has_no_end(tmp_path):
    pier = events(texts(tmp_path)["plan.ics"])[0]
    assert "DTEND" not in pier
    assert pier.start == pier.end


def test_a_calendar_for_each_robot(tmp_path):
    found = texts(tmp_path, per_robot=True)
    assert list(found) == ["r.ics", "s.ics", "t.ics", "u.ics"]
    assert [str(event["SUMMARY"]) for event in events(found["u.ics"])] == ["beam (u)", "check (u)"]


def test_uids_follow_from_names_and_are_unique(tmp_path):
    first = [str(event["UID"]) for event in events(texts(tmp_path)["plan.ics"])]
    later = [str(event["UID"]) for event in events(texts(tmp_path, CREW.replace("23:59:00", "10:00:00"))["plan.ics"])]
    assert first == later
    other = [str(event["UID"]) for event in events(texts(tmp_path, per_robot=True)["u.ics"])]
    assert len({*first, *other}) == len(first) + len(other)


def test_a_start_without_zone_gives_local_times(tmp_path):
    text = texts(tmp_path, CREW.replace("00+01:00", "00"))["plan.ics"]
    assert "DTSTART:20270301T235920\r\n" in text
    assert events(text)[4].start == datetime(2027, 3, 1, 23, 59, 20)


def test_without_a_start_there_is_no_calendar(tmp_path):
    with pytest.raises(MissionError, match="starts_at: missing; expected starts_at: 2027-03-01T08:00:00"):
        texts(tmp_path, CREW.replace("starts_at: 2027-03-01T23:59:00+01:00\n", ""))
    with pytest.raises(MissionError, match="expected a plan that ends before the year 10000"):
        texts(tmp_path, CREW.replace("2027-03-01", "9999-12-31"))


@given(st.text(max_size=200).filter(lambda text: text.isprintable()))
def test_every_text_comes_back_and_no_line_is_too_long(text):
    lines = list(folded(f"SUMMARY:{escaped(text)}"))
    assert all(len(line.encode("utf-8")) <= 75 for line in lines)
    body = "\r\n".join(["BEGIN:VCALENDAR", "BEGIN:VEVENT", *lines, "END:VEVENT", "END:VCALENDAR", ""])
    (event,) = events(body)
    assert str(event["SUMMARY"]) == text
