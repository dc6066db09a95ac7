// What a haptic program gets and gives (docs/programs.md). Read before every program.
//
// Lengths are metres of the model, in the object's own frame; directions too: the origin is the mesh's, the axes are its
// node's, both at rest, and they move with the object. Velocities and forces are those of the hand, m/s and N, in that
// frame.
//
// The eye runs the same program for a pixel, as if nothing moved there: no toolDirection, velocity, acceleration and
// time, a force of 1 N, and a filterWidth of one pixel.

struct Touch {
    vec3 position;         // touched place, model m
    vec3 normal;           // unit, of the felt surface, outwards
    vec3 tangent;          // unit, along u where the mesh has texture coordinates
    vec3 binormal;         // unit, normal x tangent
    vec2 uv;               // texture coordinates, (0, 0) where the mesh has none
    vec3 toolDirection;    // unit, of the last motion along the surface; 0 before any
    vec3 toolVelocity;     // m/s, relative to the surface
    vec3 toolAcceleration; // m/s^2
    vec3 force;            // N: stiffness times depth along the normal, without friction and damping
    float staticFriction;  // 1
    float dynamicFriction; // 1
    float stiffness;       // N/m
    float damping;         // N s/m
    float filterWidth;     // model m that the tool moves along the surface in this tick
    float time;            // s since touch began on this scene
    float persistent;      // value of the persistent texture here; 1 where the material declares none
};

struct Surface {
    vec3 position; // displaced place, model m; less than depth is felt of what lies outside of the mesh
    vec3 normal;   // perturbed normal; where it is left alone, that of the displaced surface
    vec3 force;    // N
    float staticFriction;
    float dynamicFriction; // at most the static one is felt
    float stiffness;
    float damping;
    vec3 colour;     // 0..1, linear: what is seen; before that, the material's with its textures. The hand's is white
    float roughness; // 0..1, of the highlight, likewise; the hand's is 1. Neither is felt
    // What touch does to the persistent texture (before that, 0): its integral over the surface changes by so much a
    // second, within a disc of this radius. Wear of a cover at a rate in m^2/(N s): -rate * length(before.force).
    float persistentChange; // m^2/s
    float brush;            // model m
};

layout(location = 0) in vec3 touchstone_position;
layout(location = 1) in vec3 touchstone_normal;
layout(location = 2) in vec3 touchstone_tangent;
layout(location = 3) in vec3 touchstone_binormal;
layout(location = 4) in vec2 touchstone_uv;
layout(location = 5) in vec3 touchstone_toolDirection;
layout(location = 6) in vec3 touchstone_toolVelocity;
layout(location = 7) in vec3 touchstone_toolAcceleration;
layout(location = 8) in vec3 touchstone_force;
layout(location = 9) in vec4 touchstone_material; // static and dynamic friction, stiffness, damping
layout(location = 10) in vec2 touchstone_tick;    // filter width, time
layout(location = 11) in vec4 touchstone_look;    // colour, roughness
#ifdef TOUCHSTONE_PERSISTENT // the source names it
layout(location = 12) in float touchstone_persistent;
#endif

layout(location = 0) out vec3 touchstone_outPosition;
layout(location = 1) out vec3 touchstone_outNormal;
layout(location = 2) out vec3 touchstone_outForce;
layout(location = 3) out vec4 touchstone_outMaterial;
layout(location = 4) out vec4 touchstone_outLook;
#ifdef TOUCHSTONE_PERSISTENT
layout(location = 5) out vec2 touchstone_outPersistent; // change, brush
#endif
