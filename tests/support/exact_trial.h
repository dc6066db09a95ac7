#pragma once
// Follows a hand tick by tick and measures how exact the proxy is: against the oracle from our own last
// place, against an oracle that runs free from the same start, and by invariants that need no second solver.

#include "study/truth/oracle.h"
#include "study/truth/soup.h"
#include "tests/support/touch_bench.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace touchstone::test {

using namespace truth;

/// All lengths in metres of the fitted workspace (the model's longest side is kFittedExtent), so that scenes
/// of any scale compare.
struct ExactFigures {
    std::string name;
    int ticks = 0;      ///< with the proxy placed
    int touching = 0;   ///< of these, in contact
    int compared = 0;   ///< with the oracle, from our own last place
    int unfinished = 0; ///< stopped at the move budget: checked as anytime, not as rests
    int moves = 0;      ///< most in one tick
    int apart = 0;      ///< compared ticks that ended at another rest than the oracle
    int partings = 0;   ///< times that the free-running trajectories parted beyond the tolerance
    int partedTicks = 0;
    long double error = 0.0L;      ///< worst of the compared that ended at the same rest
    long double relative = 0.0L;   ///< the same in diagonals of the smallest object
    long double cone = 0.0L;       ///< worst distance of HIP - proxy from the cone of inward normals
    long double shortfall = -1.0L; ///< worst of radius minus distance, proxy and whole path; <= 0 is free
    long double retreat = 0.0L;    ///< most that any move went away from the HIP
    long double oracleCone = 0.0L, oracleShortfall = -1.0L; ///< of the oracle's ends where the two parted
    std::vector<std::string> divergences;                   ///< one line each
    std::vector<std::string> faults;                        ///< what may not be, with the tick
};

/// A compiled scene and the oracle's triangles in the frames of its objects, for any number of trials.
class ExactScene {
  public:
    ExactScene(const Scene& scene, Fit fit);

    [[nodiscard]] const std::shared_ptr<const HapticScene>& haptic() const { return haptic_; }
    /// Workspace m per m of the fitted workspace.
    [[nodiscard]] double workspacePerFitted() const { return workspacePerFitted_; }
    /// The triangles in the frame of an object.
    [[nodiscard]] const Soup& soup(int frame);

  private:
    std::shared_ptr<const HapticScene> haptic_;
    double workspacePerFitted_ = 1.0;
    std::map<int, std::unique_ptr<Soup>> soups_;
};

struct ExactOptions {
    double radius = 0.0; ///< m in the fitted workspace
    bool freeRunning = true;
};

class ExactTrial {
  public:
    /// `scene` outlives it.
    ExactTrial(std::string name, ExactScene& scene, const ExactOptions& options);

    /// One tick with the HIP at a place of the workspace. `compare`: with the oracle too.
    void tick(const glm::dvec3& hip, bool compare = true);
    /// The hand is taken away; the next tick starts touch anew.
    void forget();

    [[nodiscard]] const ExactFigures& figures() const { return figures_; }
    [[nodiscard]] bool placed() const { return bench_.state[0].placed; }

  private:
    struct Frame {
        const Soup* soup = nullptr;
        LVec3 goal{0.0L};
        long double radius = 0.0L;
        long double unit = 0.0L;      ///< fitted m per unit of the frame
        long double aim = 0.0L;       ///< units that double may lose of the goal's place
        long double placing = 0.0L;   ///< the same of objects against each other
        long double tolerance = 0.0L; ///< units
    };
    Frame frame();
    std::vector<glm::dvec3> replay(const glm::dvec3& hip);
    long double wayClearance(const Frame& f, const LVec3& from, const LVec3& to) const;
    void checkPath(const Frame& f, const std::vector<glm::dvec3>& places);
    long double coneResidual(const Frame& f, const LVec3& proxy) const;
    void checkHeld(const Frame& f, const LVec3& ours);
    void compareRestarted(const Frame& f, const LVec3& before);
    void compareFree(const Frame& f);
    void closeParting();
    void fault(const std::string& what);

    ExactFigures figures_;
    ExactScene& scene_;
    ExactOptions options_;
    TouchBench bench_, behind_;     ///< behind_ replays each tick in parts (replay)
    double smallestDiagonal_ = 0.0; ///< workspace m
    std::vector<DeviceState> saved_;
    bool finished_ = true;
    std::optional<LVec3> free_; ///< where the free-running oracle stands, reference object frame
    struct Parting {
        int start = 0, ticks = 0;
        long double first = 0.0L, most = 0.0L, ours = 0.0L, oracles = 0.0L;
        bool unfinished = false;
    };
    std::optional<Parting> parting_;
};

/// Sums and worsts of several.
[[nodiscard]] ExactFigures together(const std::string& name, const std::vector<ExactFigures>& all);

/// The table's head and a line of it, as the tests print them and docs/architecture.md quotes them.
[[nodiscard]] std::string exactHead();
[[nodiscard]] std::string exactLine(const ExactFigures& figures);

} // namespace touchstone::test
