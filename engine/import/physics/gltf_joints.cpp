#include "engine/import/physics/gltf_joints.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace touchstone {

using nlohmann::json;

void JointReader::readLimit(const json& limit, const std::string& place, Joint& joint) {
    if (!limit.is_object())
        import_.context.fail(place, "should be an object");
    const double low = import_.number(limit, "min", place, -import_.kAny, import_.kAny,
                                      -std::numeric_limits<double>::infinity()),
                 high = import_.number(limit, "max", place, -import_.kAny, import_.kAny,
                                       std::numeric_limits<double>::infinity());
    if (!(low <= high))
        import_.context.fail(place, "has a 'min' above its 'max'");
    for (const auto& [name, first] : {std::pair{"linearAxes", 0}, std::pair{"angularAxes", 3}}) {
        const auto axes = import_.numbers(limit, name, place, 0);
        if (!axes)
            continue;
        for (const double axis : *axes) {
            if (!(axis == 0.0 || axis == 1.0 || axis == 2.0))
                import_.context.fail(place + "." + name, "has an axis that is not 0, 1 or 2");
            JointAxis& to = joint.axes[static_cast<size_t>(first + static_cast<int>(axis))];
            to.min = low;
            to.max = high;
            if (limit.contains("stiffness"))
                to.limitStiffness = import_.number(limit, "stiffness", place, 0.0, import_.kAny, 0.0);
            to.limitDamping = import_.number(limit, "damping", place, 0.0, import_.kAny, 0.0);
        }
    }
}

void JointReader::readDrive(const json& drive, const std::string& place, Joint& joint) {
    if (!drive.is_object())
        import_.context.fail(place, "should be an object");
    const auto type = textField(import_.context, drive, "type", place),
               mode = textField(import_.context, drive, "mode", place);
    if (!type || (*type != "linear" && *type != "angular"))
        import_.context.fail(place + ".type", "is neither linear nor angular");
    const auto axis = indexField(import_.context, drive, "axis", place, 3, "axes");
    if (!axis)
        import_.context.fail(place, "property 'axis' is missing");
    JointAxis& to = joint.axes[static_cast<size_t>(*axis + (*type == "angular" ? 3 : 0))];
    to.driven = true;
    to.acceleration = mode && *mode == "acceleration";
    to.maxForce =
        import_.number(drive, "maxForce", place, 0.0, import_.kAny, std::numeric_limits<double>::infinity());
    to.target = import_.number(drive, "positionTarget", place, -import_.kAny, import_.kAny, 0.0);
    to.targetSpeed = import_.number(drive, "velocityTarget", place, -import_.kAny, import_.kAny, 0.0);
    to.stiffness = import_.number(drive, "stiffness", place, 0.0, import_.kAny, 0.0);
    to.damping = import_.number(drive, "damping", place, 0.0, import_.kAny, 0.0);
}

/// TOUCHSTONE_joint: the setting of the session that the joint is for. Whether there is one of this name is
/// found where bodies are made.
void JointReader::readSetting(const json& ours, const std::string& place, JointSetting& setting) {
    const auto name = ours.find("setting");
    if (name == ours.end())
        return;
    if (!name->is_string() || name->get_ref<const std::string&>().empty())
        import_.context.fail(place + ".setting", "should be the name of a setting");
    setting.name = name->get<std::string>();
    setting.steps = import_.flag(ours, "press");
    if (const auto values = ours.find("values"); values != ours.end()) {
        if (!values->is_array() || values->size() < 2 || values->size() > 1024)
            import_.context.fail(place + ".values", "should be an array of 2 to 1024 values");
        for (const json& value : *values) {
            if (!value.is_string() && !value.is_number())
                import_.context.fail(place + ".values", "should hold words or numbers");
            setting.values.push_back(value.is_string() ? value.get<std::string>() : value.dump());
        }
        return;
    }
    if (setting.steps)
        import_.context.fail(place + ".press", "needs 'values' to step through");
    setting.from = import_.number(ours, "from", place, -import_.kAny, import_.kAny, 0.0);
    setting.to = import_.number(ours, "to", place, -import_.kAny, import_.kAny, 0.0);
    if (setting.from == setting.to)
        import_.context.fail(place, "has a setting, but neither 'values' nor a range 'from' .. 'to'");
}

/// TOUCHSTONE_joint: a thread, friction and detents, which the standard cannot state.
void JointReader::readOurs(const json& described, const std::string& place, Joint& joint) {
    const json* ours = extensionOf(import_.context, described, "TOUCHSTONE_joint", place);
    if (ours == nullptr)
        return;
    const std::string at = place + ".extensions.TOUCHSTONE_joint";
    if (ours->contains("pitch")) {
        joint.pitch = import_.number(*ours, "pitch", at, -import_.kAny, import_.kAny, 0.0);
        if (*joint.pitch == 0.0)
            import_.context.fail(at + ".pitch", "is 0: a thread without a way");
        if (joint.axes[0].locked() || joint.axes[3].locked())
            import_.context.fail(at + ".pitch",
                                 "needs a way along x and a turn about x, and one of them is locked");
    }
    joint.friction = import_.number(*ours, "friction", at, 0.0, import_.kAny, 0.0);
    joint.detentForce = import_.number(*ours, "detentForce", at, 0.0, import_.kAny, 0.0);
    if (const auto detents = import_.numbers(*ours, "detents", at, 0)) {
        if (detents->size() > 1024)
            import_.context.fail(at + ".detents", "has more than 1024 elements");
        if (!std::ranges::is_sorted(*detents) || std::ranges::adjacent_find(*detents) != detents->end())
            import_.context.fail(at + ".detents", "should ascend");
        joint.detents = *detents;
    }
    readSetting(*ours, at, joint.setting);
}

void JointReader::read(size_t n) {
    std::string place;
    const json* stated = import_.statedAt(n, "joint", place);
    if (stated == nullptr)
        return;
    if (import_.physics.joints.size() == kMaxBodyJoints)
        import_.context.fail(place, "is beyond the " + std::to_string(kMaxBodyJoints) +
                                        " joints that a scene can have");
    Joint joint;
    joint.name = import_.scene.nodes[n].name;
    joint.node = static_cast<int>(n);
    const auto other = indexField(import_.context, *stated, "connectedNode", place,
                                  import_.document.model.nodes.size(), "nodes");
    if (!other)
        import_.context.fail(place, "leads nowhere: property 'connectedNode' is missing");
    joint.connected = import_.forest.nodeOfGltf[static_cast<size_t>(*other)];
    joint.body = import_.bodyOf(joint.node);
    joint.connectedBody = import_.bodyOf(joint.connected);
    if (joint.body == joint.connectedBody)
        import_.context.fail(place, joint.body < 0 ? "joins two nodes that do not move"
                                                   : "joins two nodes of the same body");
    joint.collides = import_.flag(*stated, "enableCollision");
    const json* described = import_.listOf(import_.kPhysics, "physicsJoints");
    const auto index = indexField(import_.context, *stated, "joint", place,
                                  described != nullptr ? described->size() : 0, "physicsJoints");
    if (!index)
        import_.context.fail(place, "property 'joint' is missing");
    const json& description = (*described)[static_cast<size_t>(*index)];
    const std::string at =
        std::string("extensions.") + import_.kPhysics + ".physicsJoints[" + std::to_string(*index) + "]";
    if (!description.is_object())
        import_.context.fail(at, "should be an object");
    const auto each = [&](const char* name, auto&& read) {
        if (!description.contains(name))
            return;
        if (!description[name].is_array())
            import_.context.fail(at + "." + name, "should be an array");
        for (size_t i = 0; i < description[name].size(); ++i)
            read(description[name][i], at + "." + name + "[" + std::to_string(i) + "]");
    };
    each("limits", [&](const json& limit, const std::string& where) { readLimit(limit, where, joint); });
    each("drives", [&](const json& drive, const std::string& where) { readDrive(drive, where, joint); });
    readOurs(description, at, joint);
    import_.physics.joints.push_back(std::move(joint));
}

} // namespace touchstone
