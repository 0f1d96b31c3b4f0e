// One pixel of a splat: its weight from the footprint's profile, and what it adds and hides. KIND is the number of the
// group's FoldKind: 0 over, 1 add, 2 general (dual-source: colour = light + through * behind), 3 lighten. Needs
// blend.glsl.

uniform sampler2DArray footprint_profiles;  // weight over distance, a row per radius, a layer per falloff

flat in vec4 disc_place;
flat in vec4 disc_table;
flat in vec4 disc_light;
#if KIND == 2
flat in vec4 disc_occlusion;
layout(location = 0, index = 1) out vec4 through;
layout(location = 0, index = 0) out vec4 light;
#else
layout(location = 0) out vec4 light;
#endif

void main() {
    float place = disc_place.z + disc_place.w * distance(gl_FragCoord.xy, disc_place.xy);
    float w = textureLod(footprint_profiles, vec3(place, disc_table.xy), 0.0).r;
    w += disc_table.z * (w * (1.0 - w));
    float s = clamp(disc_light.w * w, 0.0, disc_table.w);
#if KIND == 2
    vec3 hidden = min(vec3(1.0), s * disc_occlusion.rgb);
    if (disc_occlusion.a > 1.0) {
        float most = min(s, 1.0);
        hidden = vec3(blend_absorbed(most, disc_occlusion.r), blend_absorbed(most, disc_occlusion.g),
                      blend_absorbed(most, disc_occlusion.b));
    }
    float hidden_alpha = (hidden.r + hidden.g + hidden.b) * (1.0 / 3.0);
    light = vec4(s * disc_light.rgb, hidden_alpha * min(disc_occlusion.a, 1.0));
    through = vec4(1.0 - hidden, 1.0 - hidden_alpha);
#else
    light = vec4(s * disc_light.rgb, KIND == 1 ? 0.0 : s);
#endif
}
