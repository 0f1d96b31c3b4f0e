// Finds this process's control groups through /proc/self/cgroup, whose lines are "ID:CONTROLLERS:PATH".
#include "core/cgroup.h"

#include <filesystem>
#include <fstream>
#include <sstream>

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

bool lists(const std::string& controllers, const std::string& wanted) {
    std::stringstream names(controllers);
    for (std::string name; std::getline(names, name, ',');)
        if (name == wanted) return true;
    return false;
}

struct Group {
    fs::path root;  // where the hierarchy is mounted
    fs::path path;  // the group below it
};

std::vector<Group> groups_of(const std::string& controller) {
    std::vector<Group> groups;
    std::ifstream lines("/proc/self/cgroup");
    for (std::string line; std::getline(lines, line);) {
        const std::size_t first = line.find(':');
        const std::size_t second = first == std::string::npos ? first : line.find(':', first + 1);
        if (second == std::string::npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        const fs::path path = fs::path(line.substr(second + 1)).relative_path();
        if (controllers.empty())
            groups.push_back({"/sys/fs/cgroup", path});
        else if (lists(controllers, controller))
            groups.push_back({fs::path("/sys/fs/cgroup") / controller, path});
    }
    return groups;
}

}  // namespace

std::vector<std::string> cgroup_values(const std::string& controller, const std::string& file) {
    std::vector<std::string> values;
    for (const Group& group : groups_of(controller)) {
        for (fs::path path = group.path;; path = path.parent_path()) {
            std::ifstream in(group.root / path / file);
            std::stringstream text;
            if (in && text << in.rdbuf()) values.push_back(text.str());
            if (path.empty() || path == path.parent_path()) break;
        }
    }
    return values;
}

}  // namespace astrosplat
