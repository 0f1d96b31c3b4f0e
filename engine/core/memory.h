// Memory is estimated and announced before it is taken. The limits of the control groups (cgroup v1 or v2)
// around this process, which `nproc` and /proc/meminfo do not show, count.
#pragma once

#include "core/standard.h"

namespace astrosplat {

/// "1.25 GiB", "312 MiB", "4 KiB".
std::string human_bytes(double bytes);
/// "12.4 M", "3.1 k", "812".
std::string human_count(double count);
/// "12.4 M splats", "1 splat".
std::string human_count(std::int64_t count, const std::string& noun);

/// Bytes that one memory control group leaves its processes, from the text of its files: the limit ("max", or
/// a very large number, without one), the usage, and memory.stat, whose `cache_field` tells how many of the
/// bytes in use are file pages that the kernel gives up on demand. The largest int64 without a limit.
std::int64_t group_room(const std::string& limit_text, const std::string& usage_text, const std::string& stat,
                        const std::string& cache_field);

/// Bytes this process may still take: free memory of the machine or of its cgroup, or what limit_memory()
/// leaves, whichever is least.
std::int64_t available_memory_bytes();
/// Most bytes that this process is to take; 0: no such limit. What is taken already stays. `set_by`, which
/// outlives the process: where a person sets it, for messages.
void limit_memory(std::int64_t bytes, const char* set_by = "--memory");
/// Largest resident size of this process so far.
std::int64_t peak_memory_bytes();
/// Resident size of this process now, without what was freed and is lent to the system (core/buffer).
std::int64_t resident_memory_bytes();

/// Hands back to the system what the C library keeps of freed memory: its heaps, one a thread, are full of
/// holes after a while and do not shrink by themselves. Takes some milliseconds.
void return_freed_memory();

/// From now on the C library keeps no more than some MB of freed memory at the end of each heap. By itself it
/// comes to keep up to 64 MB there, once large blocks were freed, which return_freed_memory() cannot hand
/// back. For programs that run for hours.
void keep_little_freed_memory();

/// Announces `bytes` for `what` (at detail level), and throws NotEnoughMemory with one line that states both
/// figures when they exceed available_memory_bytes(), and with a limit of its own what that would have to be.
void claim_memory(std::int64_t bytes, const std::string& what);

/// The contents of `file` (such as "cpu.max") in this process's group of `controller` ("cpu", "memory") and
/// in all groups above it, innermost first; groups without the file are left out. v2 and v1 name their files
/// differently, so a name found tells the version. Empty where there are no control groups.
std::vector<std::string> cgroup_values(const std::string& controller, const std::string& file);

}  // namespace astrosplat
