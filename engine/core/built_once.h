#pragma once

#include <atomic>
#include <memory>
#include <mutex>

namespace touchstone {

/// An object built once, on first use, possibly while a servo is running.
template <class T>
class BuiltOnce {
  public:
    /// Null until built. Wait-free.
    [[nodiscard]] const T* get() const noexcept { return there_.load(std::memory_order_acquire); }
    /// Any thread but the servo.
    template <class Make>
    void build(const Make& make) const {
        const std::lock_guard lock(building_);
        if (built_ != nullptr)
            return;
        built_ = std::make_shared<const T>(make());
        there_.store(built_.get(), std::memory_order_release);
    }
    /// Shares the other's object, if it is built. Any thread but the servo.
    void share(const BuiltOnce& other) {
        const std::scoped_lock lock(building_, other.building_);
        built_ = other.built_;
        there_.store(built_.get(), std::memory_order_release);
    }

  private:
    mutable std::mutex building_;
    mutable std::shared_ptr<const T> built_;
    mutable std::atomic<const T*> there_{nullptr};
};

} // namespace touchstone
