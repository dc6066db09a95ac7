#include "tests/support/mock_hid.h"

#include "tests/support/eventually.h"

#include <fcntl.h>
#include <linux/hidraw.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <umockdev.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <stdexcept>
#include <thread>

namespace touchstone::test {

namespace {

constexpr int kPipeBytes = 1 << 20; // a packet takes a page: 256 of them

std::string hex(unsigned value, int digits) {
    char text[16];
    std::snprintf(text, sizeof text, "%0*X", digits, value);
    return text;
}

std::string taken(gchar* text) {
    std::string result = text != nullptr ? text : "";
    g_free(text);
    return result;
}

[[noreturn]] void fail(const std::string& what) {
    throw std::runtime_error("mock HID: " + what);
}

} // namespace

void enterMockEnvironment(char** argv) {
    constexpr const char* kEntered = "TOUCHSTONE_MOCK_ENVIRONMENT";
    if (std::getenv(kEntered) != nullptr)
        return;
    const char* preloaded = std::getenv("LD_PRELOAD");
    const std::string library = "libumockdev-preload.so.0";
    setenv("LD_PRELOAD", preloaded != nullptr ? (library + ":" + preloaded).c_str() : library.c_str(), 1);
    setenv(kEntered, "1", 1);
    execv("/proc/self/exe", argv);
    fail("cannot start anew");
}

struct MockHid::Wire {
    std::atomic<bool> gone{false}, refuseWrites{false};
    std::mutex mutex;
    std::vector<Bytes> heard;
};

namespace {

/// For good: a program may hold a node open for longer than its device is plugged in.
void keepForGood(const std::shared_ptr<MockHid::Wire>& wire) {
    static std::vector<std::shared_ptr<MockHid::Wire>> all;
    all.push_back(wire);
}

/// What umockdev's own thread calls for a program that uses the node.
struct MockHidHandlers {
    static gboolean ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer) {
        if (umockdev_ioctl_client_get_request(client) != HIDIOCGRDESCSIZE)
            return FALSE;
        UMockdevIoctlData* argument = umockdev_ioctl_client_get_arg(client);
        GError* error = nullptr;
        UMockdevIoctlData* data = umockdev_ioctl_data_resolve(argument, 0, sizeof(int), &error);
        int size = 8;
        umockdev_ioctl_data_update(data, 0, reinterpret_cast<guint8*>(&size), sizeof size);
        umockdev_ioctl_client_complete(client, 0, 0);
        umockdev_ioctl_data_unref(data);
        return TRUE;
    }
    /// FALSE: the FIFO itself is read.
    static gboolean read(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
        if (!static_cast<MockHid::Wire*>(self)->gone)
            return FALSE;
        umockdev_ioctl_client_complete(client, -1, EIO);
        return TRUE;
    }
    static gboolean write(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
        auto& wire = *static_cast<MockHid::Wire*>(self);
        if (wire.gone || wire.refuseWrites) {
            umockdev_ioctl_client_complete(client, -1, wire.gone ? ENODEV : EPIPE);
            return TRUE;
        }
        UMockdevIoctlData* argument = umockdev_ioctl_client_get_arg(client);
        guint8* bytes = nullptr;
        int length = 0;
        umockdev_ioctl_data_retrieve(argument, &bytes, &length);
        {
            const std::lock_guard lock(wire.mutex);
            wire.heard.emplace_back(bytes, bytes + length);
        }
        umockdev_ioctl_client_complete(client, length, 0);
        g_free(bytes);
        return TRUE;
    }
};

} // namespace

MockHid::MockHid(UMockdevTestbed* testbed, int number, const MockHidInfo& info)
    : testbed_(testbed), wire_(std::make_shared<Wire>()) {
    keepForGood(wire_);
    const std::string place = "1-" + std::to_string(number + 1), node = "hidraw" + std::to_string(number);
    const std::string usb = taken(umockdev_testbed_add_device(
        testbed, "usb", place.c_str(), nullptr, "idVendor", hex(info.vendor, 4).c_str(), "idProduct",
        hex(info.product, 4).c_str(), "manufacturer", "Mock", "product", info.name.c_str(), "serial",
        info.serial.c_str(), nullptr, "DEVTYPE", "usb_device", nullptr));
    const std::string interface = taken(
        umockdev_testbed_add_device(testbed, "usb", (place + ":1.0").c_str(), usb.c_str(), "bInterfaceNumber",
                                    hex(static_cast<unsigned>(info.interfaceNumber), 2).c_str(), nullptr,
                                    "DEVTYPE", "usb_interface", nullptr));
    const std::string hidName = "0003:" + hex(info.vendor, 4) + ":" + hex(info.product, 4) + "." +
                                hex(static_cast<unsigned>(number) + 1, 4);
    const std::string id = "0003:" + hex(info.vendor, 8) + ":" + hex(info.product, 8);
    const std::string hid = taken(umockdev_testbed_add_device(
        testbed, "hid", hidName.c_str(), interface.c_str(), nullptr, "HID_ID", id.c_str(), "HID_NAME",
        info.name.c_str(), "HID_UNIQ", info.serial.c_str(), nullptr));
    // Usage page and usage of one application collection.
    guint8 descriptor[] = {0x06,
                           static_cast<guint8>(info.usagePage),
                           static_cast<guint8>(info.usagePage >> 8),
                           0x0A,
                           static_cast<guint8>(info.usage),
                           static_cast<guint8>(info.usage >> 8),
                           0xA1,
                           0x01,
                           0xC0};
    umockdev_testbed_set_attribute_binary(testbed, hid.c_str(), "report_descriptor", descriptor,
                                          sizeof descriptor);
    node_ = "/dev/" + node;
    const std::string raw = taken(umockdev_testbed_add_device(testbed, "hidraw", node.c_str(), hid.c_str(),
                                                              nullptr, "DEVNAME", node_.c_str(), nullptr));
    umockdev_testbed_set_attribute_link(testbed, raw.c_str(), "device", ("../../" + hidName).c_str());
    syspath_ = usb;

    UMockdevIoctlBase* handler = umockdev_ioctl_base_new();
    g_signal_connect(handler, "handle-ioctl", G_CALLBACK(MockHidHandlers::ioctl), wire_.get());
    g_signal_connect(handler, "handle-read", G_CALLBACK(MockHidHandlers::read), wire_.get());
    g_signal_connect(handler, "handle-write", G_CALLBACK(MockHidHandlers::write), wire_.get());
    GError* error = nullptr;
    if (!umockdev_testbed_attach_ioctl(testbed, node_.c_str(), handler, &error))
        fail(error->message);

    fifo_ = taken(umockdev_testbed_get_root_dir(testbed)) + node_;
    if (mkfifo(fifo_.c_str(), 0600) != 0)
        fail("no FIFO at " + fifo_);
    reader_ = ::open(fifo_.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC); // keeps it open for the writer
    writer_ = ::open(fifo_.c_str(), O_WRONLY | O_CLOEXEC);
    // Packet mode cannot be asked for while opening a FIFO, only afterwards (pipe(2), fcntl(2)).
    if (writer_ < 0 || fcntl(writer_, F_SETFL, O_DIRECT | O_NONBLOCK) != 0 ||
        fcntl(writer_, F_SETPIPE_SZ, kPipeBytes) < 0)
        fail("no packets through " + fifo_);
    ::chmod(fifo_.c_str(), info.mode);
}

void MockHid::say(const Bytes& report) {
    if (!eventually([&] { return trySay(report); }))
        fail("nobody reads the reports");
}

bool MockHid::trySay(const Bytes& report) {
    const ssize_t written = ::write(writer_, report.data(), report.size());
    if (written < 0 && errno == EAGAIN)
        return false;
    if (written != static_cast<ssize_t>(report.size()))
        fail("a report of " + std::to_string(report.size()) + " bytes was not taken");
    return true;
}

std::vector<Bytes> MockHid::heard() const {
    const std::lock_guard lock(wire_->mutex);
    return wire_->heard;
}

Bytes MockHid::lastHeard() const {
    const std::lock_guard lock(wire_->mutex);
    return wire_->heard.empty() ? Bytes{} : wire_->heard.back();
}

void MockHid::forget() {
    const std::lock_guard lock(wire_->mutex);
    wire_->heard.clear();
}

void MockHid::refuseWrites(bool refuse) {
    wire_->refuseWrites = refuse;
}

void MockHid::unplug() {
    if (writer_ < 0)
        return;
    wire_->gone = true;
    ::unlink(fifo_.c_str());
    umockdev_testbed_remove_device(testbed_, syspath_.c_str());
    // Whoever waits for a report is woken and finds the device gone.
    (void)!::write(writer_, "x", 1);
    // The handler stays: a program that still has the node open must hear that it is gone.
    ::close(writer_);
    ::close(reader_);
    writer_ = reader_ = -1;
}

MockBus::MockBus() : testbed_(umockdev_testbed_new()) {
    ::mkdir((root() + "/dev").c_str(), 0755);
    ::chmod(root().c_str(), 0755);
}

MockBus::~MockBus() {
    g_object_unref(testbed_);
}

std::string MockBus::root() const {
    return taken(umockdev_testbed_get_root_dir(testbed_));
}

std::unique_ptr<MockHid> MockBus::plug(const MockHidInfo& info) {
    return plugAt(next_++, info);
}

std::unique_ptr<MockHid> MockBus::plugAt(int number, const MockHidInfo& info) {
    next_ = std::max(next_, number + 1);
    return std::make_unique<MockHid>(testbed_, number, info);
}

} // namespace touchstone::test

// umockdev, GLib and udev are not built with the thread sanitizer, so their own hand-overs are invisible to
// it, and so are those from this file to umockdev's thread. What devices/ does is watched.
extern "C" const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions() {
    return "called_from_lib:libumockdev.so.0\n"
           "called_from_lib:libumockdev-preload.so.0\n"
           "called_from_lib:libglib-2.0.so.0\n"
           "called_from_lib:libgobject-2.0.so.0\n"
           "called_from_lib:libgio-2.0.so.0\n"
           "called_from_lib:libudev.so.1\n"
           "race:libumockdev.so.0\n"
           "race:libglib-2.0.so.0\n"
           "race:libgobject-2.0.so.0\n"
           "race:libgio-2.0.so.0\n"
           "race:tests/support/mock_hid.cpp\n";
}
