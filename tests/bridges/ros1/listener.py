"""A node that knows nothing of Muster: prints what it hears on the topics that it is given, as TOPIC=PACKAGE/TYPE."""

import importlib
import json
import sys
import time

if "/usr/lib/python3/dist-packages" not in sys.path:
    sys.path.append("/usr/lib/python3/dist-packages")
import rospy


def plain(message):
    if hasattr(message, "__slots__"):
        return {name: plain(getattr(message, name)) for name in message.__slots__}
    return [plain(item) for item in message] if isinstance(message, (list, tuple)) else message


def tell(message, topic):
    sys.stdout.write(json.dumps([topic, plain(message)], default=str) + "\n")
    sys.stdout.flush()


rospy.init_node("listener", anonymous=True)
for argument in sys.argv[1:]:
    topic, _, kind = argument.partition("=")
    package, _, name = kind.partition("/")
    rospy.Subscriber(topic, getattr(importlib.import_module(f"{package}.msg"), name), tell, callback_args=topic)
sys.stdout.write("ready\n")
sys.stdout.flush()
while not rospy.is_shutdown():
    time.sleep(0.05)
