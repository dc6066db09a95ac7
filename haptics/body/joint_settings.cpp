#include "haptics/body/joint_settings.h"

#include <algorithm>
#include <cmath>

namespace touchstone::body {

namespace {

/// Parts of a range between two numbers.
constexpr int kParts = 50;
/// Of the way between two places: where a control goes over to the next.
constexpr double kOver = 0.6;

std::string textOf(double value) {
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    if (!text.empty() && text.back() == '.')
        text.pop_back();
    return text;
}

/// Where the values lie on the free axis.
std::vector<double> placesOf(const BodyJoint& joint) {
    const JointAxis& axis = joint.axes[static_cast<size_t>(joint.freeAxis)];
    const size_t count = joint.setting.steps            ? 2
                         : joint.setting.values.empty() ? kParts + 1
                                                        : joint.setting.values.size();
    if (!joint.setting.steps && !joint.detents.empty() && joint.detents.size() == joint.setting.values.size())
        return joint.detents;
    std::vector<double> places;
    if (axis.min > -1e300 && axis.max < 1e300)
        for (size_t i = 0; i < count; ++i)
            places.push_back(axis.min +
                             (axis.max - axis.min) * static_cast<double>(i) / static_cast<double>(count - 1));
    return places;
}

int nearest(std::span<const double> places, double q) {
    int found = 0;
    for (size_t i = 1; i < places.size(); ++i)
        if (std::abs(places[i] - q) < std::abs(places[static_cast<size_t>(found)] - q))
            found = static_cast<int>(i);
    return found;
}

} // namespace

std::string settingProblem(const JointSetting& setting) {
    HapticSettings settings;
    std::vector<std::string> values = setting.values;
    if (values.empty())
        values = {textOf(setting.from), textOf(setting.to)};
    for (const std::string& value : values)
        if (std::string problem = setSetting(settings, setting.name, value); !problem.empty())
            return problem;
    return {};
}

JointSettings::JointSettings(const BodyWorld& world) : states_(world.states().size()) {
    for (const BodyJoint& joint : world.solver().joints()) {
        if (joint.setting.name.empty() || joint.freeAxis < 0)
            continue;
        Control control;
        control.places = placesOf(joint);
        if (control.places.size() < 2)
            continue;
        // What the servo writes is not read: its turns, that is.
        control.joint.a = joint.a;
        control.joint.b = joint.b;
        control.joint.inA = joint.inA;
        control.joint.inB = joint.inB;
        control.joint.axes = joint.axes;
        control.joint.freeAxis = joint.freeAxis;
        control.joint.setting = joint.setting;
        controls_.push_back(std::move(control));
    }
}

std::string JointSettings::valueOf(const Control& control) {
    const JointSetting& setting = control.joint.setting;
    if (!setting.values.empty())
        return setting.values[control.value];
    return textOf(setting.from + (setting.to - setting.from) * static_cast<double>(control.value) / kParts);
}

bool JointSettings::apply(std::span<const Pose> workspaceFromBody, HapticSettings& settings) {
    for (size_t b = 0; b < states_.size() && b < workspaceFromBody.size(); ++b)
        states_[b].pose = workspaceFromBody[b];
    bool changed = false;
    for (Control& control : controls_) {
        const double q =
            BodySolver::reading(control.joint, states_).position[static_cast<size_t>(control.joint.freeAxis)];
        const int now = nearest(control.places, q);
        if (control.at < 0) {
            control.at = now;
            control.value = control.joint.setting.steps ? 0 : static_cast<size_t>(now);
            control.rest = q;
            continue;
        }
        const auto at = static_cast<size_t>(control.at), next = static_cast<size_t>(now);
        const double way = std::abs(control.places[next] - control.places[at]);
        if (now == control.at ||
            std::abs(q - control.places[at]) < way - (1.0 - kOver) * way / std::abs(now - control.at))
            continue;
        control.at = now;
        if (control.joint.setting.steps) {
            // Pressed: away from where it was at first.
            if (std::abs(control.places[next] - control.rest) < std::abs(control.places[at] - control.rest))
                continue;
            control.value = (control.value + 1) % control.joint.setting.values.size();
        } else {
            control.value = next;
        }
        changed |= setSetting(settings, control.joint.setting.name, valueOf(control)).empty();
    }
    return changed;
}

} // namespace touchstone::body
