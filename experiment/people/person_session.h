#pragma once
// One person's way through a study, kept in a file that survives a crash at any moment.

#include "experiment/plan/study_plan.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace touchstone::experiment {

struct TrialRecord {
    size_t condition = 0; ///< index into StudyPlan::conditions
    double level = 0.0;   ///< 0 where nothing is varied
    bool referenceFirst = false;
    int answer = 0; ///< 1 or 2: the interval taken for the reference
    bool right = false;
    bool reversal = false;
    double firstSeconds = 0.0, secondSeconds = 0.0; ///< for which each stimulus was there
};

struct SessionStart {
    size_t person = 0; ///< from 0; the row of the Latin square
    uint64_t seed = 0; ///< of the order of the two stimuli of each trial
    bool pilots = false;
    std::string device{};    ///< what it is felt with, for the record
    bool synchronise = true; ///< each line to the disk; false: to the system alone, for simulated people
};

/// The procedure of a person: conditions in their order, training before each, and in each a staircase or a
/// fixed number of trials. What is shown next follows from what was answered; nothing can be answered twice.
///
/// The file: one JSON object a line, the first the study and who takes it, each with a CRC-32C of itself and
/// all lines before it, each written by one call and synchronised. A crash loses at most the line that it
/// cuts off. One thread.
class PersonSession {
  public:
    /// A new file; throws Error where it exists already.
    PersonSession(const std::filesystem::path& file, const StudyPlan& plan, const SessionStart& start);
    /// Resumes. A last line that is cut off is moved to FILE.cut and named in `note`. Throws Error, and
    /// changes nothing, where the file is of another version, was edited, or is open elsewhere.
    explicit PersonSession(const std::filesystem::path& file);
    ~PersonSession();
    PersonSession(PersonSession&&) noexcept;
    PersonSession& operator=(PersonSession&&) = delete;

    /// Reads without touching the file: for reports.
    [[nodiscard]] static PersonSession read(const std::filesystem::path& file);

    [[nodiscard]] const StudyPlan& plan() const { return plan_; }
    [[nodiscard]] const SessionStart& start() const { return start_; }
    [[nodiscard]] const std::string& note() const { return note_; } ///< what reading found; empty: nothing
    [[nodiscard]] const std::vector<size_t>& order() const { return order_; }

    [[nodiscard]] bool finished() const { return place_ >= order_.size(); }
    /// The following four: not when finished.
    [[nodiscard]] size_t condition() const { return order_[place_]; }
    [[nodiscard]] bool training() const { return !trained_; }
    [[nodiscard]] double level() const;
    /// Interval 1 or 2 holds the reference.
    [[nodiscard]] bool isReference(int interval) const { return (interval == 1) == referenceFirst(); }

    /// Ends the training of this condition. Throws Error where the file cannot be written; then nothing has
    /// changed.
    void endTraining();
    /// The interval, 1 or 2, taken for the reference. Throws as endTraining.
    void answer(int interval, double firstSeconds = 0.0, double secondSeconds = 0.0);

    [[nodiscard]] const std::vector<TrialRecord>& trials() const { return trials_; }
    [[nodiscard]] size_t trialsOf(size_t condition) const;
    /// Staircases alone: none before its end, or where it ended without one.
    [[nodiscard]] std::optional<double> threshold(size_t condition) const;
    [[nodiscard]] bool done(size_t condition) const;

  private:
    PersonSession() = default;
    struct File;
    struct Progress {
        std::optional<Staircase> staircase;
        size_t trials = 0, right = 0;
    };

    void begin();
    void load(const std::filesystem::path& file, bool resume);
    void take(const nlohmann::ordered_json& line, size_t number, const std::string& name);
    void apply(int interval, double firstSeconds, double secondSeconds);
    void settle();
    void append(nlohmann::ordered_json line);
    [[nodiscard]] bool referenceFirst() const;

    StudyPlan plan_{};
    SessionStart start_;
    std::string note_{};
    std::vector<size_t> order_{};
    std::vector<Progress> progress_{}; // by condition
    std::vector<TrialRecord> trials_{};
    size_t place_ = 0;
    bool trained_ = false;
    std::unique_ptr<File> file_;
};

inline constexpr int kSessionVersion = 1;
inline constexpr const char* kSessionEnding = ".session";

/// All sessions in a folder, sorted by name; a file that cannot be read is a problem, not an end.
[[nodiscard]] std::vector<PersonSession> readSessions(const std::filesystem::path& folder,
                                                      std::vector<std::string>& problems);

} // namespace touchstone::experiment
