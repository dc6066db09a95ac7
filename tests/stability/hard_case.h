#pragma once
// One run of a hard case, and the six things that are measured in all of them: passes through, not finite,
// sticks, jitters while held, force jump in a tick, energy created over a closed path. What the geometry
// demands of each is computed from the mesh (Surface), tick by tick; the rest is allowed by nobody.
//
// Where the allowances come from. A proxy without friction is the point of free space nearest to the HIP that
// can be reached downhill. Where free space is convex that map is a projection: it never moves farther than
// the HIP does, so the force changes by at most k |move|. Only a convex edge lets the proxy go over to
// another face: the force turns by theta at depth d, a jump of 2 k d sin(theta / 2). The proxy then stands
// nearer to the HIP, so over a closed path such jumps only take energy; what a sum over ticks may seem to
// create is the error of the trapezium rule: k s^2 / 8 in a tick of length s in which a plane comes or goes
// (there the slope changes by at most k), and half the jump times s where an edge is passed. With two-pass
// shading the force stands at tau to the surface's normal, which is not the gradient of anything: along a
// path s that does work of at most k d sin(tau) s, and the force turns as the interpolated normal does.

#include "study/truth/soup.h"
#include "tests/stability/surface.h"
#include "tests/stability/trial.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace touchstone::test {

using namespace truth;

/// One measured figure and what the geometry demands of it.
struct Figure {
    double measured = 0.0, allowed = 0.0;
    [[nodiscard]] double share() const; ///< measured over allowed; infinite where nothing is allowed
};

/// The six, over a run.
struct Figures {
    Figure passes;    ///< m, how far the proxy was behind where it may be
    Figure notFinite; ///< numbers
    Figure sticks;    ///< m, how far the proxy could still have gone towards the HIP where it rested
    Figure jitter;    ///< N, largest change of force in a tick while the HIP stands still
    Figure jump;      ///< N, change of force in a tick beyond k times the HIP's motion
    Figure energy;    ///< J, work done on the hand over the closed path
    int runs = 0, ticks = 0, notConverged = 0;
    int late = 0;        ///< ticks whose solve ended at the budget of moves
    int lateInARow = 0;  ///< the longest row of those that left more than 1e-5 of the object
    double behind = 0.0; ///< m, how far they were from their rest, at most
};

/// Runs one variant of a case. Use: construct, startAt, then moveTo, hold and leave as needed; leave returns
/// along the way points and judges.
class HardCase {
  public:
    /// `name` is the row of the table.
    HardCase(std::string name, const Scene& scene, const Variant& variant);
    HardCase(std::string name, const Scene& scene, const Variant& variant, const HapticSettings& settings);

    /// How far `proxy` (m) stands on the side where it started; negative: it passed through. In closed form,
    /// so that no mesh and no solver has a say. `allowed`: m, infinite where the geometry lets it through.
    void side(std::function<double(const glm::dvec3& proxy)> outside, double allowed = 0.0);

    /// A new touch.
    void startAt(const glm::dvec3& hip);
    void moveTo(const glm::dvec3& hip, double speed); ///< m/s
    void teleportTo(const glm::dvec3& hip);           ///< in one tick
    /// Stands still: some ticks to settle, then `ticks` that are judged.
    void hold(int ticks = 60);
    /// Goes back along the way points to the start and judges. Fails the test where a figure is larger than
    /// what is allowed.
    void leave(double speed);
    /// Judges a run that does not come back; energy is left out.
    void judge();

    TouchBench bench;

    /// Takes a tick that was stepped on the bench itself.
    void take();
    /// m: the variant's, or half the weld tolerance.
    [[nodiscard]] double effectiveRadius() const;
    /// m, the longest side of the first object.
    [[nodiscard]] double unit() const;
    [[nodiscard]] const Surface& surface() const { return surface_; }
    [[nodiscard]] const Touching& touching() const { return lastTouching_; } ///< of the last tick
    [[nodiscard]] ObjectMotions motions() const;
    [[nodiscard]] const Figures& figures() const { return figures_; }

  private:
    void takeRest(const Touching& touching);
    void takeForce(const Touching& touching, double behind);
    void takeCommand();
    [[nodiscard]] glm::dvec3 oracleFrom(const HapticOutput& now);

    std::string name_;
    Variant variant_;
    Surface surface_;
    std::unique_ptr<const Soup> soup_; ///< for the oracle, made where one is needed
    std::function<double(const glm::dvec3&)> outside_;
    Figures figures_;
    std::vector<glm::dvec3> way_;
    bool first_ = true, holding_ = false;
    HapticOutput last_;
    Touching lastTouching_;
    int lateInARow_ = 0;
    double behind_ = 0.0;   ///< m, Figures::behind of the last tick
    double friction_ = 0.0; ///< m, sum of the loads of the planes at the frictionless rest
};

/// A shape with the vertex normals of a modeller's "auto smooth": at each corner the mean, by area, over the
/// triangles at that place which lie within `crease` (rad) of this one; sharper edges stay creases (DESIGN
/// §5: shading is on where the normals say that the surface is smooth and off at creases).
[[nodiscard]] assets::Shape smoothed(const assets::Shape& shape, double crease = 0.5235987755982988);
/// `shape`, smoothed where the variant is shaded.
[[nodiscard]] Scene sceneFor(const assets::Shape& shape, const Variant& variant);

} // namespace touchstone::test
