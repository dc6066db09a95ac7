#include "devices/hid/hid_device.h"

#include "engine/core/float_mode.h"

#include <algorithm>

namespace touchstone {

namespace {

constexpr double kSearchInterval = 0.5;        // s between two searches for a missing device
constexpr int kHidPollMs = 1;                  // of a driven device: maximum time that an order waits for a
                                               // report
constexpr int kRestingPollMs = 8;              // of the others
constexpr int64_t kHidKeepAliveNs = 5'000'000; // maximum interval between commands
constexpr int kMaxQueued = 64;                 // queue length of hidraw
constexpr int kFailedSendsToGiveUp = 20;
constexpr int kTriesOfTheLastWord = 5;
constexpr double kSpaceMouseStaleAge = 0.1; // s; some report every 16 ms

} // namespace

HidIdentity identityOf(const HidNode& node) {
    return {node.interfaceNumber, node.serial, node.productName};
}

HidRecipe spaceMouseRecipe(const HidNode& node) {
    HidRecipe recipe;
    recipe.name = node.name();
    recipe.usb = {node.vendor, node.product, std::nullopt, node.serial};
    recipe.path = node.path;
    recipe.limits.staleAge = kSpaceMouseStaleAge;
    recipe.protocol = makeSpaceMouseProtocol();
    recipe.rate = RateSettings{};
    return recipe;
}

HidRecipe recipeOf(const DeviceFile& file, const std::string& path) {
    HidRecipe recipe;
    recipe.name = file.name;
    recipe.usb = file.usb;
    recipe.path = path;
    recipe.limits = file.limits;
    recipe.pad = file.pad;
    recipe.protocol = makeProtocol(file);
    return recipe;
}

const HidNode* findNode(const HidRecipe& recipe, std::span<const HidNode> nodes,
                        const std::set<std::string>& inUse) {
    const HidNode* found = nullptr;
    for (const HidNode& node : nodes) {
        const UsbMatch& usb = recipe.usb;
        const auto& identity = recipe.identity;
        const bool same =
            !identity || (node.interfaceNumber == identity->interfaceNumber &&
                          node.serial == identity->serial && node.productName == identity->productName);
        const bool meant = same && node.vendor == usb.vendor && node.product == usb.product &&
                           (!usb.interfaceNumber || node.interfaceNumber == *usb.interfaceNumber) &&
                           (usb.serial.empty() || node.serial == usb.serial) &&
                           (!recipe.rate || hasAxes(node)) && !inUse.contains(node.path);
        if (meant && (found == nullptr || node.path == recipe.path))
            found = &node;
    }
    return found;
}

HidDevice::HidDevice(HidRecipe recipe) : recipe_(std::move(recipe)) {
    if (recipe_.rate)
        rateHand_.emplace(*recipe_.rate);
    thread_ = std::thread([this] { run(); });
}

HidDevice::~HidDevice() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    stop_.store(true, std::memory_order_relaxed);
    wake_.notify_all();
    thread_.join();
}

DeviceSample HidDevice::sample(double time) noexcept {
    DeviceReading reading = mailbox_.reading();
    DeviceSample sample = sampleOf(reading, steadyNs());
    if (!rateHand_)
        return sample;
    const bool fresh = sample.valid && sample.age <= recipe_.limits.staleAge;
    deviceFromView_.update();
    reading.push = deviceFromView_.value() * reading.push;
    reading.turn = deviceFromView_.value() * reading.turn;
    rateHand_->follow(reading, fresh, moving_ ? time - lastTime_ : 0.0);
    moving_ = true;
    lastTime_ = time;
    sample.position = rateHand_->position();
    sample.orientation = rateHand_->orientation();
    return sample;
}

bool HidDevice::waitStopping(double seconds) {
    std::unique_lock lock(mutex_);
    return wake_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return stopping_; });
}

void HidDevice::run() {
    enterFloatMode();
    monitor_.realtime.store(enterIoPriority(), std::memory_order_relaxed);
    while (!stop_.load(std::memory_order_relaxed)) {
        if (!port_.isOpen())
            connect();
        if (port_.isOpen())
            exchange();
        if (!port_.isOpen() && waitStopping(kSearchInterval))
            break;
    }
    if (port_.isOpen() && recipe_.protocol->driven())
        sayZero();
    port_.close();
}

/// The last command, zero force; retried after a short delay when the bus is busy.
void HidDevice::sayZero() {
    std::array<uint8_t, kMaxReportSize> report{};
    const size_t length = recipe_.protocol->command(ForceOrder{}, report);
    for (int tries = 0; tries < kTriesOfTheLastWord; ++tries) {
        if (port_.write(std::span(report).first(length)))
            return;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

void HidDevice::connect() {
    const std::vector<HidNode> nodes = listHidNodes();
    const HidNode* node = findNode(recipe_, nodes, HidPort::nodesInUse());
    if (node == nullptr) {
        monitor_.disconnected(LinkState::Searching, recipe_.name + " is not plugged in");
        return;
    }
    const std::string remedy = hidRemedy(*node);
    if (!remedy.empty()) {
        monitor_.disconnected(LinkState::Refused, recipe_.name + ": no permission to use " + node->path +
                                                      "\n  remedy: " + remedy);
        return;
    }
    const std::string problem = port_.open(node->path);
    if (!problem.empty()) {
        monitor_.disconnected(LinkState::Refused, recipe_.name + ": " + problem);
        return;
    }
    recipe_.identity = identityOf(*node);
    emptyNs_ = steadyNs();
    sentNs_ = 0;
    failedSends_ = 0;
    recipe_.protocol->restart(reading_);
    reading_.takenNs = emptyNs_;
    mailbox_.publish(reading_);
    monitor_.connected(node->path);
}

/// One turn: take the reports, then send the order. A queued report may have arrived at any time since the
/// queue was last empty, and is dated to that time.
void HidDevice::exchange() {
    std::array<uint8_t, kMaxReportSize> buffer{};
    const bool driven = recipe_.protocol->driven();
    int length = port_.read(buffer, 0);
    int64_t arrivedNs = emptyNs_;
    if (length == 0) {
        emptyNs_ = steadyNs();
        length = port_.read(buffer, driven ? kHidPollMs : kRestingPollMs);
        arrivedNs = steadyNs();
    }
    if (length > 0) {
        takeReports(buffer, length, arrivedNs);
    } else if (length == 0) {
        emptyNs_ = arrivedNs;
        if (recipe_.protocol->silenceHolds()) {
            reading_.takenNs = emptyNs_;
            mailbox_.publish(reading_);
        }
    } else {
        return disconnect(recipe_.name + " was unplugged");
    }
    if (driven && port_.isOpen())
        send(steadyNs());
}

/// Takes the first report, `length` bytes in the buffer, and all that are queued after it.
void HidDevice::takeReports(std::span<uint8_t> buffer, int length, int64_t arrivedNs) {
    for (int n = 1;; ++n) {
        takeReport(buffer.first(static_cast<size_t>(length)), arrivedNs);
        if (n == kMaxQueued)
            return;
        length = port_.read(buffer, 0);
        if (length < 0)
            return disconnect(recipe_.name + " was unplugged");
        if (length == 0) {
            emptyNs_ = steadyNs();
            return;
        }
    }
}

void HidDevice::takeReport(std::span<const uint8_t> report, int64_t arrivedNs) {
    uint64_t lost = 0;
    switch (recipe_.protocol->take(report, reading_, lost)) {
    case ReportVerdict::Reading:
        LinkMonitor::count(monitor_.reports);
        LinkMonitor::count(monitor_.lost, lost);
        reading_.takenNs = arrivedNs;
        mailbox_.publish(reading_);
        break;
    case ReportVerdict::Ignored:
        LinkMonitor::count(monitor_.ignored);
        break;
    case ReportVerdict::Repeated:
        LinkMonitor::count(monitor_.repeated);
        break;
    case ReportVerdict::Malformed:
        LinkMonitor::count(monitor_.malformed);
        break;
    }
}

void HidDevice::send(int64_t nowNs) {
    if (!mailbox_.updateOrder() && nowNs - sentNs_ < kHidKeepAliveNs)
        return;
    std::array<uint8_t, kMaxReportSize> report{};
    const size_t length = recipe_.protocol->command(mailbox_.order(nowNs), report);
    sentNs_ = nowNs;
    if (port_.write(std::span(report).first(length))) {
        failedSends_ = 0;
        LinkMonitor::count(monitor_.sent);
        return;
    }
    LinkMonitor::count(monitor_.sendFailures);
    if (++failedSends_ >= kFailedSendsToGiveUp)
        disconnect(recipe_.name + " takes no commands");
}

void HidDevice::disconnect(const std::string& problem) {
    port_.close();
    reading_ = {};
    mailbox_.publish(reading_);
    monitor_.disconnected(LinkState::Searching, problem);
}

} // namespace touchstone
