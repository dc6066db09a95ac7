#pragma once
// Sculpts the fields that a servo's hands touch: a worker applies what they make and publishes new fields.

#include "haptics/scene/scene_sculptor.h"
#include "haptics/servo/servo_loop.h"

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace touchstone {

/// A scene that the worker published.
struct SculptedScene {
    uint32_t number = 0, root = 0; ///< TickRecord::scene and ::root
    std::shared_ptr<const HapticScene> haptic;
    ScenePtr source;
    uint64_t hash = 0;                  ///< SceneSculptor::hash
    std::vector<SculptEntry> entries{}; ///< since the root's last one; all of them with a new root
    struct Field {
        int object = 0; ///< HapticScene::objects
        std::vector<uint32_t>
            bricks{}; ///< FieldGrid::brickNumber, that differ from the scene published before
    };
    std::vector<Field> changed{};
};

struct SculptFigures {
    size_t undoSteps = 0, redoSteps = 0;
    uint64_t dabs = 0, scenes = 0; ///< applied, published
    uint64_t thinned = 0;          ///< dabs left out, since the worker had fallen behind
    double removed = 0.0;          ///< m^3, scene frame; negative where the solid grew
    double longestDab = 0.0;       ///< s
    uint64_t memory = 0;           ///< bytes of edited bricks and their history
    uint64_t hash = 0;             ///< of the fields; 0: nothing was sculpted
    std::string problem;           ///< the last edit that was refused
};

/// The servo writes dabs into a ring; a thread of this class pops them, applies them to copy-on-write bricks
/// and offers the scene with the new field, at least every kPublish while edits come. What the hand makes
/// while distances are restored is felt at once as a preview, and made after the restoration. Functions
/// without a note: the servo's owner thread. The worker has no thread until the first tool is active.
class LiveSculptor {
  public:
    static constexpr double kPublish = 0.004; ///< s of dabs in one publication, and one dab more
    /// Dabs that wait: more are thinned out, to a longer distance along the way.
    static constexpr size_t kMostWaiting = 2;
    /// A dab that takes longer is published twice: its shape, and then its distances (SculptEntryKind).
    static constexpr double kWhole = 0.002; // s
    static constexpr int kMostShapes = 6;   ///< before their distances are restored
    /// Entries that are felt while distances are restored, and made afterwards: more of them wait.
    static constexpr size_t kMostPreviews = 6;

    explicit LiveSculptor(ServoLoop& servo) : servo_(servo) {}
    ~LiveSculptor();
    LiveSculptor(const LiveSculptor&) = delete;
    LiveSculptor& operator=(const LiveSculptor&) = delete;

    /// The scene that the servo was offered under `number`: nothing is sculpted in it.
    void begin(uint32_t number, std::shared_ptr<const HapticScene> scene, ScenePtr source);
    /// Another scene of the same objects: the servo is offered it with the sculpted fields (offerSculpted).
    /// Null where nothing is sculpted: the caller offers it as it is. Waits for a dab, and for those that are
    /// felt as previews, with their restorations. Returns the number of the root.
    [[nodiscard]] std::optional<uint32_t> carryOver(std::shared_ptr<const HapticScene> scene, ScenePtr source,
                                                    SceneSwap swap);

    /// From the next tick on.
    void setTool(const LiveTool& tool);
    [[nodiscard]] const LiveTool& tool() const { return tool_; }
    void undo() { command(SculptEntryKind::Undo); }
    void redo() { command(SculptEntryKind::Redo); }
    /// Another thread's edits, as those of the hands: tests and scripts.
    void add(const SculptEntry& entry);

    /// What was published since the last call, in order.
    [[nodiscard]] std::vector<SculptedScene> take();
    [[nodiscard]] SculptFigures figures() const;
    /// Waits until everything that was made is published, for as long as the servo makes nothing.
    void drain();

  private:
    void command(SculptEntryKind kind);
    void startWorker();
    void work();
    void gather();
    [[nodiscard]] std::optional<SculptEntry> next();
    SculptEntry takeFront(); // mutex_ is held
    [[nodiscard]] std::optional<SculptEntry> nextBeside();
    [[nodiscard]] std::optional<SculptEntry> nextPreview(int32_t object);
    void applyWaiting();
    void previewWaiting(int32_t object);
    [[nodiscard]] int makePreviewed();
    void noteOffered();
    void publish();
    void apply(const SculptEntry& entry, bool felt = false);
    [[nodiscard]] ReshapedScene published(bool whole);
    [[nodiscard]] std::unique_lock<std::mutex> stopApplying();

    ServoLoop& servo_;
    LiveTool tool_;
    std::thread worker_;

    mutable std::mutex
        mutex_; // of what follows, and of the reader's side of the servo's ring; never held for long
    std::condition_variable wake_, idle_;
    bool stopping_ = false, active_ = false, busy_ = false;
    std::deque<SculptEntry> waiting_;
    size_t previewed_ = 0;    // of them, the first ones: they are felt already
    uint32_t oldestRoot_ = 0; // the first with these objects: edits of scenes before it are not for them
    std::vector<SculptedScene> published_;
    SculptFigures figures_;

    std::mutex applying_; // of what follows: held while entries are applied; before mutex_ where both are
    std::atomic<bool> wanted_{false}; // by the owner
    std::optional<SceneSculptor> sculptor_;
    ScenePtr source_;
    uint32_t root_ = 0;
    std::vector<SculptEntry> journal_; // of the root
    size_t sent_ = 0;                  // entries of it that were published
    // Ticks of the oldest edits; 0: none.
    uint64_t made_ = 0, offered_ = 0; // not offered yet; in the last offer
    uint64_t memory_ = 0;
    double memoryAt_ = -1.0;  // s
    double restoring_ = 0.0;  // s, of the last dab or restoration
    double previewing_ = 0.0; // s, of all previews
};

} // namespace touchstone
