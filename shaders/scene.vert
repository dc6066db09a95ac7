#version 460
#extension GL_GOOGLE_include_directive : require
// Mesh vertices into the eye frame. FALSE_COLOR adds the scalar of the false-colour view; WIREFRAME draws edges over
// the surface that they belong to. PROGRAM adds the place as a haptic program sees it.
#include "shared/scene_types.h"

layout(constant_id = 0) const uint kFeatures = 0u;
layout(set = 0, binding = 0) uniform Frame { FrameUniforms frame; };
layout(push_constant) uniform Object { ObjectConstants object; };
#ifdef PROGRAM
layout(set = 2, binding = 1) uniform ProgramObject { ProgramObjectUniforms programObject; };
#endif

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec2 uv0;
layout(location = 4) in vec2 uv1;
#ifdef FALSE_COLOR
layout(location = 6) in float scalar;
#else
layout(location = 5) in vec4 color;
#endif

layout(location = 0) out vec3 eyePosition;
#ifndef WIREFRAME
layout(location = 1) out vec3 eyeNormal;
layout(location = 2) out vec4 eyeTangent;
layout(location = 3) out vec4 uvs;
#ifdef FALSE_COLOR
layout(location = 5) out float vertexScalar;
#else
layout(location = 4) out vec4 vertexColor;
#endif
#ifdef PROGRAM
layout(location = 6) out vec3 programPosition;
layout(location = 7) out vec3 programNormal;
layout(location = 8) out vec4 programTangent;
#endif
#endif

void main() {
    const vec4 p = vec4(position, 1.0);
    eyePosition = vec3(dot(object.eyeFromMesh[0], p), dot(object.eyeFromMesh[1], p), dot(object.eyeFromMesh[2], p));
#ifndef WIREFRAME
    eyeNormal = vec3(dot(object.normalFromMesh[0].xyz, normal), dot(object.normalFromMesh[1].xyz, normal),
                     dot(object.normalFromMesh[2].xyz, normal));
    // A constant where the material needs none: an unused output costs triangle setup on software devices.
    eyeTangent = vec4(0.0);
    if ((kFeatures & kHasTangents) != 0u)
        eyeTangent = vec4(dot(object.eyeFromMesh[0].xyz, tangent.xyz), dot(object.eyeFromMesh[1].xyz, tangent.xyz),
                          dot(object.eyeFromMesh[2].xyz, tangent.xyz), tangent.w * object.normalFromMesh[0].w);
    uvs = vec4(uv0, 0.0, 0.0);
    if ((kFeatures & kHasUvTransform) != 0u) uvs.zw = uv1;
#ifdef FALSE_COLOR
    vertexScalar = scalar;
#else
    vertexColor = vec4(1.0);
    if ((kFeatures & kHasVertexColor) != 0u) vertexColor = color;
#endif
#ifdef PROGRAM
    const mat3 rows = mat3(programObject.programFromMesh[0].xyz, programObject.programFromMesh[1].xyz,
                           programObject.programFromMesh[2].xyz);
    const mat3 normalRows = mat3(programObject.normalFromMesh[0].xyz, programObject.normalFromMesh[1].xyz,
                                 programObject.normalFromMesh[2].xyz);
    programPosition = position * rows + vec3(programObject.programFromMesh[0].w, programObject.programFromMesh[1].w,
                                             programObject.programFromMesh[2].w);
    programNormal = normal * normalRows;
    programTangent = vec4(tangent.xyz * rows, tangent.w);
#endif
#endif
    gl_Position = frame.clipFromEye * vec4(eyePosition, 1.0);
#ifdef WIREFRAME
    gl_Position.z -= 1e-4 * gl_Position.w;
#endif
}
