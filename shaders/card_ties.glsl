// Splats at equal depths. PASS 0: their ranks, which are sorted by first where the processor has projected some of a
// layer's splats and the card the others; 1: their keys of depth, in the order of ranks; 2: children of one splat at one
// depth, in the order of engine/render/screen_splat.h.
layout(local_size_x = 256) in;
layout(std430, binding = 1) buffer Keys { uint key_of[]; };
layout(std430, binding = 2) buffer Order { uint record_at[]; };
layout(std430, binding = 3) readonly buffer Ranks { uint rank_of[]; };  // of records
layout(std430, binding = 4) writeonly buffer Moved { uint moved[]; };
#if PASS == 2
layout(std430, binding = 5) readonly buffer Records { vec4 record[]; };
uniform uint vectors;  // of a record

bool comes_before(uint a, uint b) {
    vec3 from_a = record[vectors * a].xyz, from_b = record[vectors * b].xyz;  // x, y, and what grows with the radius
    if (from_a.x != from_b.x) return from_a.x < from_b.x;
    if (from_a.y != from_b.y) return from_a.y < from_b.y;
    return from_a.z < from_b.z;
}
bool is_tied(uint i, uint j) { return key_of[i] == key_of[j] && rank_of[record_at[i]] == rank_of[record_at[j]]; }
#endif

void main() {
    uint i = group_number() * GROUP + gl_LocalInvocationIndex;
    if (i >= counts.visible) return;
#if PASS == 0
    moved[i] = rank_of[i];
#elif PASS == 1
    moved[i] = key_of[record_at[i]];
#else
    if (i > 0u && is_tied(i - 1u, i)) return;
    // Few at a time: sorted by insertion, by the thread of the first.
    for (uint end = i + 1u; end < counts.visible && is_tied(i, end); ++end) {
        uint own = record_at[end], at = end;
        for (; at > i && comes_before(own, record_at[at - 1u]); --at) record_at[at] = record_at[at - 1u];
        record_at[at] = own;
    }
#endif
}
