// A pass of a stable sort by eight bits of the keys. No group waits for another: PASS 0 counts the digits of each group's
// keys, which are then added up digit by digit (card_scan.glsl), and PASS 1 moves keys and values to their places. Barriers
// of the whole group cost less than ballots and barriers of subgroups (measured on an H100: 1.6 and 2 times).
layout(local_size_x = 256) in;
layout(std430, binding = 1) readonly buffer KeysIn { uint key_in[]; };
layout(std430, binding = 2) readonly buffer ValuesIn { uint value_in[]; };
layout(std430, binding = 3) writeonly buffer KeysOut { uint key_out[]; };
layout(std430, binding = 4) writeonly buffer ValuesOut { uint value_out[]; };
layout(std430, binding = 5) buffer Digits { uint digit_begin[]; };  // [digit][group]
uniform int shift;
uniform uint base;  // the least key: where all are near each other, few passes tell them apart
uniform int of;  // 1: records, 2: entries

const uint ROUNDS = SORTED / GROUP;  // keys of a thread
const uint WARPS = 8u;               // of 32 threads, each with keys of its own, one after the other
shared uint tally[WARPS * 256u];

uint digit_of(uint key) { return (key - base) >> shift & 255u; }

#if PASS == 0
void main() {
    uint t = gl_LocalInvocationIndex, group = group_number(), n = of == 1 ? counts.visible : counts.entries;
    uint groups = groups_for(n, SORTED);
    if (group >= groups) return;
    for (uint w = 0u; w < WARPS; ++w) tally[w * 256u + t] = 0u;
    barrier();
    for (uint k = 0u; k < ROUNDS; ++k) {
        uint i = group * SORTED + k * GROUP + t;
        if (i < n) atomicAdd(tally[(t >> 5) * 256u + digit_of(key_in[i])], 1u);
    }
    barrier();
    uint sum = 0u;
    for (uint w = 0u; w < WARPS; ++w) sum += tally[w * 256u + t];
    digit_begin[t * groups + group] = sum;
}
#else
shared uint staged[SORTED];  // which threads of a warp have a digit; then keys, then values, in their new order
shared uint first_of[256];   // of a digit among the group's keys in order
shared uint shift_of[256];   // from there to where it goes in the end

void main() {
    uint t = gl_LocalInvocationIndex, group = group_number(), n = of == 1 ? counts.visible : counts.entries;
    uint groups = groups_for(n, SORTED);
    if (group >= groups) return;
    uint lane = t & 31u, warp = t >> 5;
    for (uint w = 0u; w < WARPS; ++w) {
        tally[w * 256u + t] = 0u;
        staged[w * 256u + t] = 0u;
        staged[2048u + w * 256u + t] = 0u;
    }
    barrier();
    uint keys[ROUNDS], place[ROUNDS];
    uint first = group * SORTED + warp * 512u + lane;
    for (uint k = 0u; k < ROUNDS; ++k) {
        uint i = first + k * 32u;
        keys[k] = i < n ? key_in[i] : base - 1u;  // the last of all
    }
    for (uint k = 0u; k < ROUNDS; ++k) {
        // Two sets of masks in turn: one is cleared while the other is used.
        uint digit = warp * 256u + digit_of(keys[k]), mask = (k & 1u) * 2048u + digit;
        atomicOr(staged[mask], 1u << lane);
        barrier();
        uint same = staged[mask], before = tally[digit];
        barrier();
        uint lower = same & ((1u << lane) - 1u);
        place[k] = before + uint(bitCount(lower));
        if (lower == 0u) {
            tally[digit] = before + uint(bitCount(same));
            staged[mask] = 0u;
        }
    }
    barrier();
    uint sum = 0u;
    for (uint w = 0u; w < WARPS; ++w) {
        uint own = tally[w * 256u + t];
        tally[w * 256u + t] = sum;
        sum += own;
    }
    uint begin = scan_group(sum);
    first_of[t] = begin;
    shift_of[t] = digit_begin[t * groups + group] - begin;
    barrier();
    for (uint k = 0u; k < ROUNDS; ++k) {
        uint digit = digit_of(keys[k]);
        place[k] += first_of[digit] + tally[warp * 256u + digit];
        staged[place[k]] = keys[k];
    }
    barrier();
    uint left = min(n - group * SORTED, SORTED);
    uint to[ROUNDS];
    for (uint k = 0u; k < ROUNDS; ++k) {
        uint i = k * GROUP + t, key = staged[i];
        to[k] = shift_of[digit_of(key)] + i;
        if (i < left) key_out[to[k]] = key;
    }
    barrier();
    for (uint k = 0u; k < ROUNDS; ++k) {
        uint i = first + k * 32u;
        staged[place[k]] = i < n ? value_in[i] : 0u;
    }
    barrier();
    for (uint k = 0u; k < ROUNDS; ++k) {
        uint i = k * GROUP + t;
        if (i < left) value_out[to[k]] = staged[i];
    }
}
#endif
