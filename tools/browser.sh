#!/bin/sh
# Looks for the browser in which the tests open the page of a record; as root on Debian it installs it when absent.
# MUSTER_BROWSER names one that is elsewhere.
set -u
for browser in "${MUSTER_BROWSER:-}" chromium chromium-browser google-chrome; do
    [ -n "$browser" ] && command -v "$browser" >/dev/null && exit 0
done
if [ "$(id -u)" -eq 0 ] && command -v apt-get >/dev/null; then
    echo "Installing Chromium for the tests of the page ..."
    apt-get update -q >/dev/null
    DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends chromium >/dev/null && exit 0
fi
echo "The tests of the page need Chromium. Install it:" >&2
echo "    sudo apt-get install chromium" >&2
echo "or let MUSTER_BROWSER name one." >&2
exit 1
