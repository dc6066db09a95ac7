#include "api/c/tick_arrays.h"

#include "api/c/calls.h"

namespace touchstone::api {

namespace {

template <class T>
void set(T* array, size_t i, T value) noexcept {
    if (array != nullptr)
        array[i] = value;
}
void set(double* array, size_t i, const glm::dvec3& value) noexcept {
    if (array != nullptr)
        for (int axis = 0; axis < 3; ++axis)
            array[3 * i + static_cast<size_t>(axis)] = value[axis];
}

bool writes(const ts_ticks& a) {
    return a.time != nullptr || a.hip != nullptr || a.proxy != nullptr || a.normal != nullptr ||
           a.force != nullptr || a.command != nullptr || a.penetration != nullptr || a.contacts != nullptr ||
           a.friction != nullptr || a.flags != nullptr || a.object != nullptr || a.triangle != nullptr ||
           a.step_ns != nullptr;
}

} // namespace

TickRow rowOf(double time, const HapticOutput& output, int64_t stepNs) noexcept {
    return {time,
            output.hip,
            output.proxy,
            output.normal,
            output.force,
            output.commandInWorkspace,
            output.penetration,
            output.contacts,
            static_cast<uint32_t>(output.friction),
            output.flags,
            output.object,
            output.triangle,
            stepNs};
}

TickArrays::TickArrays(const ts_ticks* ticks, size_t needed) : arrays_(structOf(ticks, "ticks")) {
    if (arrays_.capacity < needed && writes(arrays_))
        refuseArgument("ticks.capacity", std::to_string(arrays_.capacity) + ", and there are " +
                                             std::to_string(needed) + " ticks");
}

void TickArrays::put(size_t i, const TickRow& row) const noexcept {
    set(arrays_.time, i, row.time);
    set(arrays_.hip, i, row.hip);
    set(arrays_.proxy, i, row.proxy);
    set(arrays_.normal, i, row.normal);
    set(arrays_.force, i, row.force);
    set(arrays_.command, i, row.command);
    set(arrays_.penetration, i, row.penetration);
    set(arrays_.contacts, i, row.contacts);
    set(arrays_.friction, i, row.friction);
    set(arrays_.flags, i, row.flags);
    set(arrays_.object, i, row.object);
    set(arrays_.triangle, i, row.triangle);
    set(arrays_.step_ns, i, row.stepNs);
}

} // namespace touchstone::api
