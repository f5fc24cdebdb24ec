#!/bin/sh
# Looks for what tests need of the system besides what building needs, and as root on Debian installs what is absent:
# a browser, in which the page of a record is opened (MUSTER_BROWSER names one that is elsewhere), a library that
# draws without a screen, for pictures of the physics world, ROS 1: its master, for the bridge to it, and `rosbag`,
# which reads bags that Muster has written, and PostgreSQL, of which the tests start a server of their own.
set -u
python=${PYTHON:-python3}
packages=""
has_browser() {
    for browser in "${MUSTER_BROWSER:-}" chromium chromium-browser google-chrome; do
        [ -n "$browser" ] && command -v "$browser" >/dev/null && return 0
    done
    return 1
}
draws() { # through EGL, for which Mesa has the driver, or through OSMesa
    "$python" -c 'import ctypes; ctypes.CDLL("libEGL.so.1"); ctypes.CDLL("libEGL_mesa.so.0")' 2>/dev/null ||
        "$python" -c 'import ctypes; ctypes.CDLL("libOSMesa.so.8")' 2>/dev/null
}
has_browser || packages="$packages chromium"
draws || packages="$packages libegl1 libegl-mesa0"
has_ros() { # its master, and its Python modules, which Debian has for its own Python
    command -v rosmaster >/dev/null && /usr/bin/python3 -c 'import nav_msgs, rospy, sensor_msgs, std_srvs, tf2_msgs, visualization_msgs' 2>/dev/null
}
has_ros || packages="$packages python3-rosmaster python3-rospy python3-nav-msgs python3-std-srvs python3-tf2-msgs"
has_ros || packages="$packages python3-sensor-msgs python3-visualization-msgs"
command -v rosbag >/dev/null || packages="$packages python3-rosbag"
has_postgresql() { # whose programs Debian keeps off the path
    for program in "$(command -v initdb)" "${POSTGRESQL:-/usr/lib/postgresql}"/*/bin/initdb; do
        [ -x "$program" ] && return 0
    done
    return 1
}
has_postgresql || packages="$packages postgresql"
[ -z "$packages" ] && exit 0
if [ "$(id -u)" -eq 0 ] && command -v apt-get >/dev/null; then
    echo "Installing for the tests:$packages ..."
    apt-get update -q >/dev/null
    # shellcheck disable=SC2086
    DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $packages >/dev/null && exit 0
fi
echo "Some tests need more. Install it:" >&2
echo "    sudo apt-get install$packages" >&2
echo "or let MUSTER_BROWSER name a browser." >&2
exit 1
