#pragma once
// HID devices that are not there, by umockdev: sysfs and node as the kernel would show them. The node is a
// FIFO in packet mode, so that every report is read as it was written; umockdev's own pseudo-terminal would
// run them together.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

typedef struct _UMockdevTestbed UMockdevTestbed;

namespace touchstone::test {

using Bytes = std::vector<uint8_t>;

/// Starts this program anew under umockdev's preloaded library, unless it runs under it already. First thing
/// in main.
void enterMockEnvironment(char** argv);

struct MockHidInfo {
    uint16_t vendor = 0, product = 0;
    std::string name = "mock", serial = "";
    int interfaceNumber = 0;
    uint16_t usagePage = 0xFF00, usage = 1;
    unsigned mode = 0666; ///< permissions of the node
};

/// One plugged-in device; unplugged at the end of its life.
class MockHid {
  public:
    MockHid(UMockdevTestbed* testbed, int number, const MockHidInfo& info);
    ~MockHid() { unplug(); }
    MockHid(const MockHid&) = delete;
    MockHid& operator=(const MockHid&) = delete;

    [[nodiscard]] std::string node() const { return node_; } ///< "/dev/hidraw3"

    /// One report, exactly these bytes in one packet. Waits while 256 are unread; throws when that lasts.
    void say(const Bytes& report);
    /// The same, but lost while 256 are unread, as the kernel's own queue does it.
    bool trySay(const Bytes& report);
    /// Every report that was written to it so far, the id first.
    [[nodiscard]] std::vector<Bytes> heard() const;
    [[nodiscard]] Bytes lastHeard() const;
    void forget();
    void refuseWrites(bool refuse);
    /// Pulls the plug: reads and writes fail, node and sysfs are gone.
    void unplug();

    /// What umockdev's thread shares with it.
    struct Wire;

  private:
    UMockdevTestbed* testbed_;
    std::shared_ptr<Wire> wire_;
    std::string node_, fifo_, syspath_;
    int reader_ = -1, writer_ = -1;
};

/// A bus without devices.
class MockBus {
  public:
    MockBus();
    ~MockBus();
    MockBus(const MockBus&) = delete;
    MockBus& operator=(const MockBus&) = delete;

    [[nodiscard]] std::unique_ptr<MockHid> plug(const MockHidInfo& info);
    /// The same at a node of this number.
    [[nodiscard]] std::unique_ptr<MockHid> plugAt(int number, const MockHidInfo& info);
    [[nodiscard]] std::string root() const;

  private:
    UMockdevTestbed* testbed_;
    int next_ = 0;
};

} // namespace touchstone::test
