// ts_session_* and ts_recording_*.

#include "api/c/calls.h"
#include "api/c/live_session.h"
#include "api/c/read_recording.h"

namespace touchstone::api {
namespace {

std::shared_ptr<LiveSession> live(ts_session session) {
    return take<LiveSession>(session, "session");
}

std::shared_ptr<ReadRecording> recorded(ts_recording recording) {
    return take<ReadRecording>(recording, "recording");
}

} // namespace
} // namespace touchstone::api

using namespace touchstone::api;

extern "C" {

ts_status ts_session_create(const ts_session_options* options, ts_session* session) {
    return call([&] {
        (void)given(session, "session");
        (void)given(options, "options");
        give(std::make_shared<LiveSession>(structOf(options, "options")), session);
    });
}

ts_status ts_session_touch(ts_session session, ts_scene scene) {
    return call([&] { live(session)->touch(take<TouchedScene>(scene, "scene")); });
}

ts_status ts_session_set(ts_session session, const char* name, const char* value) {
    return call([&] { live(session)->set(textOf(name, "name"), textOf(value, "value")); });
}

ts_status ts_session_force(ts_session session, int on) {
    return call([&] { live(session)->force(on != 0); });
}

ts_status ts_session_material(ts_session session, uint64_t material, const char* name, double value) {
    return call([&] { live(session)->material(material, textOf(name, "name"), value); });
}

ts_status ts_session_material_number(ts_session session, uint64_t material, const char* name, double* value) {
    return call([&] {
        (void)given(value, "value");
        *value = live(session)->materialNumber(material, textOf(name, "name"));
    });
}

ts_status ts_session_move(ts_session session, uint64_t object, const ts_pose* pose) {
    return call([&] {
        const ts_pose whole = structOf(&given(pose, "pose"), "pose");
        live(session)->move(object, &whole);
    });
}

ts_status ts_session_halt(ts_session session) {
    return call([&] { live(session)->move(0, nullptr); });
}

ts_status ts_session_pose(ts_session session, uint64_t object, ts_pose* pose) {
    return call([&] { giveStruct(live(session)->pose(object), pose, "pose"); });
}

ts_status ts_session_render(ts_session session, int by_caller) {
    return call([&] { live(session)->render(by_caller != 0); });
}

ts_status ts_session_goal(ts_session session, const ts_goal* goal) {
    return call([&] {
        (void)given(goal, "goal");
        live(session)->goal(structOf(goal, "goal"));
    });
}

ts_status ts_session_record(ts_session session, const char* file) {
    return call([&] { live(session)->record(file); });
}

ts_status ts_session_start(ts_session session) {
    return call([&] { live(session)->start(); });
}

ts_status ts_session_stop(ts_session session) {
    return call([&] { live(session)->stop(); });
}

ts_status ts_session_pump(ts_session session, ts_state* state) {
    return call([&] { giveStruct(live(session)->pump(), state, "state"); });
}

ts_status ts_session_hand(ts_session session, size_t hand, ts_state* state) {
    return call([&] { giveStruct(live(session)->handState(hand), state, "state"); });
}

ts_status ts_session_run(ts_session session, double seconds, double rate,
                         int (*callback)(void* context, const ts_state* state), void* context) {
    return call([&] { live(session)->run(seconds, rate, callback, context); });
}

ts_status ts_session_take(ts_session session, const ts_ticks* ticks, size_t* count) {
    return ts_session_take_hand(session, 0, ticks, count);
}

ts_status ts_session_take_hand(ts_session session, size_t hand, const ts_ticks* ticks, size_t* count) {
    return call([&] {
        (void)given(count, "count");
        (void)given(ticks, "ticks");
        *count = live(session)->takeKept(hand, TickArrays(ticks, 0));
    });
}

ts_status ts_session_close(ts_session session) {
    return call([&] { close<LiveSession>(session, "session"); });
}

ts_status ts_recording_open(const char* file, ts_recording* recording) {
    return call([&] {
        (void)given(recording, "recording");
        give(std::make_shared<ReadRecording>(textOf(file, "file")), recording);
    });
}

ts_status ts_recording_hands(ts_recording recording, size_t* hands) {
    return call([&] {
        (void)given(hands, "hands");
        *hands = recorded(recording)->hands();
    });
}

ts_status ts_recording_read(ts_recording recording, const ts_ticks* ticks, size_t* count) {
    return ts_recording_read_hand(recording, 0, ticks, count);
}

ts_status ts_recording_read_hand(ts_recording recording, size_t hand, const ts_ticks* ticks, size_t* count) {
    return call([&] {
        (void)given(count, "count");
        (void)given(ticks, "ticks");
        *count = recorded(recording)->read(hand, TickArrays(ticks, 0));
    });
}

ts_status ts_recording_text(ts_recording recording, const char* what, char* text, size_t capacity,
                            size_t* needed) {
    return call([&] { giveText(recorded(recording)->text(textOf(what, "what")), text, capacity, needed); });
}

ts_status ts_recording_close(ts_recording recording) {
    return call([&] { close<ReadRecording>(recording, "recording"); });
}

} // extern "C"
