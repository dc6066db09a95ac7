#version 460
// The finished scene image, scaled to its place in the window. Bytes are passed on as they are: both ends hold
// sRGB and neither view says so, because Dear ImGui draws into the same attachment in sRGB values.
layout(set = 0, binding = 0) uniform sampler2D sceneImage;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 outColor;

void main() { outColor = vec4(texture(sceneImage, uv).rgb, 1.0); }
