#pragma once

#include "engine/exchange/triple_buffer.h"
#include "haptics/body/contact_finder.h"

#include <atomic>
#include <memory>
#include <thread>

namespace touchstone::body {

/// Finds contacts apart from the servo, 240 times a second and more where it can: takes the newest poses and
/// gives their contacts, through triple buffers. It sleeps while no poses come.
class FinderThread {
  public:
    FinderThread(std::shared_ptr<ContactFinder> finder, const FinderInput& input, const FinderOutput& output);
    ~FinderThread();
    FinderThread(const FinderThread&) = delete;
    FinderThread& operator=(const FinderThread&) = delete;

    /// Servo: wait-free.
    void give(const FinderInput& input) noexcept { input_.write(input); }
    /// Servo: true where `output` has contacts newer than at the last call.
    [[nodiscard]] bool take() noexcept { return output_.update(); }
    [[nodiscard]] const FinderOutput& output() const noexcept { return output_.value(); }
    [[nodiscard]] uint64_t rounds() const noexcept { return rounds_.load(std::memory_order_relaxed); }

    /// s: how far ahead contacts are looked for, more than the age that results have.
    static constexpr double kAhead = 8e-3;

  private:
    void run();

    std::shared_ptr<ContactFinder> finder_;
    TripleBuffer<FinderInput> input_;
    TripleBuffer<FinderOutput> output_;
    FinderOutput found_;
    std::atomic<bool> stopping_{false};
    std::atomic<uint64_t> rounds_{0};
    std::thread thread_;
};

} // namespace touchstone::body
