#include "api/c/live_hand.h"

#include "api/c/calls.h"
#include "devices/choice/device_choice.h"

#include <cmath>

namespace touchstone::api {

namespace {

constexpr const char* kStroke = "stroke";

/// The stroke that `device` names; empty: it names a device.
std::string strokeOf(const char* device, const std::string& argument) {
    const std::string text = device != nullptr ? device : "";
    if (text != kStroke && !text.starts_with("stroke:"))
        return {};
    const std::string name = text == kStroke ? "tour" : text.substr(7);
    if (const std::string problem = strokeProblem(name); !problem.empty())
        refuseArgument(argument + ".device", problem);
    return name;
}

} // namespace

double limitOr(double given, double usual, const std::string& argument) {
    if (given == 0.0)
        return usual;
    if (!std::isfinite(given) || given < 0.0)
        refuseArgument(argument, "is not finite and above 0");
    return given;
}

CallersDevice::CallersDevice(const ts_device& device, const std::string& argument) : device_(device) {
    if (device_.sample == nullptr)
        refuseArgument(argument + ".sample", "is null");
    if (device_.apply == nullptr)
        refuseArgument(argument + ".apply", "is null");
    limits_.maxForce = limitOr(device_.max_force, limits_.maxForce, argument + ".max_force");
    limits_.maxForceRate =
        limitOr(device_.max_force_rate, limits_.maxForceRate, argument + ".max_force_rate");
    limits_.recommendedStiffness =
        limitOr(device_.stiffness, limits_.recommendedStiffness, argument + ".stiffness");
    limits_.maxStiffness = limitOr(device_.max_stiffness, limits_.maxStiffness, argument + ".max_stiffness");
    limits_.staleAge = limitOr(device_.stale_age, limits_.staleAge, argument + ".stale_age");
}

DeviceSample CallersDevice::sample(double time) noexcept {
    ts_reading reading{};
    reading.size = sizeof reading;
    device_.sample(device_.context, time, &reading);
    DeviceSample sample;
    sample.position = {reading.position[0], reading.position[1], reading.position[2]};
    const glm::dquat turned{reading.orientation[0], reading.orientation[1], reading.orientation[2],
                            reading.orientation[3]};
    if (const double length = glm::length(turned); std::isfinite(length) && length > 1e-6)
        sample.orientation = turned / length;
    sample.age = reading.age;
    sample.buttons = reading.buttons;
    sample.valid = reading.valid != 0;
    return sample;
}

void CallersDevice::apply(const DeviceCommand& command) noexcept {
    const glm::dvec3& force = command.force();
    const double array[3]{force.x, force.y, force.z};
    device_.apply(device_.context, array);
}

LiveHand::LiveHand(const char* device, const ts_device* own, const std::string& argument) {
    if ((device == nullptr) == (own == nullptr))
        refuseArgument(argument + ".device", "give either a device or `own`");
    if (own != nullptr) {
        const std::string name = argument + ".own";
        own_ = std::make_unique<CallersDevice>(structOf(own, name.c_str()), name);
    } else if (stroke_ = strokeOf(device, argument); stroke_.empty()) {
        linked_ = openDevice(device, "stroke (a simulated hand)");
        if (linked_ == nullptr)
            throw Refused(TS_INPUT, argument + ".device: no device is plugged in that may be used");
    }
}

std::shared_ptr<const StrokePath> LiveHand::layStroke(TouchedScene& scene) const {
    if (!simulated())
        return nullptr;
    StrokeRequest request;
    request.name = stroke_;
    return scene.stroke(request);
}

Device& LiveHand::connect(TouchedScene& scene, double late) {
    newest_ = {};
    if (own_ != nullptr)
        return *own_;
    glm::dvec3 place(0.0);
    Device* device = linked_.get();
    if (device == nullptr) {
        const std::shared_ptr<const StrokePath> stroke = layStroke(scene);
        path_ = std::make_unique<SimulatedHand>(stroke, late * stroke->period());
        yielding_ = std::make_unique<HandImpedance>(*path_);
        device = yielding_.get();
        place = stroke->place();
    }
    mapped_ = std::make_unique<MappedDevice>(*device, 1.0, place);
    return *mapped_;
}

void LiveHand::take(const TickRecord& record, size_t keep) {
    newest_ = record;
    if (keep == 0)
        return;
    if (kept_.size() == keep)
        kept_.pop_front();
    kept_.push_back(rowOf(record.time, record.output, record.stepNs));
}

size_t LiveHand::takeKept(const TickArrays& ticks) {
    const size_t count = std::min(kept_.size(), ticks.capacity());
    for (size_t i = 0; i < count; ++i)
        ticks.put(i, kept_[i]);
    kept_.erase(kept_.begin(), kept_.begin() + static_cast<ptrdiff_t>(count));
    return count;
}

} // namespace touchstone::api
