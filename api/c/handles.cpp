#include "api/c/handles.h"

#include <cstdlib>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

namespace touchstone::api {

namespace {

struct Table {
    std::mutex mutex;
    std::map<uintptr_t, std::shared_ptr<Object>> objects;
    uintptr_t last = 0;
};

/// Static destructors must not run beside a servo: what is open is closed before any of them.
void closeAll();

/// Never destroyed: threads may outlive the statics.
Table& table() {
    static Table* kTable = [] {
        std::atexit(closeAll);
        return new Table;
    }();
    return *kTable;
}

void closeAll() {
    std::map<uintptr_t, std::shared_ptr<Object>> open;
    {
        const std::lock_guard lock(table().mutex);
        open.swap(table().objects);
    }
    for (const auto& [handle, object] : open)
        object->closed();
}

} // namespace

void refuseArgument(const std::string& argument, const std::string& problem) {
    throw Refused(TS_ARGUMENT, argument + ": " + problem);
}

uintptr_t newHandle(std::shared_ptr<Object> object) {
    // Far from any mapped address, so that a program that dereferences one ends at once.
    constexpr uintptr_t kStep = 8;
    Table& all = table();
    const std::lock_guard lock(all.mutex);
    all.objects.emplace(all.last + kStep, std::move(object));
    return all.last += kStep;
}

std::shared_ptr<Object> objectOf(uintptr_t handle) {
    Table& all = table();
    const std::lock_guard lock(all.mutex);
    const auto found = all.objects.find(handle);
    return found != all.objects.end() ? found->second : nullptr;
}

std::shared_ptr<Object> removeHandle(uintptr_t handle) {
    Table& all = table();
    const std::lock_guard lock(all.mutex);
    const auto found = all.objects.find(handle);
    if (found == all.objects.end())
        return nullptr;
    std::shared_ptr<Object> object = std::move(found->second);
    all.objects.erase(found);
    return object;
}

} // namespace touchstone::api
