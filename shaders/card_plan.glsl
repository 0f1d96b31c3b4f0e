// One group of threads, between the passes over splats. PASS 0: nothing is counted yet. 1: the slab of each bin of depth, so
// that slabs hold about as many of the sample's splats; which slab a splat is in changes no pixel. 2: where slabs begin.
// 3: how many groups the passes over records and entries need. Records are those of all slabs or of the `only` one.
layout(local_size_x = 256) in;
layout(std430, binding = 1) readonly buffer Begins { uint begin[]; };  // [slab][group of splats]
layout(std430, binding = 2) writeonly buffer Arguments { uint arguments[]; };
uniform uint slabs, splat_groups, only;
const uint ALL_SLABS = 0xffffffffu;

void put(uint slot, uint groups) {
    uint wide = min(max(int(groups), 1), 32768);
    arguments[3u * slot] = wide;
    arguments[3u * slot + 1u] = groups_for(max(int(groups), 1), wide);
    arguments[3u * slot + 2u] = 1u;
}

void main() {
    uint t = gl_LocalInvocationIndex;
#if PASS == 0
    if (t == 0u) {
        counts.entries_low = counts.entries_high = 0u;
        counts.visible = counts.entries = counts.entries_wanted = counts.area_low = counts.area_high = 0u;
        counts.lowest = counts.first_key = 0xffffffffu;
        counts.highest = counts.last_key = 0u;
    }
    for (uint k = t; k < 1024u; k += GROUP) counts.bins[k] = 0u;
#elif PASS == 1
    uint own = 0u;
    for (uint k = 0u; k < 4u; ++k) own += counts.bins[4u * t + k];
    uint before = scan_group(own), all = group_sums[255] > 0u ? group_sums[255] : 1u;
    for (uint k = 0u; k < 4u; ++k) {
        uint here = counts.bins[4u * t + k];
        float share = float(before) / float(all), slab = share * float(slabs);
        counts.bins[4u * t + k] = min(uint(slab), slabs - 1u);
        before += here;
    }
#elif PASS == 2
    if (t <= slabs) counts.slab_begin[t] = t < slabs ? begin[t * splat_groups] : counts.visible;
#else
    if (t != 0u) return;
    if (only != ALL_SLABS) counts.visible = counts.slab_begin[only + 1u] - counts.slab_begin[only];
    put(0u, groups_for(counts.visible, SORTED));
    put(1u, groups_for(groups_for(counts.visible, SORTED) * 256u, SCANNED));
    put(2u, groups_for(counts.visible, GROUP));
    put(3u, groups_for(groups_for(counts.visible, GROUP), SCANNED));
    put(4u, groups_for(counts.entries, SORTED));
    put(5u, groups_for(groups_for(counts.entries, SORTED) * 256u, SCANNED));
    put(6u, groups_for(counts.entries, GROUP));
#endif
}
