// Counts lock acquisitions inside a tick, of which there must be none. Interposes the C library's functions
// for the whole program, including std::mutex and libraries, and forwards to them. Not under a sanitizer,
// which interposes them itself.

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

#include "engine/core/realtime_guard.h"

#include <dlfcn.h>
#include <pthread.h>

#include <atomic>
#include <ctime>

namespace {

struct AnnounceLocks {
    AnnounceLocks() { touchstone::realtime::announceLockInterposer(); }
} const announceLocks;

/// The next function of that name. Resolved at its first use, which may precede any constructor here.
template <class... Arguments>
class Behind {
  public:
    explicit constexpr Behind(const char* name) : name_(name) {}

    int operator()(Arguments... arguments) {
        touchstone::realtime::noteLock();
        auto* function = found_.load(std::memory_order_relaxed);
        if (function == nullptr) {
            function = reinterpret_cast<int (*)(Arguments...)>(dlsym(RTLD_NEXT, name_));
            found_.store(function, std::memory_order_relaxed);
        }
        return function(arguments...);
    }

  private:
    const char* name_;
    std::atomic<int (*)(Arguments...)> found_{nullptr};
};

constinit Behind<pthread_mutex_t*> mutexLock{"pthread_mutex_lock"}, mutexTrylock{"pthread_mutex_trylock"};
constinit Behind<pthread_mutex_t*, const timespec*> mutexTimedlock{"pthread_mutex_timedlock"};
constinit Behind<pthread_mutex_t*, clockid_t, const timespec*> mutexClocklock{"pthread_mutex_clocklock"};
constinit Behind<pthread_rwlock_t*> readLock{"pthread_rwlock_rdlock"}, writeLock{"pthread_rwlock_wrlock"},
    readTrylock{"pthread_rwlock_tryrdlock"}, writeTrylock{"pthread_rwlock_trywrlock"};

} // namespace

extern "C" {

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
    return mutexLock(mutex);
}
int pthread_mutex_trylock(pthread_mutex_t* mutex) noexcept {
    return mutexTrylock(mutex);
}
int pthread_mutex_timedlock(pthread_mutex_t* mutex, const timespec* until) noexcept {
    return mutexTimedlock(mutex, until);
}
int pthread_mutex_clocklock(pthread_mutex_t* mutex, clockid_t clock, const timespec* until) noexcept {
    return mutexClocklock(mutex, clock, until);
}
int pthread_rwlock_rdlock(pthread_rwlock_t* lock) noexcept {
    return readLock(lock);
}
int pthread_rwlock_wrlock(pthread_rwlock_t* lock) noexcept {
    return writeLock(lock);
}
int pthread_rwlock_tryrdlock(pthread_rwlock_t* lock) noexcept {
    return readTrylock(lock);
}
int pthread_rwlock_trywrlock(pthread_rwlock_t* lock) noexcept {
    return writeTrylock(lock);
}

} // extern "C"

#endif
