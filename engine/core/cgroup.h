// What the control groups (v1 or v2) around this process say: limits that `nproc` and /proc/meminfo
// do not show.
#pragma once

#include <string>
#include <vector>

namespace astrosplat {

/// The contents of `file` (such as "cpu.max") in this process's group of `controller` ("cpu", "memory") and
/// in all groups above it, innermost first; groups without the file are left out. v2 and v1 name their files
/// differently, so a name found tells the version. Empty where there are no control groups.
std::vector<std::string> cgroup_values(const std::string& controller, const std::string& file);

}  // namespace astrosplat
