#include "haptics/body/contact_finder.h"

#include "haptics/body/bullet_colliders.h"

#include <algorithm>
#include <cmath>

namespace touchstone::body {

namespace {

/// m: room for what a hand adds to a body's speed until the next contacts come.
constexpr double kLeastReach = 2e-3;

} // namespace

btTransform ContactFinder::Bullet::transform(const FinderInput& input, const ColliderForm& form) const {
    Pose at = form.bodyFromCollider;
    if (form.body >= 0) {
        const Pose& body = input.bodies[static_cast<size_t>(form.body)].pose;
        at = {body.rotation * at.rotation, body.point(at.position)};
    }
    return btTransform(bulletRotation(at.rotation), bulletVector(at.position, unit));
}

/// True where the collision filters let them meet.
bool ContactFinder::Bullet::collide(const ColliderForm& a, const ColliderForm& b) const {
    const auto meets = [](const ColliderForm& one, const ColliderForm& other) {
        if (other.collides && (one.systems == 0 || (one.systems & ~*other.collides) != 0))
            return false;
        return !(other.collidesNot && one.systems != 0 && (one.systems & ~*other.collidesNot) == 0);
    };
    if (!meets(a, b) || !meets(b, a))
        return false;
    return !std::ranges::binary_search(
        apart, std::pair<int, int>(std::min(a.body, b.body), std::max(a.body, b.body)));
}

ContactFinder::ContactFinder(std::vector<ColliderForm> forms, std::vector<std::pair<int, int>> apart)
    : bullet_(std::make_unique<Bullet>()) {
    bullet_->forms = std::move(forms);
    std::ranges::sort(apart);
    bullet_->apart = std::move(apart);
    double smallest = INFINITY;
    for (const ColliderForm& form : bullet_->forms)
        if (form.body >= 0) {
            double size = std::max({form.size.x, form.size.y, form.size.z});
            if (form.shape != ColliderShape::Box)
                size = 2.0 * std::max(form.radius, form.top);
            if (form.shape == ColliderShape::Hull || form.shape == ColliderShape::Mesh) {
                size = 0.0;
                for (const glm::vec3& p : form.points)
                    size = std::max(size, 2.0 * static_cast<double>(glm::length(p)));
            }
            if (size > 0.0)
                smallest = std::min(smallest, size);
        }
    bullet_->unit = std::isfinite(smallest) ? static_cast<float>(2.0 / smallest) : 1.0f;
    bullet_->made.resize(bullet_->forms.size());
    for (size_t i = 0; i < bullet_->forms.size(); ++i)
        bullet_->make(bullet_->forms[i], bullet_->made[i]);
}

ContactFinder::~ContactFinder() = default;

const std::vector<ColliderForm>& ContactFinder::forms() const {
    return bullet_->forms;
}

void ContactFinder::find(const FinderInput& input, double ahead, FinderOutput& output) {
    output.tick = input.tick;
    output.count = 0;
    output.full = false;
    const std::vector<ColliderForm>& forms = bullet_->forms;
    struct Box {
        btVector3 low, high;
    };
    std::vector<Box> boxes(forms.size());
    std::vector<double> reach(forms.size());
    for (size_t i = 0; i < forms.size(); ++i) {
        bullet_->made[i].shape->getAabb(bullet_->transform(input, forms[i]), boxes[i].low, boxes[i].high);
        // The way until the next contacts come, and room for what a hand adds to it.
        if (forms[i].body >= 0) {
            const FinderInput::Entry& body = input.bodies[static_cast<size_t>(forms[i].body)];
            reach[i] = ahead * (glm::length(body.velocity) + body.turning) + kLeastReach;
        }
        const auto room = static_cast<float>(reach[i]) * bullet_->unit;
        boxes[i].low -= btVector3(room, room, room);
        boxes[i].high += btVector3(room, room, room);
    }
    for (size_t b = 0; b < input.bodies.size(); ++b) {
        const FinderInput::Entry& body = input.bodies[b];
        output.rooms[b] = {body.pose.position,
                           body.awake ? ahead * (glm::length(body.velocity) + body.turning) + kLeastReach
                                      : 0.0};
    }
    const auto awake = [&](size_t i) {
        return forms[i].body >= 0 && input.bodies[static_cast<size_t>(forms[i].body)].awake;
    };
    const auto meet = [&](size_t i, size_t j) {
        return boxes[i].low.x() <= boxes[j].high.x() && boxes[j].low.x() <= boxes[i].high.x() &&
               boxes[i].low.y() <= boxes[j].high.y() && boxes[j].low.y() <= boxes[i].high.y() &&
               boxes[i].low.z() <= boxes[j].high.z() && boxes[j].low.z() <= boxes[i].high.z();
    };
    // In the order of their numbers, so that the contacts are in the order of their pairs.
    for (size_t i = 0; i < forms.size(); ++i) {
        if (forms[i].body < 0 || bullet_->made[i].convex == nullptr)
            continue;
        for (size_t j = 0; j < forms.size(); ++j) {
            if (j == i || forms[j].body == forms[i].body || !meet(i, j))
                continue;
            const bool both = forms[j].body >= 0 && bullet_->made[j].convex != nullptr;
            if ((both && j < i) || !(awake(i) || awake(j)) || !bullet_->collide(forms[i], forms[j]))
                continue;
            bullet_->pair(input, i, j, reach[i] + reach[j], output);
        }
    }
}

} // namespace touchstone::body
