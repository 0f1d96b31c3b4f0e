// Numbers become the sums of those before them. PASS 0: sums of blocks; 1: in one group of threads, sums of those, and the
// total; 2: the numbers.
layout(local_size_x = 256) in;
layout(std430, binding = 1) buffer Numbers { uint number[]; };
layout(std430, binding = 2) buffer Blocks { uint block_sum[]; };
uniform uint fixed_count;  // of numbers; 0: as `of` says
uniform int of;            // 1: digits of records, 2: of entries, 3: groups of records
uniform int total;         // 1: all records are visible, 2: all are entries

uint number_count() {
    if (fixed_count != 0u) return fixed_count;
    if (of == 3) return groups_for(counts.visible, GROUP);
    return 256u * groups_for(of == 1 ? counts.visible : counts.entries, SORTED);
}

void main() {
    uint t = gl_LocalInvocationIndex, n = number_count();
#if PASS == 1
    uint blocks = groups_for(n, SCANNED), sum = 0u;
    for (uint first = 0u; first < blocks; first += GROUP) {
        uint i = first + t, own = i < blocks ? block_sum[i] : 0u;
        uint before = scan_group(own);
        if (i < blocks) block_sum[i] = sum + before;
        sum += group_sums[255];
    }
    if (t != 0u) return;
    if (total == 1) counts.visible = sum;
    if (total == 2) {
        counts.entries_wanted = sum;
        counts.entries = min(sum, counts.entries_room);
    }
#else
    uint group = group_number();
    if (group * SCANNED >= n) return;
    uint first = group * SCANNED + 8u * t, own = 0u;
    uint here[8];
    for (uint k = 0u; k < 8u; ++k) {
        here[k] = first + k < n ? number[first + k] : 0u;
        own += here[k];
    }
    uint before = scan_group(own);
#if PASS == 0
    if (t == 255u) block_sum[group] = group_sums[255];
#else
    before += block_sum[group];
    for (uint k = 0u; k < 8u; ++k) {
        if (first + k < n) number[first + k] = before;
        before += here[k];
    }
#endif
#endif
}
