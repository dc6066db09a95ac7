#include "haptics/proxy/rising_slide.h"

#include "haptics/contact/near_contacts.h"
#include "haptics/contact/sweep.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace touchstone {

namespace {

constexpr int kLiftSteps = 5;
/// Of the contact gap: a lift that ends so near to it is on the surface.
constexpr double kOnSurface = 0.3 * kContactGap;
/// Bounds of |gradient| of a shape's distance, which is 1 but for interpolation.
constexpr double kMinSlope = 0.25, kMaxSlope = 4.0;
/// The share of the bound with which an end is accepted.
constexpr double kGainEnough = 0.5;
/// An end that cannot be reached, or gains too little, is followed by one so much nearer to the start.
constexpr double kShorter = 0.125;
/// Contacts at one place that are kept: a lift that misses one is stopped by the sweep.
constexpr size_t kContacts = 16;
/// A ramp over a bump is this much steeper than the steepest of three places before it.
constexpr double kSteeper = 2.0;

class RisingSlide {
  public:
    RisingSlide(CandidateCache& cache, const StoppedSlide& slide, SlideMemory& memory) noexcept
        : cache_(cache), slide_(slide), memory_(memory), goal_(slide.goal - slide.start) {}

    SlideUp run() noexcept {
        best_ = slide_.share * slide_.move;
        double limit = slide_.covered;
        restart();
        recall();
        while (lifts_ < slide_.lifts) {
            if (const double length = glm::length(bound_); length > limit)
                bound_ *= limit / length;
            glm::dvec3 end = bound_;
            if (!better(bound_) || !lift(end))
                break;
            const bool enough = gain(end) >= kGainEnough * gain(bound_);
            if (!enough && cut(end))
                continue;
            if (goTo(end) && enough)
                break;
            limit = kShorter * glm::length(bound_);
            restart();
        }
        return {best_, lifts_};
    }

  private:
    /// How much nearer to the goal a place is than the start: half the difference of the squared distances,
    /// in a form that does not cancel. All places are relative to the start.
    [[nodiscard]] double gain(const glm::dvec3& place) const noexcept {
        return glm::dot(place, goal_) - 0.5 * glm::dot(place, place);
    }

    [[nodiscard]] bool better(const glm::dvec3& place) const noexcept { return gain(place) > gain(best_); }

    void restart() noexcept {
        cutCount_ = std::min(slide_.planes.size(), kContacts);
        std::copy_n(slide_.planes.begin(), cutCount_, cuts_.begin());
        bound_ = slide_.move;
    }

    /// The features of the last kink, as they are seen from the start, are the first cuts.
    void recall() noexcept {
        for (const SlideMemory::Feature& known : memory_.features) {
            FeatureDistance d;
            if (known.object < 0 || !cache_.shapes().seen(known.object, known.feature, slide_.start, d))
                continue;
            const double offset = kContactGap + slide_.radius - d.distance;
            if (offset <= 0.0 && glm::dot(d.gradient, bound_) < offset)
                add({d.gradient, offset});
        }
    }

    /// False where no place is left.
    bool add(const ConstraintPlane& plane) noexcept {
        cuts_[cutCount_++] = plane;
        const SubGoal next = nearestFeasible(goal_, {cuts_.data(), cutCount_});
        bound_ = next.point;
        return next.exact;
    }

    /// Adds the plane at a lifted end and moves the bound. False where the plane excludes the start, or does
    /// not exclude the bound that was lifted: free space is not convex so far.
    bool cut(const glm::dvec3& end) noexcept {
        const ConstraintPlane plane{nearest_.normal, glm::dot(nearest_.normal, end)};
        if (plane.offset > 0.0 || glm::dot(plane.normal, bound_) >= plane.offset || cutCount_ == cuts_.size())
            return false;
        memory_.add(nearest_);
        return add(plane);
    }

    /// True where the way to the end is free and gains.
    bool goTo(const glm::dvec3& end) noexcept {
        if (!better(end))
            return false;
        bool whole = false;
        const glm::dvec3 moved = wayTo(end, whole);
        if (!better(moved))
            return false;
        best_ = moved;
        return whole;
    }

    /// The part of the chord to `end` that is free. Where a bump ends it, a ramp over the bump, and from
    /// there straight towards the goal. `whole`: the way was free up to its end.
    glm::dvec3 wayTo(const glm::dvec3& end, bool& whole) noexcept {
        double free = freePart(glm::dvec3(0.0), end);
        whole = free >= 1.0;
        const glm::dvec3 chord = free * end;
        if (whole)
            return chord;
        glm::dvec3 rise(0.0);
        for (const double part : {0.125, 0.25, 0.5})
            if (const glm::dvec3 here = firstStep(part * end) / part;
                glm::dot(here, here) > glm::dot(rise, rise))
                rise = here;
        if (rise == glm::dvec3(0.0))
            return chord;
        const glm::dvec3 ramp = end + kSteeper * rise;
        free = freePart(glm::dvec3(0.0), ramp);
        glm::dvec3 moved = free * ramp;
        if (free >= 1.0) {
            moved += freePart(moved, goal_ - moved) * (goal_ - moved);
            whole = true;
        }
        return gain(moved) > gain(chord) ? moved : chord;
    }

    /// Time of impact of a move that starts at `from`, within the ball of the candidates.
    double freePart(const glm::dvec3& from, const glm::dvec3& move) noexcept {
        const double length = glm::length(move);
        if (!(length > 0.0))
            return 0.0;
        const double covered =
            cache_.freeAlong(slide_.start + from, move / length, slide_.radius + kContactReach) / length;
        cache_.moved(); // what was measured at another place does not count at this one
        return covered > 0.0 ? timeOfImpact(cache_, slide_.start + from, move,
                                            slide_.radius + slide_.strikeGap, std::min(covered, 1.0))
                             : 0.0;
    }

    /// What is within the radius and `within` of a place.
    std::span<const Contact> contactsAt(const glm::dvec3& place, double within) noexcept {
        bool full = false;
        cache_.moved();
        return {contacts_.data(),
                findContacts(cache_, slide_.start + place, slide_.radius, within, contacts_, full)};
    }

    /// The shortest way out of what is nearer than the resting gap, to first order, that stays inside of the
    /// cuts. Zero where there is none.
    glm::dvec3 wayOut(const glm::dvec3& place, std::span<const Contact> contacts, double slope) noexcept {
        size_t count = 0;
        for (const Contact& contact : contacts)
            planes_[count++] = {contact.normal, (kContactGap - contact.gap) / slope};
        for (size_t k = 0; k < cutCount_; ++k)
            planes_[count++] = {cuts_[k].normal, cuts_[k].offset - glm::dot(cuts_[k].normal, place)};
        return nearestFeasible(glm::dvec3(0.0), {planes_.data(), count}).point;
    }
    glm::dvec3 firstStep(const glm::dvec3& place) noexcept {
        return wayOut(place, contactsAt(place, kContactReach), 1.0);
    }

    /// Newton's method: a place that is nearer than the resting gap to something goes onto the surface, one
    /// in the air stays. nearest_: what is nearest there. False where the planes leave no way out.
    bool lift(glm::dvec3& place) noexcept {
        double within = kContactReach, slope = 1.0, before = 0.0;
        glm::dvec3 step(0.0);
        ++lifts_;
        for (int i = 0; i < kLiftSteps; ++i) {
            const std::span<const Contact> contacts = contactsAt(place, within);
            if (contacts.empty())
                return true;
            const Contact& nearest =
                *std::min_element(contacts.begin(), contacts.end(),
                                  [](const Contact& a, const Contact& b) { return a.gap < b.gap; });
            nearest_ = nearest;
            const double lack = kContactGap - nearest.gap;
            if (std::abs(lack) <= kOnSurface)
                return true;
            if (const double raised = glm::dot(nearest.normal, step); raised != 0.0)
                slope = std::clamp((nearest.gap - before) / raised, kMinSlope, kMaxSlope);
            before = nearest.gap;
            step = lack > 0.0 ? wayOut(place, contacts, slope) : lack / slope * nearest.normal;
            if (step == glm::dvec3(0.0))
                return false;
            within = std::max(within, glm::length(step)); // the next step may have gone too far
            place += step;
        }
        return true; // what it lacks the sweep finds
    }

    CandidateCache& cache_;
    const StoppedSlide& slide_;
    SlideMemory& memory_;
    const glm::dvec3 goal_;
    Contact nearest_;       ///< to the place that was lifted last
    glm::dvec3 bound_{0.0}; ///< the place nearest to the goal that the cuts allow
    glm::dvec3 best_{0.0};
    int lifts_ = 0;
    size_t cutCount_ = 0;
    std::array<ConstraintPlane, kContacts + SlideMemory::kFeatures + kMostLifts> cuts_;
    std::array<ConstraintPlane, kContacts + std::tuple_size_v<decltype(cuts_)>> planes_;
    std::array<Contact, kContacts> contacts_;
};

} // namespace

SlideUp alongRisingSurface(CandidateCache& cache, const StoppedSlide& slide, SlideMemory& memory) noexcept {
    return RisingSlide(cache, slide, memory).run();
}

} // namespace touchstone
