#version 460
// One triangle over the whole viewport, at the far plane.
layout(location = 0) out vec2 uv; // 0..1 from clip space -1, -1: the upper left corner unless the viewport is turned over

void main() {
    uv = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);
    gl_Position = vec4(uv * 2.0 - 1.0, 1.0, 1.0);
}
