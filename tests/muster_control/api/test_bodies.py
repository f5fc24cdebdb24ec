"""How many values a body has: what stands in its texts are none."""

import json

import pytest
from fastapi import HTTPException

from muster_control.api.bodies import MOST_VALUES, strict_json


@pytest.mark.parametrize("text", ["a, [b] {c}" * MOST_VALUES, '\\",[' * MOST_VALUES])
def test_a_long_text_is_one_value(text):
    body = {"text": text, "more": [1, 2]}
    assert strict_json(json.dumps(body).encode()) == body


@pytest.mark.parametrize(
    "body",
    [
        b'["x"' + b',"x"' * MOST_VALUES + b"]",
        b"[" * (MOST_VALUES + 1),
        b'["a\\\\"' + b",1" * MOST_VALUES + b"]",
    ],
)
def test_too_many_values_are_refused_before_they_are_read(body):
    with pytest.raises(HTTPException, match="too many values"):
        strict_json(body)


@pytest.mark.parametrize("body", [b'"' + b'\\"' * 2**20 + b"," * (MOST_VALUES + 1), b"," * (MOST_VALUES + 1) + b'"\\'])
def test_texts_that_do_not_end_are_refused_at_once(body):
    with pytest.raises(HTTPException):
        strict_json(body)
