// How much memory there is, and how it is written in messages. This process's control groups are found
// through /proc/self/cgroup, whose lines are "ID:CONTROLLERS:PATH".
#include "core/memory.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <atomic>
#include <fstream>

#include "core/error.h"
#include "core/log.h"
#include "core/text.h"

namespace astrosplat {
namespace {

constexpr std::int64_t unlimited = std::numeric_limits<std::int64_t>::max();

std::atomic<std::int64_t> own_limit{0};               // 0: none
std::atomic<const char*> own_limit_name{"--memory"};  // where a person sets it

std::int64_t room_in_own_limit() {
    const std::int64_t limit = own_limit;
    return limit > 0 ? std::max<std::int64_t>(0, limit - resident_memory_bytes()) : unlimited;
}

// Three significant digits, without trailing zeros after the point: 1.25, 12.4, 312, 4.
std::string three_digits(double value) {
    const int decimals = value < 9.995 ? 2 : value < 99.95 ? 1 : 0;
    std::string text = fmt::format("{:.{}f}", value, decimals);
    if (decimals == 0) return text;
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
}

std::string human(double value, double step, const char* const (&units)[5]) {
    int unit = 0;
    while (unit < 4 && std::fabs(value) >= step * 0.9995) {
        value /= step;
        ++unit;
    }
    const std::string text = three_digits(value);
    return *units[unit] ? text + " " + units[unit] : text;
}

// Finds "name   123" at the start of a line; -1 without it.
std::int64_t field(std::string_view text, std::string_view name) {
    std::size_t at = text.find(name);
    while (at != text.npos && at > 0 && text[at - 1] != '\n') at = text.find(name, at + 1);
    if (at == text.npos) return -1;
    at = text.find_first_of("0123456789", at + name.size());
    if (at == text.npos) return -1;
    const std::size_t end = text.find_first_not_of("0123456789", at);
    return parse_int64(text.substr(at, end == text.npos ? end : end - at)).value_or(-1);
}

// Empty where there is none.
std::string text_of(const std::string& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::int64_t machine_available_bytes() {
    const std::int64_t kib = field(text_of("/proc/meminfo"), "MemAvailable:");
    return kib < 0 ? unlimited : kib * 1024;
}

// The least room in this group and those above it.
std::int64_t least_group_room(const char* limit_file, const char* usage_file, const char* cache_field) {
    const auto limits = cgroup_values("memory", limit_file);
    const auto usages = cgroup_values("memory", usage_file);
    const auto stats = cgroup_values("memory", "memory.stat");
    std::int64_t least = unlimited;
    for (std::size_t i = 0; i < std::min(limits.size(), usages.size()); ++i)
        least =
            std::min(least, group_room(limits[i], usages[i], i < stats.size() ? stats[i] : "", cache_field));
    return least;
}

bool lists(const std::string& controllers, const std::string& wanted) {
    return ("," + controllers + ",").find("," + wanted + ",") != std::string::npos;
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

std::string human_bytes(double bytes) { return human(bytes, 1024.0, {"B", "KiB", "MiB", "GiB", "TiB"}); }
std::string human_count(double count) { return human(count, 1000.0, {"", "k", "M", "G", "T"}); }

std::string human_count(std::int64_t count, const std::string& noun) {
    return human_count(double(count)) + " " + noun + (count == 1 ? "" : "s");
}

std::int64_t group_room(const std::string& limit_text, const std::string& usage_text, const std::string& stat,
                        const std::string& cache_field) {
    const std::optional<std::int64_t> limit = parse_int64(trim(limit_text));
    const std::optional<std::int64_t> usage = parse_int64(trim(usage_text));
    if (!limit || !usage) return unlimited;
    const std::int64_t cache = std::max<std::int64_t>(0, field(stat, cache_field));
    // memory.stat lags behind the usage, so the cache may be the larger one; and the limit of v1 without a
    // limit is so large that nothing can be added to it.
    return std::max<std::int64_t>(0, *limit - std::max<std::int64_t>(0, *usage - cache));
}

void limit_memory(std::int64_t bytes, const char* set_by) {
    own_limit = bytes;
    own_limit_name = set_by;
}

std::int64_t available_memory_bytes() {
    const std::int64_t v2 = least_group_room("memory.max", "memory.current", "inactive_file");
    const std::int64_t v1 =
        least_group_room("memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file");
    return std::min({machine_available_bytes(), v2, v1, room_in_own_limit()});
}

std::int64_t peak_memory_bytes() {
    // getrusage() also counts the program that started this one: Linux carries its size over exec.
    // Read without an allocation: it is asked for when memory may be short.
    std::array<char, 4096> status{};
    const int file = ::open("/proc/self/status", O_RDONLY | O_CLOEXEC);
    if (file < 0) return 0;
    const ssize_t size = ::read(file, status.data(), status.size());
    ::close(file);
    const std::string_view text(status.data(), std::size_t(std::max<ssize_t>(0, size)));
    return std::max<std::int64_t>(0, field(text, "VmHWM:")) * 1024;
}

std::int64_t resident_memory_bytes() {
    const std::string rollup = text_of("/proc/self/smaps_rollup");
    const std::int64_t resident = field(rollup, "Rss:"), lent = field(rollup, "LazyFree:");
    if (resident >= 0) return 1024 * (resident - std::max<std::int64_t>(0, lent));
    std::ifstream in("/proc/self/statm");  // before Linux 4.14
    std::int64_t size = 0, pages = 0;
    in >> size >> pages;
    return pages * sysconf(_SC_PAGESIZE);
}

void return_freed_memory() {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

void keep_little_freed_memory() {
#ifdef __GLIBC__
    constexpr int most = 4 << 20;
    mallopt(M_TRIM_THRESHOLD, most);
    mallopt(M_MMAP_THRESHOLD, most);  // what is larger goes back at once
#endif
}

void claim_memory(std::int64_t bytes, const std::string& what) {
    const auto text = [](std::int64_t n) { return human_bytes(double(n)); };
    const std::string need = text(bytes);
    const std::int64_t available = available_memory_bytes(), limit = own_limit;
    if (bytes > available) {
        const bool own = limit > 0 && available >= room_in_own_limit();
        throw NotEnoughMemory(
            fmt::format("{} needs {} of memory, but only {} are available{}", what, need, text(available),
                        own ? fmt::format(" of the {} that {} allows; this takes {} in all", text(limit),
                                          own_limit_name.load(), text(resident_memory_bytes() + bytes))
                            : ""));
    }
    log_detail(fmt::format("{} takes {} of memory", what, need));
}

std::vector<std::string> cgroup_values(const std::string& controller, const std::string& file) {
    std::vector<std::string> values;
    for (const Group& group : groups_of(controller)) {
        // As text: where memory ends, libstdc++ 12's paths free theirs twice.
        std::string path = group.path.string();
        for (path.insert(0, path.empty() ? "" : "/");; path.resize(path.rfind('/'))) {
            std::string text = text_of(group.root.string() + path + "/" + file);
            if (!text.empty()) values.push_back(std::move(text));
            if (path.empty()) break;
        }
    }
    return values;
}

}  // namespace astrosplat
