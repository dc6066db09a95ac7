#pragma once
// Which haptic program has no result where it is touched, and why.

#include "haptics/program/program_fault.h"
#include "session/tick_subscriber.h"

#include <memory>

namespace touchstone {

/// Of the program that failed last in the last second, in any hand. Main thread.
class FailingProgram final : public TickSubscriber {
  public:
    void sceneOffered(const OfferedScene& scene) override { scene_ = scene; }
    void take(const TickRecord& record, const HapticSettings& settings) override;
    void flush(double now) override;

    /// Null: every program that is touched has a result.
    [[nodiscard]] const program::FeltProgram* program() const { return program_.get(); }
    /// Of `program`; empty without one.
    [[nodiscard]] const program::ProgramFault& fault() const { return fault_; }

  private:
    static constexpr double kShown = 1.0; // s

    OfferedScene scene_;
    program::ProgramEnd end_, explained_;    // of the last failure, and that of `fault_`
    double failedAt_ = -kShown, time_ = 0.0; // s, of the ticks
    std::shared_ptr<const program::FeltProgram> program_;
    program::ProgramFault fault_;
};

} // namespace touchstone
