#pragma once
// A device of two Python functions. A thread of its own calls them, so that the servo never waits for the
// interpreter: it reads the newest position and leaves the newest force.

#include "touchstone/touchstone.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <exception>
#include <thread>

namespace touchstone::python {

/// Three numbers from one writer to any readers; neither waits. (A sequence lock: Boehm, "Can seqlocks get
/// along with programming language memory models?", 2012.)
class SharedVector {
  public:
    void put(const std::array<double, 3>& values) noexcept {
        const uint32_t turn = turn_.load(std::memory_order_relaxed);
        turn_.store(turn + 1, std::memory_order_relaxed);
        std::atomic_thread_fence(std::memory_order_release);
        for (size_t i = 0; i < 3; ++i)
            values_[i].store(values[i], std::memory_order_relaxed);
        turn_.store(turn + 2, std::memory_order_release);
    }
    /// False where the writer was in between each time; `values` stay.
    bool get(std::array<double, 3>& values) const noexcept {
        for (int attempt = 0; attempt < 4; ++attempt) {
            const uint32_t turn = turn_.load(std::memory_order_acquire);
            std::array<double, 3> read{};
            for (size_t i = 0; i < 3; ++i)
                read[i] = values_[i].load(std::memory_order_relaxed);
            std::atomic_thread_fence(std::memory_order_acquire);
            if ((turn & 1) != 0 || turn_.load(std::memory_order_relaxed) != turn)
                continue;
            values = read;
            return true;
        }
        return false;
    }

  private:
    std::atomic<uint32_t> turn_{0};
    std::array<std::atomic<double>, 3> values_{};
};

/// `position` () -> three numbers (m, device frame) or None where it is unknown; `force` (array of 3, N) ->
/// ignored. One exception in them ends both: the position becomes stale, and the force fades.
class PythonDevice {
  public:
    PythonDevice(pybind11::object position, pybind11::object force, double rate)
        : position_(std::move(position)), force_(std::move(force)), period_(1.0 / rate) {}
    /// With the GIL; it lets it go.
    ~PythonDevice() { stop(); }
    PythonDevice(const PythonDevice&) = delete;
    PythonDevice& operator=(const PythonDevice&) = delete;

    /// Of this device, for ts_session_options; the limits are the caller's.
    [[nodiscard]] ts_device device() {
        ts_device device = TS_STRUCT(ts_device);
        device.context = this;
        device.sample = [](void* context, double, ts_reading* reading) {
            static_cast<PythonDevice*>(context)->read(*reading);
        };
        device.apply = [](void* context, const double force[3]) {
            static_cast<PythonDevice*>(context)->newestForce_.put({force[0], force[1], force[2]});
        };
        return device;
    }
    void start() {
        // Fills pybind11's table of NumPy: a thread that waited for that with the GIL would never end.
        (void)pybind11::array_t<double>(1);
        thread_ = std::thread([this] { run(); });
    }
    /// The last force that the function gets is the last command. With the GIL.
    void stop() {
        if (!thread_.joinable())
            return;
        stopping_.store(true, std::memory_order_relaxed);
        const pybind11::gil_scoped_release released;
        thread_.join();
    }
    [[nodiscard]] bool failed() const { return failed_.load(std::memory_order_acquire); }
    /// What a function threw, once. With the GIL.
    void rethrow() {
        if (failed_.exchange(false, std::memory_order_acquire))
            std::rethrow_exception(std::exchange(thrown_, nullptr));
    }

  private:
    using Clock = std::chrono::steady_clock;

    /// The servo's thread.
    void read(ts_reading& reading) noexcept {
        (void)newestPosition_.get(seen_);
        std::copy(seen_.begin(), seen_.end(), reading.position);
        const Clock::time_point at{Clock::duration(takenAt_.load(std::memory_order_relaxed))};
        reading.age = std::chrono::duration<double>(Clock::now() - at).count();
        reading.valid = valid_.load(std::memory_order_relaxed) ? 1 : 0;
    }
    void run() noexcept {
        const auto period =
            std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(period_));
        for (Clock::time_point next = Clock::now();; next = std::max(next + period, Clock::now())) {
            std::this_thread::sleep_until(next);
            const bool last = stopping_.load(std::memory_order_relaxed);
            const pybind11::gil_scoped_acquire gil;
            try {
                call();
            } catch (...) {
                valid_.store(false, std::memory_order_relaxed);
                thrown_ = std::current_exception();
                failed_.store(true, std::memory_order_release);
                return;
            }
            if (last)
                return;
        }
    }
    void call() {
        std::array<double, 3> force{};
        (void)newestForce_.get(force);
        force_(pybind11::array_t<double>(3, force.data()));
        const pybind11::object place = position_();
        if (place.is_none()) {
            valid_.store(false, std::memory_order_relaxed);
            return;
        }
        const auto numbers =
            pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>::ensure(place);
        if (!numbers) {
            PyErr_Clear();
            throw ts::Error(TS_ARGUMENT, "position: its answer is no array of three numbers");
        }
        if (numbers.size() != 3)
            throw ts::Error(TS_ARGUMENT, "position: its answer has " + std::to_string(numbers.size()) +
                                             " numbers, and not three");
        newestPosition_.put({numbers.data()[0], numbers.data()[1], numbers.data()[2]});
        takenAt_.store(Clock::now().time_since_epoch().count(), std::memory_order_relaxed);
        valid_.store(true, std::memory_order_relaxed);
    }

    pybind11::object position_, force_;
    double period_; // s
    SharedVector newestPosition_, newestForce_;
    std::atomic<Clock::rep> takenAt_{0};
    std::atomic<bool> valid_{false}, stopping_{false}, failed_{false};
    std::exception_ptr thrown_;
    std::array<double, 3> seen_{}; // the servo's
    std::thread thread_;
};

} // namespace touchstone::python
