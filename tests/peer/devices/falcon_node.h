// A Falcon as the kernel lists it, for umockdev.
#pragma once

namespace slosh::test {

/// Device descriptor, then one configuration with one interface and two bulk ends.
constexpr const char* kFalconNode =
    "P: /devices/pci0000:00/usb1/1-4\nN: bus/usb/001/004\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\n"
    "E: DEVNAME=/dev/bus/usb/001/004\nE: BUSNUM=001\nE: DEVNUM=004\nA: busnum=1\\n\nA: devnum=4\\n\n"
    "A: speed=12\\n\nA: bConfigurationValue=1\\n\nA: idVendor=0403\\n\nA: idProduct=cb48\\n\n"
    "H: descriptors="
    "1201000200000040030448cb0006010203010902200001010080320904000002ffffff00070502024000000705810240000000\n"
    "\n";

}  // namespace slosh::test
