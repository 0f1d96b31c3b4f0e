// What the passes of the renderer on a card share (app/gl/card.h): how much there is, decided on the card.
layout(std430, binding = 0) buffer Counts {
    uint visible;         // splats that touch the region: records
    uint entries;         // of records in tiles
    uint entries_wanted;  // more than there is room for: the frame is drawn again
    uint entries_room;
    uint area_low, area_high;  // sum of footprints, sixteenths of a square px
    uint lowest, highest;      // keys of depth, of a sample of the splats
    uint first_key, last_key;  // of all records
    uint entries_low, entries_high;  // all that are wanted
    uint bins[1024];           // how many of the sample each has, and in the end to which slab it belongs
    uint slab_begin[33];       // records
} counts;

const uint GROUP = 256u;        // threads of a group
const uint SORTED = 4096u;      // keys that a group sorts
const uint SCANNED = 2048u;     // numbers that a group adds up

// More groups than one dimension can have come in rows.
uint group_number() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
uint groups_for(uint count, uint each) { return (count + each - 1u) / each; }

shared uint group_sums[GROUP];
// The sum of `own` over the threads before this one; the sum over all is then group_sums[255].
uint scan_group(uint own) {
    uint t = gl_LocalInvocationIndex;
    barrier();
    group_sums[t] = own;
    barrier();
    for (uint reach = 1u; reach < GROUP; reach <<= 1) {
        uint before = t >= reach ? group_sums[t - reach] : 0u;
        barrier();
        group_sums[t] += before;
        barrier();
    }
    return group_sums[t] - own;
}
