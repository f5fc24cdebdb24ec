"""A user who knows nothing of Muster, only ROS: does what lines of JSON on standard input say, and answers in JSON.

{"call": SERVICE}, {"set": PARAMETER, "to": VALUE}, {"publish": TOPIC, "text": TEXT}, {"last": TOPIC} (of a latched
std_msgs/String), {"nodes": true}, {"publishers": TOPIC}, {"image": TOPIC},
{"scan": TOPIC, "ranges": [...], "first": RAD, "step": RAD} (published until somebody has heard it).
"""

import json
import sys
import time

if "/usr/lib/python3/dist-packages" not in sys.path:
    sys.path.append("/usr/lib/python3/dist-packages")
import rosgraph
import rospy
from std_msgs.msg import String
from std_srvs.srv import Trigger


def call(name):
    rospy.wait_for_service(name, timeout=20)
    answer = rospy.ServiceProxy(name, Trigger)()
    return {"success": answer.success, "message": answer.message}


publishers = {}


def publish(topic, text):
    if topic not in publishers:
        publishers[topic] = rospy.Publisher(topic, String, queue_size=10)
    until = time.monotonic() + 20
    while publishers[topic].get_num_connections() == 0:
        assert time.monotonic() < until, f"nobody hears {topic}"
        time.sleep(0.02)
    publishers[topic].publish(String(text))


def scan(scan, ranges, first, step):
    from sensor_msgs.msg import LaserScan

    publishers.setdefault(scan, rospy.Publisher(scan, LaserScan, queue_size=10))
    message = LaserScan(angle_min=first, angle_increment=step, range_min=0.05, range_max=4.0, ranges=ranges)
    message.header.stamp = rospy.Time.now()
    time.sleep(0.1)
    publishers[scan].publish(message)


def state():
    """Of the master: (topic, nodes) of those who publish, who subscribe, who serve."""
    return rosgraph.Master("/user").getSystemState()


def do(asked):
    if "call" in asked:
        return call(asked["call"])
    if "set" in asked:
        return rospy.set_param(asked["set"], asked["to"])
    if "publish" in asked:
        return publish(asked["publish"], asked["text"])
    if "last" in asked:
        return json.loads(rospy.wait_for_message(asked["last"], String, timeout=20).data)
    if "scan" in asked:
        return scan(**asked)
    if "image" in asked:
        from sensor_msgs.msg import Image

        image = rospy.wait_for_message(asked["image"], Image, timeout=20)
        size = {"width": image.width, "height": image.height, "encoding": image.encoding}
        return size | {"frame": image.header.frame_id, "first": list(image.data[:3])}
    if "nodes" in asked:
        return sorted({node for part in state() for _, nodes in part for node in nodes})
    return dict(map(tuple, state()[0])).get(asked["publishers"], [])


answers, sys.stdout = sys.stdout, sys.stderr  # what libraries print is no answer
rospy.init_node("user", anonymous=True)
for line in sys.stdin:
    answers.write(json.dumps(do(json.loads(line))) + "\n")
    answers.flush()
