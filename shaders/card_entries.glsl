// Entries: a tile and a record each, in the order of depth. PASS 0: how many tiles each group of 256 records touches; 1: the
// entries, a thread each; 2: no tile has any; 3: where each tile's begin, slab by slab, once they are sorted by tile.
layout(local_size_x = 256) in;
uniform int tile_columns;
uniform uint tile_count, slabs;
#if PASS < 2
layout(std430, binding = 1) readonly buffer Order { uint record_at[]; };  // by depth
// Of a record: its first column | row << 16, and its last.
layout(std430, binding = 2) readonly buffer Rects { uvec2 rect_of[]; };
layout(std430, binding = 3) buffer Begins { uint group_begin[]; };
layout(std430, binding = 4) writeonly buffer EntryTiles { uint entry_tile[]; };
layout(std430, binding = 5) writeonly buffer EntryRecords { uint entry_record[]; };

shared uvec2 rects[GROUP];
shared uint records[GROUP];

uvec2 size_of(uvec2 rect) {
    return uvec2((rect.y & 0xffffu) - (rect.x & 0xffffu) + 1u, (rect.y >> 16) - (rect.x >> 16) + 1u);
}

void main() {
    uint t = gl_LocalInvocationIndex, group = group_number(), i = group * GROUP + t;
    if (group * GROUP >= counts.visible) return;
    uint own = 0u;
    if (i < counts.visible) {
        records[t] = record_at[i];
        rects[t] = rect_of[records[t]];
        uvec2 size = size_of(rects[t]);
        own = size.x * size.y;
    }
    scan_group(own);
    uint all = group_sums[255];
#if PASS == 0
    if (t == 255u) {
        group_begin[group] = all;
        uint before = atomicAdd(counts.entries_low, all);
        if (before + all < before) atomicAdd(counts.entries_high, 1u);
    }
#else
    for (uint e = t; e < all; e += GROUP) {
        uint lo = 0u, hi = 255u;  // the record whose entry it is: the first whose sum is beyond
        while (lo < hi) {
            uint middle = (lo + hi) >> 1;
            if (group_sums[middle] > e)
                hi = middle;
            else
                lo = middle + 1u;
        }
        uint within = e - (lo == 0u ? 0u : group_sums[lo - 1u]), wide = size_of(rects[lo]).x;
        uint column = (rects[lo].x & 0xffffu) + within % wide, row = (rects[lo].x >> 16) + within / wide;
        uint at = group_begin[group] + e;
        if (at < counts.entries_room) {
            entry_tile[at] = row * uint(tile_columns) + column;
            entry_record[at] = records[lo];
        }
    }
#endif
}
#else
layout(std430, binding = 1) readonly buffer EntryTiles { uint entry_tile[]; };
layout(std430, binding = 2) writeonly buffer Ranges { uint range[]; };  // [tile][slab], and one more
layout(std430, binding = 3) readonly buffer EntryRecords { uint entry_record[]; };

// Of a record: the last slab that begins at or before it.
uint slab_of(uint record) {
    uint lo = 0u, hi = slabs - 1u;
    while (lo < hi) {
        uint middle = (lo + hi + 1u) >> 1;
        if (counts.slab_begin[middle] <= record)
            lo = middle;
        else
            hi = middle - 1u;
    }
    return lo;
}

void main() {
    uint i = group_number() * GROUP + gl_LocalInvocationIndex;
#if PASS == 2
    if (i < (slabs + 1u) * tile_count) range[i] = 0u;
#else
    if (i >= counts.entries) return;
    uint tile = entry_tile[i], at = tile * (slabs + 1u), slab = slab_of(entry_record[i]);
    bool first = i == 0u || entry_tile[i - 1u] != tile;
    bool last = i + 1u == counts.entries || entry_tile[i + 1u] != tile;
    uint next = first ? 0u : slab_of(entry_record[i - 1u]) + 1u;  // the first slab that begins here
    for (uint s = next; s <= slab; ++s) range[at + s] = i;
    if (last)
        for (uint s = slab + 1u; s <= slabs; ++s) range[at + s] = i + 1u;
#endif
}
#endif
