/* Touchstone's C interface (docs/api.md). SI units; the workspace is right-handed, y up. Every array is row
 * by row.
 *
 * Handles are numbers in the form of pointers: they are never dereferenced, and never used again after they
 * are closed. A call with a handle that was closed, or that is of another kind, returns TS_CLOSED. Every
 * function may be called from any thread; calls on one hand or session wait for each other.
 *
 * Functions that return ts_status write nothing through their pointers unless they return TS_OK (or, where
 * stated, TS_CANCELLED), and leave a sentence for ts_last_error otherwise.
 *
 * Each struct begins with its size in bytes, as the caller was compiled (TS_STRUCT): later versions append
 * members, and those that a caller does not know keep their defaults. */
#ifndef TOUCHSTONE_TOUCHSTONE_H
#define TOUCHSTONE_TOUCHSTONE_H

#include <stddef.h>
#include <stdint.h>

#define TS_VERSION_MAJOR 0
#define TS_VERSION_MINOR 1
#define TS_VERSION_PATCH 0

#if defined(__GNUC__)
#define TS_API __attribute__((visibility("default")))
#else
#define TS_API
#endif

/* A struct whose size is filled in and whose other members are zero: ts_path path = TS_STRUCT(ts_path); */
#ifdef __cplusplus
#define TS_STRUCT(type) ::touchstone_c::sized<type>()
namespace touchstone_c {
template <class T>
inline T sized() {
    T value = T();
    value.size = sizeof(T);
    return value;
}
} // namespace touchstone_c
extern "C" {
#else
#define TS_STRUCT(type)                                                                                      \
    { .size = sizeof(type) }
#endif

typedef enum ts_status {
    TS_OK = 0,
    TS_ARGUMENT = 1,  /* an argument is wrong: the message names it */
    TS_CLOSED = 2,    /* a handle was closed, or is none of its kind */
    TS_INPUT = 3,     /* a file or a device is missing, broken or not usable: the message has the remedy */
    TS_STATE = 4,     /* not now: the session runs, or does not */
    TS_CANCELLED = 5, /* a callback asked to stop */
    TS_MEMORY = 6,
    TS_INTERNAL = 7 /* a fault of the library */
} ts_status;

/* A static name of the status: "TS_OK". */
TS_API const char* ts_status_name(ts_status status);
/* Of the library that is loaded: "0.1.0". */
TS_API const char* ts_version(void);
/* What the last call on this thread that failed said; empty before. Valid until the next one. */
TS_API const char* ts_last_error(void);

/* ---- Scenes: immutable; any number of threads may touch one. ---- */

typedef struct ts_scene_s* ts_scene;

typedef enum ts_fit {
    TS_FIT_NONE = 0,     /* scene metres are workspace metres */
    TS_FIT_WORKSPACE = 1 /* centred, its longest side 0.15 m */
} ts_fit;

typedef struct ts_scene_options {
    size_t size;
    int fit; /* ts_fit */
    /* Of a volume: the value at its surface, where `iso_given` is not 0; else Otsu's threshold. */
    int iso_given;
    double iso;
} ts_scene_options;

/* Triangles in model metres. NULL: the array is missing (optional ones only). */
typedef struct ts_mesh {
    size_t size;
    const char* name;        /* UTF-8; NULL: "mesh N" */
    const float* positions;  /* 3 per vertex, m, finite */
    size_t vertex_count;     /* at least 3 */
    const uint32_t* indices; /* 3 per triangle, counter-clockwise seen from outside, below vertex_count */
    size_t triangle_count;   /* at least 1 */
    const float* normals;    /* optional, 3 per vertex, finite; without it each facet is flat */
    const float* texture;    /* optional, 2 per vertex, finite */
    uint32_t material;       /* index into the materials; 0 where there are none */
} ts_mesh;

/* What a surface feels like (docs/materials.md). NaN: not stated. */
typedef struct ts_material {
    size_t size;
    const char* name;        /* UTF-8; NULL: "material N" */
    double stiffness;        /* N/m */
    double damping;          /* N s/m */
    double static_friction;  /* 1 */
    double dynamic_friction; /* 1 */
    double viscous_friction; /* N s/m */
} ts_material;
/* A material that states nothing. */
TS_API void ts_material_init(ts_material* material);

typedef struct ts_scene_info {
    size_t size;
    uint64_t objects, triangles, materials;
    double low[3], high[3]; /* m, the bounds at rest in the workspace; low > high where it is empty */
    int moves;              /* 1: an animation moves objects */
    uint64_t warnings;      /* see ts_scene_warning */
} ts_scene_info;

/* Reads any file that the program opens. `options` may be NULL. */
TS_API ts_status ts_scene_load(const char* file, const ts_scene_options* options, ts_scene* scene);
/* The same for a glTF file in memory; its URIs are relative to `folder`, which may be NULL where it has none.
 */
TS_API ts_status ts_scene_load_memory(const void* bytes, size_t count, const char* folder,
                                      const ts_scene_options* options, ts_scene* scene);
/* Copies the arrays. Without materials (NULL and 0) the surface states nothing. */
TS_API ts_status ts_scene_create(const ts_mesh* meshes, size_t mesh_count, const ts_material* materials,
                                 size_t material_count, const ts_scene_options* options, ts_scene* scene);
TS_API ts_status ts_scene_get_info(ts_scene scene, ts_scene_info* info);
/* Text `index` of the scene's warnings, cut to `capacity` bytes with its zero; `needed` (may be NULL) gets
 * the bytes that it needs with it. */
TS_API ts_status ts_scene_warning(ts_scene scene, uint64_t index, char* text, size_t capacity,
                                  size_t* needed);
/* An object: one mesh at one place of the file. */
typedef struct ts_object_info {
    size_t size;
    double centre[3];                   /* m, workspace, at rest */
    uint64_t first_triangle, triangles; /* in ts_scene_triangles; none of an object that no file has */
    int movable;                        /* 1: ts_session_move may move it */
} ts_object_info;
TS_API ts_status ts_scene_object(ts_scene scene, uint64_t object, ts_object_info* info);
/* The numbers of a material that may change while it is touched (docs/materials.md). */
typedef struct ts_number_info {
    size_t size;
    const char *name, *label, *unit, *meaning; /* static texts */
    double least, most;                        /* what is allowed, SI */
    double low, high;                          /* ends of a slider */
    int logarithmic;                           /* the slider */
} ts_number_info;
TS_API size_t ts_material_number_count(void);
TS_API ts_status ts_material_number_get_info(size_t index, ts_number_info* info);
/* As ts_scene_warning. */
TS_API ts_status ts_scene_material_name(ts_scene scene, uint64_t material, char* text, size_t capacity,
                                        size_t* needed);
/* What is felt of the file, before maps; NaN: the session's setting or the device's recommendation. */
TS_API ts_status ts_scene_material_number(ts_scene scene, uint64_t material, const char* name, double* value);
/* The corners of the first `capacity` triangles at rest, 9 floats each, m, workspace (`corners` may be NULL
 * where it is 0); all of them are counted in `triangles`. */
TS_API ts_status ts_scene_triangles(ts_scene scene, float* corners, size_t capacity, size_t* triangles);
/* What touches it goes on. NULL: nothing happens. */
TS_API ts_status ts_scene_close(ts_scene scene);

/* ---- Settings by name: those of `--set`, with the same words, ranges and messages. ---- */

typedef struct ts_setting_info {
    size_t size;
    /* Static texts. */
    const char *name, *unit, *meaning;
    const char* allowed; /* "sweep, rays" or "0 .. 0.05" */
    const char* initial; /* value of a new set of settings */
} ts_setting_info;
TS_API size_t ts_setting_count(void);
TS_API ts_status ts_setting_get_info(size_t index, ts_setting_info* info);

typedef struct ts_settings_s* ts_settings;
TS_API ts_status ts_settings_create(ts_settings* settings);
TS_API ts_status ts_settings_set(ts_settings settings, const char* name, const char* value);
/* As ts_scene_warning. */
TS_API ts_status ts_settings_get(ts_settings settings, const char* name, char* text, size_t capacity,
                                 size_t* needed);
TS_API ts_status ts_settings_close(ts_settings settings);

/* ---- Ticks: arrays of the caller, one entry (or row) a tick; a NULL one is not written. ---- */

typedef struct ts_ticks {
    size_t size;
    size_t capacity;     /* entries of every array that is not NULL */
    double* time;        /* s */
    double* hip;         /* 3, m, workspace: haptic interface point */
    double* proxy;       /* 3, m, workspace */
    double* normal;      /* 3, unit, workspace; zero without contact */
    double* force;       /* 3, N, workspace, before safety */
    double* command;     /* 3, N, workspace, after safety */
    double* penetration; /* m */
    uint32_t* contacts;  /* touching features */
    uint32_t* friction;  /* 0 free, 1 sticks, 2 slides */
    uint32_t* flags;     /* bits: docs/files.md, Flags of a tick */
    int32_t* object;     /* touched object; -1: none */
    int32_t* triangle;   /* touched triangle of its mesh; -1: none */
    int64_t* step_ns;    /* ns that the tick took */
} ts_ticks;

/* ---- Offline touch: deterministic, as fast as it goes; `touchstone touch` to the last bit. ---- */

typedef struct ts_path {
    size_t size;
    const double* positions; /* 3 per row, m, finite: of the hand, in the workspace */
    size_t count;            /* rows; 0: nothing happens */
    const double* times;     /* s, finite and increasing, one a row; NULL: `rate` applies */
    double rate;             /* Hz; 0: 1000. The ticks are at n / rate */
    /* Optional: asked every 4096 ticks on the calling thread; other than 0 stops the call with TS_CANCELLED.
     */
    int (*progress)(void* context, size_t done, size_t count);
    void* context;
} ts_path;

/* Touches a scene along a path from the beginning. `settings` NULL: the start values. The arrays of `ticks`
 * hold path->count entries. On TS_CANCELLED those of the ticks made are written. */
TS_API ts_status ts_touch(ts_scene scene, ts_settings settings, const ts_path* path, const ts_ticks* ticks);

/* A hand that goes on where its last path ended. */
typedef struct ts_hand_s* ts_hand;
TS_API ts_status ts_hand_create(ts_scene scene, ts_settings settings, ts_hand* hand);
/* For the next tick. */
TS_API ts_status ts_hand_set(ts_hand hand, const char* name, const char* value);
/* As ts_touch; times go on increasing, and a path without times goes on after the last tick. `done` (may be
 * NULL) gets the ticks made, also on TS_CANCELLED. */
TS_API ts_status ts_hand_touch(ts_hand hand, const ts_path* path, const ts_ticks* ticks, size_t* done);
TS_API ts_status ts_hand_close(ts_hand hand);

/* Hands in one world, 1 to 4: what one of them moves or wears off the others feel. A ts_hand of one is that
 * of ts_hand_create; ts_hand_set and ts_hand_close are for all. */
TS_API ts_status ts_hands_create(ts_scene scene, ts_settings settings, size_t count, ts_hand* hands);
/* As ts_hand_touch, with a path a hand, and (unless NULL) a ts_ticks each: `count` of them, as many as there
 * are hands. The paths have one count; times, rate and progress of the first are those of all. */
TS_API ts_status ts_hands_touch(ts_hand hands, const ts_path* paths, const ts_ticks* ticks, size_t count,
                                size_t* done);

/* The positions of a simulated hand that strokes the scene, `rate` a second for one period of the stroke
 * (`touchstone touch --stroke`), an animation playing from its beginning at its own speed: the first
 * `capacity` rows of 3 in `positions` (may be NULL), all of them counted in `rows`. `speed` (m/s) and `depth`
 * (m): 0 is the stroke's own. */
TS_API ts_status ts_stroke(ts_scene scene, const char* name, double speed, double depth, double rate,
                           double* positions, size_t capacity, size_t* rows);

/* ---- Real time: a servo of its own at 1 kHz. ---- */

typedef struct ts_reading {
    size_t size;
    double position[3];    /* m, device frame */
    double orientation[4]; /* w, x, y, z; zeros: none */
    double age;            /* s since it was measured */
    uint32_t buttons;      /* bits */
    int valid;             /* 0: the position is unknown */
} ts_reading;

/* A device of the caller's. Its two functions are called by the servo's thread once a tick: they must not
 * block, allocate or throw. Where the model comes to be around it, nothing is felt until it has left the
 * model once. Limits of 0 are those of a Phantom Premium 1.5; no command exceeds them. */
typedef struct ts_device {
    size_t size;
    void* context;
    void (*sample)(void* context, double time, ts_reading* reading);
    void (*apply)(void* context, const double force[3]); /* N, device frame */
    double max_force;                                    /* N */
    double max_force_rate;                               /* N/s */
    double stiffness;                                    /* N/m, where a material states none */
    double max_stiffness;                                /* N/m */
    double stale_age;                                    /* s, after which a reading counts as lost */
} ts_device;

/* A further hand of a session: `device` or `own`, as in ts_session_options. */
typedef struct ts_other_hand {
    size_t size;
    const char* device;
    const ts_device* own;
} ts_other_hand;

typedef struct ts_session_options {
    size_t size;
    double rate; /* Hz, 100 to 4000; 0: 1000 */
    /* What is held: "stroke" or "stroke:NAME" (a simulated hand), or a device as `run --device` takes
     * ("stroke" in place of "hand"). NULL: `own`. */
    const char* device;
    const ts_device* own; /* copied; its context outlives the session */
    size_t keep;          /* ticks kept for ts_session_take; 0: none */
    /* Hz, 100 to 4000, of a control loop apart from contact (docs/control.md); 0: none, the servo commands
     * the device. Its own thread then calls the device; a simulated hand then strokes what moves as if the
     * animation were played at its own speed. */
    double control;
    double contact_power; /* W that the servo's contact may add to the loop's spring; 0: 1 */
    double goal_power;    /* W that ts_session_goal may */
    /* Hands 1 and on, at most 3: one servo drives all of them, each within its device's limits. None with a
     * control loop. Simulated hands begin their strokes one after the other. */
    const ts_other_hand* others;
    size_t other_count;
} ts_session_options;

/* Where an object is to go, or is. Workspace. */
typedef struct ts_pose {
    size_t size;
    double position[3];    /* m, of the object's centre (ts_object_info), within 1 m of the origin */
    double orientation[4]; /* w, x, y, z: its turn from how it stands at rest; zeros: as at rest */
    double speed;          /* m/s, of the centre, at most 0.5; 0: 0.1 */
    double turn;           /* rad/s, at most 6.3; 0: 1 */
} ts_pose;

/* Contact that the caller renders: what the control loop's spring pulls the hand to. Workspace. */
typedef struct ts_goal {
    size_t size;
    int touching;        /* 0: no force; the rest is then not read */
    double proxy[3];     /* m, within 1 km */
    double stiffness;    /* N/m, above 0; 0: the device's recommended one */
    double damping;      /* N s/m, of the loop, at its rate */
    double planes[3][3]; /* unit normals of planes through the proxy along which its end slides */
    size_t plane_count;  /* 0 to 3 */
} ts_goal;

/* The newest tick. */
typedef struct ts_state {
    size_t size;
    int touching; /* 0: the scene has not been taken up yet; then only the counters are valid */
    uint64_t tick;
    double time;
    double hip[3], proxy[3], normal[3], force[3], command[3]; /* as in ts_ticks */
    double penetration;
    uint32_t contacts, friction, flags;
    int32_t object;
    /* Counters since the start. */
    uint64_t ticks, missed, skipped, dropped;
    int realtime; /* 1: the servo has SCHED_FIFO */
    /* With a control loop, else 0: its ticks; 1 in `rendered` where it follows ts_session_goal. `command` is
     * then the loop's, and where it follows goals `hip`, `proxy` (the spring's end), `force`, `penetration`
     * and `contacts` (0 or 1) are. */
    uint64_t control_ticks, control_missed;
    int rendered;
    double started;  /* s on CLOCK_MONOTONIC at which `time` is 0; 0: it was never started */
    int64_t wake_ns; /* ns from the tick's deadline to its begin */
    int64_t step_ns; /* ns that the tick took */
} ts_state;

typedef struct ts_session_s* ts_session;
TS_API ts_status ts_session_create(const ts_session_options* options, ts_session* session);
/* From the next tick on. A simulated hand strokes the scene of the last call before the start. */
TS_API ts_status ts_session_touch(ts_session session, ts_scene scene);
TS_API ts_status ts_session_set(ts_session session, const char* name, const char* value);
/* A number of a material of the touched scene, from the next tick on; touch goes on. NaN: what the file says
 * again. The next ts_session_touch begins with what the scene says. A recording has it.
 * Materials of the scene that are one in the file (it touches parts of it as another surface) change
 * together. */
TS_API ts_status ts_session_material(ts_session session, uint64_t material, const char* name, double value);
/* As ts_scene_material_number, with what ts_session_material has changed. */
TS_API ts_status ts_session_material_number(ts_session session, uint64_t material, const char* name,
                                            double* value);
/* From the next tick on the object goes to the pose on the straight way, no faster than the pose says. The
 * hand is pushed along as by an animated object, within the limits of the device. Up to 16 objects of a
 * scene, none that its animation or physics moves. The next ts_session_touch begins with the scene at rest. A
 * recording has the motion: now and then the call reads what the servo has done, as ts_session_pump does. */
TS_API ts_status ts_session_move(ts_session session, uint64_t object, const ts_pose* pose);
/* All objects that were moved stop where they are. */
TS_API ts_status ts_session_halt(ts_session session);
/* Where the object was in the newest tick; its speeds are those of the last ts_session_move. */
TS_API ts_status ts_session_pose(ts_session session, uint64_t object, ts_pose* pose);
/* Other than 0: on. Any thread, also while another one is in ts_session_run. */
TS_API ts_status ts_session_force(ts_session session, int on);
/* Other than 0: the control loop follows ts_session_goal from now on; 0: the servo's contact. TS_STATE
 * without a control loop or a scene. */
TS_API ts_status ts_session_render(ts_session session, int by_caller);
/* The newest goal; 0.25 s after the last one the hand is let go. Late, lost and wrong ones make touch sticky
 * and give no energy beyond goal_power. */
TS_API ts_status ts_session_goal(ts_session session, const ts_goal* goal);
/* From the next tick on to `file`, for `touchstone replay`; NULL ends the recording. */
TS_API ts_status ts_session_record(ts_session session, const char* file);
TS_API ts_status ts_session_start(ts_session session);
/* The last command is zero. */
TS_API ts_status ts_session_stop(ts_session session);
/* Reads what the servo has done: at least every ten seconds while it runs. */
TS_API ts_status ts_session_pump(ts_session session, ts_state* state);
/* The newest tick of a hand (0 is the first) at the last pump. */
TS_API ts_status ts_session_hand(ts_session session, size_t hand, ts_state* state);
/* Starts if need be, and calls `callback` `rate` times a second (0: 60) on this thread for `seconds`; other
 * than 0 ends the call with TS_OK. The callback may use the session. Stops again if it has started. */
TS_API ts_status ts_session_run(ts_session session, double seconds, double rate,
                                int (*callback)(void* context, const ts_state* state), void* context);
/* The kept ticks since the last call, the oldest first, at most ticks->capacity; `count` gets their number.
 */
TS_API ts_status ts_session_take(ts_session session, const ts_ticks* ticks, size_t* count);
/* The same of a hand; `keep` ticks of each are kept. */
TS_API ts_status ts_session_take_hand(ts_session session, size_t hand, const ts_ticks* ticks, size_t* count);
/* Stops it. A thread in ts_session_run returns with TS_CLOSED. */
TS_API ts_status ts_session_close(ts_session session);

/* ---- Recordings (.tsrec) ---- */

typedef struct ts_recording_s* ts_recording;
TS_API ts_status ts_recording_open(const char* file, ts_recording* recording);
/* The next ticks of hand 0, at most ticks->capacity; `count` 0: the end. A recording has no normal,
 * penetration, friction, object and triangle: these arrays have to be NULL. Damaged places are skipped. */
TS_API ts_status ts_recording_read(ts_recording recording, const ts_ticks* ticks, size_t* count);
/* The hands that it has ticks of, 1 to 4, as far as it has been read. */
TS_API ts_status ts_recording_hands(ts_recording recording, size_t* hands);
/* The next ticks of a hand; each hand is read on its own, from the beginning. */
TS_API ts_status ts_recording_read_hand(ts_recording recording, size_t hand, const ts_ticks* ticks,
                                        size_t* count);
/* "version", "build", "processor", "command", "date" of the program that made it, "scene" (its path), or
 * "damage" (a line a place); as ts_scene_warning. What has not been read yet is empty. */
TS_API ts_status ts_recording_text(ts_recording recording, const char* what, char* text, size_t capacity,
                                   size_t* needed);
TS_API ts_status ts_recording_close(ts_recording recording);

#ifdef __cplusplus
}
#endif
#endif
