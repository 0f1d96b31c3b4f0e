// An isolated layer, rendered on black, onto what is behind it: as group_pixel in engine/render/resolve.cpp. Dual-source:
// colour = light + through * behind. BLEND is the number of the layer's Blend: 2 screen, else by its alpha.

uniform sampler2D layer_image;

layout(location = 0, index = 0) out vec4 light;
layout(location = 0, index = 1) out vec4 through;

void main() {
    vec4 p = texelFetch(layer_image, ivec2(gl_FragCoord.xy), 0);
    vec3 hidden = BLEND == 2 ? min(vec3(1.0), p.rgb) : vec3(p.a);
    float alpha = BLEND == 2 ? (hidden.r + hidden.g + hidden.b) * (1.0 / 3.0) : p.a;
    light = vec4(p.rgb, alpha);
    through = vec4(1.0 - hidden, 1.0 - alpha);
}
