"""The installation and the operating system: extras, plug-ins, clocks, signals, and what differs between platforms."""
