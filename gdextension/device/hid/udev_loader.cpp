// hidapi's Linux backend calls libudev. Loading it on first use, instead of linking it, lets the
// add-on start on systems without udev: no HID devices are found there, and the simulated one is
// used. These are the functions that hidapi's hidraw backend needs; their types are opaque.
#ifdef __linux__

#include <dlfcn.h>
#include <sys/types.h>

namespace {

void *find(const char *name) {
    // RTLD_NODELETE: devices may be closed while the process ends.
    static void *const library = dlopen("libudev.so.1", RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    return library != nullptr ? dlsym(library, name) : nullptr;
}

// A null result means "no such thing" to hidapi in every one of these.
template <typename Result, typename... Arguments>
Result forward(const char *name, Arguments... arguments) {
    using Function = Result (*)(Arguments...);
    const auto function = reinterpret_cast<Function>(find(name));
    return function != nullptr ? function(arguments...) : Result{};
}

} // namespace

// NOLINTBEGIN(readability-identifier-naming): libudev's names
extern "C" {

struct udev;
struct udev_device;
struct udev_enumerate;
struct udev_list_entry;

udev *udev_new() {
    return forward<udev *>("udev_new");
}
udev *udev_unref(udev *context) {
    return forward<udev *>("udev_unref", context);
}
const char *udev_device_get_devnode(udev_device *device) {
    return forward<const char *>("udev_device_get_devnode", device);
}
const char *udev_device_get_syspath(udev_device *device) {
    return forward<const char *>("udev_device_get_syspath", device);
}
const char *udev_device_get_sysattr_value(udev_device *device, const char *name) {
    return forward<const char *>("udev_device_get_sysattr_value", device, name);
}
udev_device *udev_device_get_parent_with_subsystem_devtype(udev_device *device,
                                                           const char *subsystem,
                                                           const char *type) {
    return forward<udev_device *>("udev_device_get_parent_with_subsystem_devtype", device,
                                  subsystem, type);
}
udev_device *udev_device_new_from_devnum(udev *context, char type, dev_t number) {
    return forward<udev_device *>("udev_device_new_from_devnum", context, type, number);
}
udev_device *udev_device_new_from_syspath(udev *context, const char *path) {
    return forward<udev_device *>("udev_device_new_from_syspath", context, path);
}
udev_device *udev_device_unref(udev_device *device) {
    return forward<udev_device *>("udev_device_unref", device);
}
udev_enumerate *udev_enumerate_new(udev *context) {
    return forward<udev_enumerate *>("udev_enumerate_new", context);
}
int udev_enumerate_add_match_subsystem(udev_enumerate *enumerate, const char *subsystem) {
    return forward<int>("udev_enumerate_add_match_subsystem", enumerate, subsystem);
}
int udev_enumerate_scan_devices(udev_enumerate *enumerate) {
    return forward<int>("udev_enumerate_scan_devices", enumerate);
}
udev_list_entry *udev_enumerate_get_list_entry(udev_enumerate *enumerate) {
    return forward<udev_list_entry *>("udev_enumerate_get_list_entry", enumerate);
}
udev_enumerate *udev_enumerate_unref(udev_enumerate *enumerate) {
    return forward<udev_enumerate *>("udev_enumerate_unref", enumerate);
}
const char *udev_list_entry_get_name(udev_list_entry *entry) {
    return forward<const char *>("udev_list_entry_get_name", entry);
}
udev_list_entry *udev_list_entry_get_next(udev_list_entry *entry) {
    return forward<udev_list_entry *>("udev_list_entry_get_next", entry);
}

} // extern "C"
// NOLINTEND(readability-identifier-naming)

#endif
