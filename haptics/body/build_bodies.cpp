// From the file's bodies to those of the workspace.

#include "engine/math/nearest_similarity.h"
#include "engine/scene/animation.h"
#include "haptics/body/body_world.h"
#include "haptics/body/joint_settings.h"
#include "haptics/body/mass_properties.h"

#include <algorithm>
#include <cmath>

namespace touchstone::body {

/// Builds a BodyWorld: step by step, each of which reads what the ones before have made.
class BodyBuilder {
  public:
    BodyBuilder(const Scene& scene, const HapticScene& haptic, std::vector<Warning>* warnings)
        : scene_(scene), haptic_(haptic),
          objects_(haptic.wholeObjects.empty() ? haptic.objects : haptic.wholeObjects),
          physics_(*scene.physics), warnings_(warnings), sceneFromNode_(sceneFromNodes(scene.nodes)),
          scale_(haptic.workspaceFromScene.scale) {}

    std::shared_ptr<BodyWorld> build();

  private:
    [[nodiscard]] glm::dmat4 workspaceFromNode(int node) const {
        return matrixOf(haptic_.workspaceFromScene) * sceneFromNode_[static_cast<size_t>(node)];
    }
    [[nodiscard]] Similarity poseOfNode(int node) const {
        Similarity pose;
        (void)nearestSimilarity(workspaceFromNode(node), pose);
        return pose;
    }
    void warn(const std::string& place, const std::string& message) const {
        if (warnings_ != nullptr)
            warnings_->push_back({place, message});
    }
    void findNodes();
    void readColliders();
    [[nodiscard]] VolumeMoments momentsOfBody(size_t b) const;
    void readBody(size_t b);
    void readObjects();
    void placeColliders();
    std::vector<BodyJoint> joints();

    const Scene& scene_;
    const HapticScene& haptic_;
    const std::vector<std::shared_ptr<const HapticObject>>& objects_; ///< of the whole scene
    const Physics& physics_;
    std::vector<Warning>* warnings_;
    std::vector<glm::dmat4> sceneFromNode_;
    double scale_;
    std::shared_ptr<BodyWorld> world_;
    std::vector<int> bodyOfNode_;
    std::vector<ColliderForm> forms_;              ///< `bodyFromCollider` is in the workspace until placed
    std::vector<std::vector<uint32_t>> triangles_; ///< of each form
};

void BodyBuilder::findNodes() {
    bodyOfNode_.assign(scene_.nodes.size(), -1);
    std::vector<int> own(scene_.nodes.size(), -1);
    for (size_t b = 0; b < physics_.bodies.size(); ++b)
        own[static_cast<size_t>(physics_.bodies[b].node)] = static_cast<int>(b);
    for (size_t n = 0; n < scene_.nodes.size(); ++n) {
        const int parent = scene_.nodes[n].parent;
        bodyOfNode_[n] = own[n] >= 0 ? own[n] : parent >= 0 ? bodyOfNode_[static_cast<size_t>(parent)] : -1;
    }
}

/// Colliders as they stand in the workspace.
void BodyBuilder::readColliders() {
    for (const Collider& collider : physics_.colliders) {
        const glm::dmat4 matrix = workspaceFromNode(collider.node);
        const Similarity pose = poseOfNode(collider.node);
        const glm::dvec3 scales(glm::length(glm::dvec3(matrix[0])), glm::length(glm::dvec3(matrix[1])),
                                glm::length(glm::dvec3(matrix[2])));
        ColliderForm form;
        form.body = collider.body;
        form.shape = collider.shape;
        form.bodyFromCollider = {pose.rotation, glm::dvec3(matrix[3])};
        form.size = collider.size * scales;
        const double across = std::max(scales.x, scales.z);
        form.radius =
            collider.radius *
            (collider.shape == ColliderShape::Sphere ? std::max({scales.x, scales.y, scales.z}) : across);
        form.top = collider.top * across;
        form.height = collider.height * scales.y;
        std::vector<uint32_t> triangles;
        if (!collider.meshes.empty()) {
            std::vector<glm::dvec3> points;
            for (const int m : collider.meshes) {
                const Mesh& mesh = scene_.meshes[static_cast<size_t>(m)];
                const auto first = static_cast<uint32_t>(points.size());
                for (const glm::vec3& p : mesh.positions)
                    points.emplace_back(matrix * glm::dvec4(glm::dvec3(p), 1.0));
                for (const uint32_t index : mesh.indices)
                    triangles.push_back(first + index);
            }
            if (glm::determinant(glm::dmat3(matrix)) < 0.0)
                for (size_t i = 0; i + 2 < triangles.size(); i += 3)
                    std::swap(triangles[i], triangles[i + 1]);
            Bounds bounds;
            for (const uint32_t index : triangles)
                bounds.include(points[index]);
            form.bodyFromCollider.position = bounds.centre();
            for (const glm::dvec3& p : points)
                form.points.emplace_back(form.bodyFromCollider.inversePoint(p));
            if (form.shape == ColliderShape::Mesh)
                form.indices = triangles;
        }
        if (collider.material >= 0) {
            const PhysicsMaterial& material = physics_.materials[static_cast<size_t>(collider.material)];
            form.staticFriction = material.staticFriction;
            form.dynamicFriction = material.dynamicFriction;
            form.restitution = material.restitution;
            form.frictionCombine = material.frictionCombine;
            form.restitutionCombine = material.restitutionCombine;
        }
        form.systems = collider.systems;
        form.collides = collider.collides;
        form.collidesNot = collider.collidesNot;
        forms_.push_back(std::move(form));
        triangles_.push_back(std::move(triangles));
    }
}

/// Of its colliders; without any, of what is felt of it.
VolumeMoments BodyBuilder::momentsOfBody(size_t b) const {
    VolumeMoments moments;
    for (size_t i = 0; i < forms_.size(); ++i)
        if (forms_[i].body == static_cast<int>(b))
            moments += momentsOf(forms_[i], triangles_[i]).in(forms_[i].bodyFromCollider);
    if (moments.volume > 0.0)
        return moments;
    for (const auto& object : objects_) {
        if (object->instance < 0 || object->empty() || object->shape != nullptr)
            continue;
        const Instance& instance = scene_.instances[static_cast<size_t>(object->instance)];
        if (instance.node < 0 || bodyOfNode_[static_cast<size_t>(instance.node)] != static_cast<int>(b))
            continue;
        ColliderForm form;
        form.shape = ColliderShape::Hull;
        const Similarity& at = object->workspaceFromObject;
        for (size_t i = 0; i + 1 < object->vertices.size(); ++i)
            form.points.emplace_back(at.scale * glm::dvec3(object->vertices[i]));
        moments += momentsOf(form, object->indices).in({at.rotation, at.translation});
    }
    return moments;
}

/// Mass, centre and principal axes.
void BodyBuilder::readBody(size_t b) {
    constexpr double kWater = 1000.0; // kg/m^3
    const Body& stated = physics_.bodies[b];
    const Similarity node = poseOfNode(stated.node);
    VolumeMoments moments = momentsOfBody(b);
    BodyMass mass;
    BodyState state;
    mass.gravityFactor = stated.gravityFactor;
    mass.drag = stated.drag;
    if (!(moments.volume > 0.0)) {
        if (!stated.kinematic && !(stated.mass && stated.inertia))
            warn("physics", "body '" + stated.name + "' has no volume: a ball of 1 cm stands for it");
        const double r = 0.01;
        moments = VolumeMoments{4.0 / 3.0 * M_PI * r * r * r, {}, glm::dmat3(1.0)};
        moments.second *= moments.volume * r * r / 5.0;
        moments = moments.in({node.rotation, node.translation});
    }
    const double kilograms = stated.mass.value_or(moments.volume / (scale_ * scale_ * scale_) * kWater);
    glm::dvec3 centre = moments.first / moments.volume;
    glm::dmat3 inertia = inertiaOf(moments) * (kilograms / moments.volume);
    if (stated.centreStated) {
        const glm::dvec3 at = node.point(stated.centreOfMass), way = at - centre;
        inertia += kilograms * (glm::dot(way, way) * glm::dmat3(1.0) - glm::outerProduct(way, way));
        centre = at;
    }
    const PrincipalAxes axes = principalAxes(inertia);
    state.pose = {axes.rotation, centre};
    mass.inertia = axes.values;
    if (stated.inertia) {
        state.pose.rotation = glm::normalize(node.rotation * stated.inertiaOrientation);
        mass.inertia = *stated.inertia * (node.scale * node.scale);
    }
    state.published = state.pose;
    if (!stated.kinematic) {
        mass.inverse = 1.0 / kilograms;
        for (int i = 0; i < 3; ++i)
            mass.inverseInertia[i] = mass.inertia[i] > 0.0 ? 1.0 / mass.inertia[i] : 0.0;
    } else {
        mass.inertia = glm::dvec3(0.0);
    }
    // Of a ball of the same inertia, where nothing of it is felt and nothing collides.
    const double largest = std::max({mass.inertia.x, mass.inertia.y, mass.inertia.z});
    mass.radius = std::sqrt(2.5 * largest * mass.inverse);
    state.velocity = node.vector(stated.velocity);
    state.spin = node.direction(stated.spin);
    const glm::dvec3 numbers = mass.inertia + mass.inverseInertia;
    if (!isSound(state) || !std::isfinite(numbers.x + numbers.y + numbers.z + mass.inverse + mass.radius)) {
        warn("physics", "body '" + stated.name +
                            "' is too small, too large or too flat to be moved: it stays where it is");
        mass = {};
        state = {};
        if (const glm::dvec3& at = node.translation; std::isfinite(at.x + at.y + at.z))
            state.pose.position = state.published.position = at;
    }
    world_->names_.push_back(stated.name);
    world_->masses_.push_back(mass);
    world_->states_.push_back(state);
}

void BodyBuilder::readObjects() {
    BodyWorld& world = *world_;
    world.bodyOfObject_.assign(objects_.size(), -1);
    for (size_t b = 0; b < world.states_.size(); ++b) {
        world.firstObject_.push_back(static_cast<uint32_t>(world.objects_.size()));
        for (size_t k = 0; k < objects_.size(); ++k) {
            const HapticObject& object = *objects_[k];
            if (object.instance < 0)
                continue;
            const Instance& instance = scene_.instances[static_cast<size_t>(object.instance)];
            if (!instance.followsNode || instance.node < 0 ||
                bodyOfNode_[static_cast<size_t>(instance.node)] != static_cast<int>(b))
                continue;
            const Similarity inBody =
                world.states_[b].pose.similarity().inverseTimes(object.workspaceFromObject);
            world.bodyOfObject_[k] = static_cast<int>(b);
            world.objects_.push_back({k, static_cast<int>(b), inBody});
            world.masses_[b].radius =
                std::max(world.masses_[b].radius,
                         glm::length(inBody.translation) + inBody.scale * object.boundingRadius);
        }
    }
    world.firstObject_.push_back(static_cast<uint32_t>(world.objects_.size()));
}

void BodyBuilder::placeColliders() {
    for (ColliderForm& form : forms_) {
        if (form.body < 0)
            continue;
        const auto b = static_cast<size_t>(form.body);
        const Pose body = world_->states_[b].pose;
        form.bodyFromCollider = {
            glm::normalize(glm::conjugate(body.rotation) * form.bodyFromCollider.rotation),
            body.inversePoint(form.bodyFromCollider.position)};
        const double away = glm::length(form.bodyFromCollider.position);
        form.round = form.shape == ColliderShape::Sphere && away < 1e-6 * form.radius;
        double radius = form.shape == ColliderShape::Box ? 0.5 * glm::length(form.size)
                        : form.shape == ColliderShape::Sphere
                            ? form.radius
                            : 0.5 * form.height + std::max(form.radius, form.top);
        if (!form.points.empty()) {
            radius = 0.0;
            for (const glm::vec3& p : form.points)
                radius = std::max(radius, static_cast<double>(glm::length(p)));
        }
        world_->masses_[b].radius = std::max(world_->masses_[b].radius, away + radius);
    }
}

std::vector<BodyJoint> BodyBuilder::joints() {
    std::vector<BodyJoint> joints;
    for (const Joint& stated : physics_.joints) {
        BodyJoint joint;
        joint.a = stated.body;
        joint.b = stated.connectedBody;
        const auto frame = [&](int node, int body) {
            const Similarity at = poseOfNode(node);
            const Pose pose{at.rotation, at.translation};
            if (body < 0)
                return pose;
            const Pose own = world_->states_[static_cast<size_t>(body)].pose;
            return Pose{glm::normalize(glm::conjugate(own.rotation) * pose.rotation),
                        own.inversePoint(pose.position)};
        };
        joint.inA = frame(stated.node, joint.a);
        joint.inB = frame(stated.connected, joint.b);
        joint.axes = stated.axes;
        const double length = scale_, torque = scale_ * scale_;
        for (size_t i = 0; i < 6; ++i) {
            JointAxis& axis = joint.axes[i];
            if (i < 3) {
                for (double* value : {&axis.min, &axis.max, &axis.target, &axis.targetSpeed, &axis.maxForce})
                    *value *= length;
                continue;
            }
            for (double* value : {&axis.limitStiffness, &axis.limitDamping, &axis.maxForce})
                *value *= torque;
            if (!axis.acceleration)
                axis.stiffness *= torque, axis.damping *= torque;
        }
        for (int pass = 0; pass < 2 && joint.freeAxis < 0; ++pass)
            for (size_t i = 0; i < 6 && joint.freeAxis < 0; ++i)
                if (!joint.axes[i].locked() && (pass == 1 || joint.axes[i].limited() || joint.axes[i].driven))
                    joint.freeAxis = static_cast<int>(i);
        const double unit = joint.freeAxis >= 3 ? torque : length;
        joint.friction = stated.friction * unit;
        joint.detentForce = stated.detentForce * unit;
        joint.detents = stated.detents;
        if (!stated.setting.name.empty()) {
            const std::string problem = settingProblem(stated.setting);
            if (problem.empty())
                joint.setting = stated.setting;
            else
                warn("joint '" + stated.name + "'", "sets nothing: " + problem);
        }
        if (joint.freeAxis < 3)
            for (double& place : joint.detents)
                place *= length;
        joint.pitch = stated.pitch.value_or(0.0) * length;
        const JointReading now = BodySolver::reading(joint, world_->states_);
        for (size_t i = 0; i < 3; ++i)
            joint.lastAngle[i] = now.position[3 + i];
        joints.push_back(std::move(joint));
    }
    return joints;
}

std::shared_ptr<BodyWorld> BodyBuilder::build() {
    world_ = std::shared_ptr<BodyWorld>(new BodyWorld);
    world_->scale_ = scale_;
    findNodes();
    readColliders();
    for (size_t b = 0; b < physics_.bodies.size(); ++b)
        readBody(b);
    readObjects();
    placeColliders();
    std::vector<std::pair<int, int>> apart;
    for (const Joint& joint : physics_.joints)
        if (!joint.collides)
            apart.push_back(std::minmax(joint.body, joint.connectedBody));
    std::vector<BodyJoint> made = joints();
    const size_t contacts = std::min<size_t>(2048, 24 * physics_.bodies.size());
    world_->solver_ = std::make_unique<BodySolver>(physics_.bodies.size(), contacts, std::move(made));
    world_->finder_ = std::make_shared<ContactFinder>(std::move(forms_), std::move(apart));
    if (const Animation* played = playedAnimation(scene_)) {
        const std::vector<bool> moved = movedNodes(scene_, *played);
        for (size_t b = 0; b < physics_.bodies.size(); ++b)
            if (physics_.bodies[b].kinematic && moved[static_cast<size_t>(physics_.bodies[b].node)])
                world_->followers_.push_back(static_cast<int>(b));
    }
    world_->finish();
    return world_;
}

std::shared_ptr<BodyWorld> BodyWorld::make(const Scene& scene, const HapticScene& haptic,
                                           std::vector<Warning>* warnings) {
    if (scene.physics == nullptr || haptic.objects.empty())
        return nullptr;
    return BodyBuilder(scene, haptic, warnings).build();
}

} // namespace touchstone::body
