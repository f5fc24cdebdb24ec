"""A node that knows nothing of Muster: FILE, and TOPIC=PACKAGE/TYPE for each topic; writes what it hears there."""

import importlib
import json
import sys
import time
from pathlib import Path

if "/usr/lib/python3/dist-packages" not in sys.path:
    sys.path.append("/usr/lib/python3/dist-packages")
import rospy


def plain(message):
    if hasattr(message, "to_sec"):
        return message.to_sec()
    if hasattr(message, "__slots__"):
        return {name: plain(getattr(message, name)) for name in message.__slots__}
    return [plain(item) for item in message] if isinstance(message, (list, tuple)) else message


def tell(message, topic):
    file.write(json.dumps([topic, plain(message)], default=str) + "\n")
    file.flush()


rospy.init_node("listener", anonymous=True)
file = Path(sys.argv[1]).open("w", encoding="utf-8")  # noqa: SIM115 - to the end of the process
for argument in sys.argv[2:]:
    topic, _, kind = argument.partition("=")
    package, _, name = kind.partition("/")
    rospy.Subscriber(topic, getattr(importlib.import_module(f"{package}.msg"), name), tell, callback_args=topic)
while not rospy.is_shutdown():
    time.sleep(0.05)
