#pragma once

#include <atomic>
#include <memory>
#include <utility>

namespace touchstone {

/// Hands an immutable object to the servo at a tick boundary and takes the old one back, so that the servo
/// never allocates or frees. The owner offers; the servo adopts; the owner collects what the servo has
/// released. One owner thread, one servo thread.
template <class T>
class Handover {
  public:
    /// Owner thread. Replaces an offer that was not yet adopted. Keeps `object` alive until collected.
    void offer(std::shared_ptr<const T> object) {
        collect();
        Holder* holder = new Holder{std::move(object)};
        delete offered_.exchange(holder, std::memory_order_acq_rel);
    }

    /// Servo thread, at a tick boundary. Returns the object to use from now on; null until the first offer.
    /// While the owner has not collected the previous object, a new offer waits for the next tick.
    const T* adopt() noexcept {
        return adopt([](const T*) { return true; });
    }
    /// The same; what was taken stays aside for as long as `ready(object)` is false, and newer offers wait
    /// behind it. Called once a tick at most; must not throw.
    template <class Ready>
    const T* adopt(Ready&& ready) noexcept {
        if (aside_ == nullptr && offered_.load(std::memory_order_relaxed) != nullptr &&
            released_.load(std::memory_order_acquire) == nullptr)
            aside_ = offered_.exchange(nullptr, std::memory_order_acq_rel);
        if (aside_ != nullptr && ready(static_cast<const T*>(aside_->object.get()))) {
            released_.store(current_, std::memory_order_release);
            current_ = std::exchange(aside_, nullptr);
        }
        return current_ != nullptr ? current_->object.get() : nullptr;
    }

    /// Owner thread: frees what the servo no longer uses.
    void collect() { delete released_.exchange(nullptr, std::memory_order_acq_rel); }

    /// Any thread: true while an offer waits to be taken.
    [[nodiscard]] bool pending() const noexcept {
        return offered_.load(std::memory_order_acquire) != nullptr;
    }

    Handover() = default;
    Handover(const Handover&) = delete;
    Handover& operator=(const Handover&) = delete;
    /// After the servo thread has been joined.
    ~Handover() {
        delete offered_.load();
        delete released_.load();
        delete aside_;
        delete current_;
    }

  private:
    struct Holder {
        std::shared_ptr<const T> object;
    };
    std::atomic<Holder*> offered_{nullptr};
    std::atomic<Holder*> released_{nullptr};
    Holder *current_ = nullptr, *aside_ = nullptr; // servo thread; aside: taken, not adopted yet
};

} // namespace touchstone
