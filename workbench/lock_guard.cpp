// Counts what must not happen: asking for a lock inside a tick. Stands before the C library's own for the
// whole program, std::mutex and every library included, and passes on to them. Not under a sanitizer, which
// stands there itself.

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

#include "engine/core/realtime_guard.h"

#include <dlfcn.h>
#include <pthread.h>

namespace {

struct Announce {
    Announce() { touchstone::realtime::announceLockInterposer(); }
} const announce;

/// The function of this name behind ours. Found at its first use, which may be before any constructor here.
template <class Function>
Function behind(Function& found, const char* name) {
    if (found == nullptr)
        found = reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
    return found;
}

using MutexCall = int (*)(pthread_mutex_t*);
using RwlockCall = int (*)(pthread_rwlock_t*);
constinit MutexCall mutexLock = nullptr, mutexTrylock = nullptr;
constinit RwlockCall readLock = nullptr, writeLock = nullptr;

} // namespace

extern "C" {

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
    touchstone::realtime::noteLock();
    return behind(mutexLock, "pthread_mutex_lock")(mutex);
}

int pthread_mutex_trylock(pthread_mutex_t* mutex) noexcept {
    touchstone::realtime::noteLock();
    return behind(mutexTrylock, "pthread_mutex_trylock")(mutex);
}

int pthread_rwlock_rdlock(pthread_rwlock_t* lock) noexcept {
    touchstone::realtime::noteLock();
    return behind(readLock, "pthread_rwlock_rdlock")(lock);
}

int pthread_rwlock_wrlock(pthread_rwlock_t* lock) noexcept {
    touchstone::realtime::noteLock();
    return behind(writeLock, "pthread_rwlock_wrlock")(lock);
}

} // extern "C"

#endif
