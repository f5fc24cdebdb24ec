"""Messages of ROS as bytes, beside those of the package rosbags; properties of reading what is damaged."""

import math
from functools import cache

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from muster.mission.errors import ParameterError
from muster_robots.ros2.description import ROS1, ROS2, fields_of
from muster_robots.ros2.message_types import MESSAGES, Header, Odometry, Time
from muster_robots.ros2.serialization import definition, from_cdr, from_ros1, md5_sum, to_cdr, to_ros1, type_name

rosbags = pytest.importorskip("rosbags.typesys")

SENT = sorted(MESSAGES.values(), key=lambda message: message.NAME)
PRIMITIVE = {
    "bool": st.booleans(),
    "int32": st.integers(0, 2**31 - 1),
    "uint32": st.integers(0, 2**32 - 1),
    "float32": st.floats(width=32, allow_nan=False),
    "float64": st.floats(allow_nan=False),
    "string": st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=9),
}
PRIMITIVES_OF_ROS1 = ("builtin_interfaces/Time", "builtin_interfaces/Duration")
MD5 = {  # of Debian's Noetic message packages
    "std_msgs/Header": "2176decaecbce78abc3b96ef049fabed",
    "std_msgs/String": "992ce8a1687cec8c8bd883ec73ca41d1",
    "geometry_msgs/PoseStamped": "d3812c3cbc69362b77dc0b19b345f8f5",
    "geometry_msgs/Twist": "9f195f881246fdfa2798d1d3eebca84a",
    "nav_msgs/Odometry": "cd5e73d190d741a2f92e81eda573aca7",
    "nav_msgs/Path": "6227e2b7e9cce15051f669a5e197bbf7",
    "tf2_msgs/TFMessage": "94810edda583a504dfda3829e70d7eec",
}


@cache
def store(ros):
    """The types of rosbags, with those of tf2_msgs, which it lacks."""
    made = rosbags.get_typestore(rosbags.Stores.ROS1_NOETIC if ros == ROS1 else rosbags.Stores.ROS2_HUMBLE)
    text = "geometry_msgs/TransformStamped[] transforms"
    made.register(rosbags.get_types_from_msg(text, "tf2_msgs/msg/TFMessage"))
    return made


@cache
def values(message, ros):
    return st.builds(message, **{field.name: _of_field(field, ros) for field in fields_of(message, ros)})


def _of_field(field, ros):
    if field.kind == "uint8":
        return st.binary(max_size=5)
    one = PRIMITIVE[field.kind] if isinstance(field.kind, str) else values(field.kind, ros)
    if not field.is_list:
        return one
    many = st.lists(one, min_size=field.length, max_size=field.length or 3)
    return many.map(tuple)


def theirs(message, ros):
    """The same message as one of rosbags."""
    import numpy as np

    made = {}
    for field in fields_of(type(message), ros):
        value = getattr(message, field.name)
        if field.kind == "uint8":
            value = np.frombuffer(value, dtype=np.uint8)
        elif isinstance(field.kind, str):
            value = np.array(value) if field.is_list else value
        else:
            value = [theirs(item, ros) for item in value] if field.is_list else theirs(value, ros)
        made[field.name] = value
    return store(ros).types[type_name(type(message))](**made)


def in_both(message, ros):
    return ros == ROS2 or (message.NAME not in PRIMITIVES_OF_ROS1 and type_name(message) in store(ROS1).types)


@pytest.mark.long(keep=7)
@pytest.mark.parametrize("message", SENT, ids=lambda message: message.NAME)
@settings(max_examples=15)
@given(st.data())
def test_bytes_are_those_of_rosbags_and_are_read_back(message, data):
    for ros, write, read in ((ROS2, to_cdr, from_cdr), (ROS1, to_ros1, from_ros1)):
        if not in_both(message, ros):
            continue
        sent = data.draw(values(message, ros))
        name = type_name(message)
        serialize = store(ros).serialize_cdr if ros == ROS2 else store(ros).serialize_ros1
        written = write(sent)
        assert written == bytes(serialize(theirs(sent, ros), name))
        assert read(message, written) == sent


@pytest.mark.parametrize(
    "message", [m for m in SENT if m.NAME not in PRIMITIVES_OF_ROS1], ids=lambda message: message.NAME
)
def test_definitions_are_those_of_ros(message):
    if type_name(message) in store(ROS1).types:
        text, md5 = store(ROS1).generate_msgdef(type_name(message), ros_version=1)
        assert definition(message, ROS1) == text
        assert md5_sum(message) == md5
    assert definition(message, ROS2) == store(ROS2).generate_msgdef(type_name(message), ros_version=2)[0]


@pytest.mark.parametrize("name", MD5)
def test_sums_are_those_of_debians_messages(name):
    assert md5_sum(MESSAGES[name]) == MD5[name]


def test_values_are_aligned_from_the_end_of_the_header():
    sent = Odometry(header=Header(stamp=Time(1, 2), frame_id="m"), child_frame_id="")
    assert to_cdr(sent)[:32].hex(" ", 4) == "00010000 01000000 02000000 02000000 6d000000 01000000 00000000 00000000"


@given(st.sampled_from(SENT), st.data())
def test_what_is_cut_off_is_refused(message, data):
    whole = to_cdr(message())
    with pytest.raises(ParameterError, match=message.NAME):
        from_cdr(message, whole[: data.draw(st.integers(0, max(3, len(whole) - 2)))])


def test_other_encodings_and_values_that_do_not_fit_are_refused():
    with pytest.raises(ParameterError, match="begins with 00 00 00 00; expected CDR, little endian"):
        from_cdr(Time, bytes(12))
    with pytest.raises(ParameterError, match=r"builtin_interfaces/Time.*expected values that fit"):
        to_cdr(Time(2**31, 0))


@given(st.floats(0, 2e9))
def test_a_time_is_kept_to_the_nanosecond(seconds):
    assert math.isclose(Time.of(seconds).seconds, seconds, abs_tol=5e-7)


@given(st.sampled_from(SENT), st.binary(max_size=120))
def test_any_bytes_are_a_message_or_refused(message, data):
    for read, begin in ((from_cdr, b"\0\1\0\0"), (from_ros1, b"")):
        said = message.NAME
        try:
            assert isinstance(read(message, begin + data), message)
        except ParameterError as error:
            said = str(error)
        assert message.NAME in said
