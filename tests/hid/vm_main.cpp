// The HID test that runs inside the virtual machine (run_vm_tests.py starts it there), on a real kernel's HID stack.
// `spidar_hid_vm --host SERIAL` is the host that one of the tests kills.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstring>

#include "hid/vm_host.h"

namespace {

constexpr double kForce_n = 3.0;
constexpr double kForEver_s = 1000.0;

int be_host(const char *serial) {
    spidar::test::VmHost host(serial);
    if (!spidar::usable(host.start()) || !host.activate(kForce_n)) {
        return 1;
    }
    host.pull(kForEver_s);
    return 0;
}

} // namespace

int main(int argc, char **argv) {
    if (argc == 3 && std::strcmp(argv[1], "--host") == 0) {
        return be_host(argv[2]);
    }
    doctest::Context context(argc, argv);
    return context.run();
}
