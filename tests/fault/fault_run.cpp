#include "fault_run.h"

#include <fmt/format.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <set>
#include <sstream>
#include <thread>

#include "cli/scene_fixture.h"

namespace astrosplat::test {
namespace {

const char* const scene_text = R"(astrosplat = 1
[output]
resolution = [32, 24]
frames = "1-2"
[camera]
position = [0.0, 1.0, 9.0]
[[layer]]
name = "gas"
[layer.source]
meshes = [ { mesh = "plane", texture = "picture.ppm" } ]
voxel_size = 0.4
[[layer]]
name = "dust"
[layer.source]
kind = "splats"
file = "dust.pda"
[animation]
"camera.position" = { keys = [[1, [0.0, 1.0, 9.0]], [2, [1.0, 1.0, 8.0]]] }
)";

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

bool contains(const std::string& text, const char* part) { return text.find(part) != text.npos; }

/// Of a name that only a file on its way has.
bool is_leftover(const std::string& name) {
    const std::string file = fs::path(name).filename().string();
    return file.front() == '.' || file.ends_with(".lock") || contains(file, "probe");
}

/// Figures hold times.
bool is_figures(const std::string& name) { return name == "stats.json"; }

RunResult ended_in_time(const RunningProgram& program) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (program.running() && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (program.running()) program.signal(SIGKILL);
    return program.wait();
}

}  // namespace

std::string text_of(const Fault& fault) {
    const char* error = fault.error == take_half     ? "takes half"
                        : fault.error == end_process ? "ends the process"
                                                     : std::strerror(fault.error);
    return fmt::format("{} {}{}: {}", fault.kind, fault.at, fault.onward ? " and all later" : "", error);
}

Tree tree_of(const fs::path& folder) {
    Tree tree;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (!entry.is_directory())
            tree[entry.path().lexically_relative(folder).string()] = text_of(entry.path());
    return tree;
}

FaultRun::FaultRun(const fs::path& folder, const FaultScene& scene) : folder_(folder), scene_(scene) {
    fs::remove_all(folder);
    fs::create_directories(folder / "home");
    write_text(work() / "scene.toml", scene_text);
    write_text(work() / "picture.ppm", small_picture());
    write_text(work() / "dust.pda", cube_of_splats(40));
}

FaultRun::~FaultRun() {
    std::error_code ignored;
    if (complaints_.empty()) fs::remove_all(folder_, ignored);
}

RunOptions FaultRun::options(const std::optional<Fault>& fault) const {
    RunOptions options;
    options.folder = work();
    const std::string home = (folder_ / "home").string();
    options.environment = {"HOME=" + home, "TMPDIR=" + home, "XDG_CACHE_HOME=" + home,
                           "ASTROSPLAT_CACHE=sets"};
    if (!fault) return options;
    // From the working folder: the loader takes a blank in a path for the end of it.
    const std::string shim = fs::relative(ASTROSPLAT_FAULT_SHIM, options.folder).string();
    options.environment.insert(options.environment.end(),
                               {"LD_PRELOAD=" + shim, "ASTROSPLAT_FAULT_KIND=" + fault->kind,
                                fmt::format("ASTROSPLAT_FAULT_AT={}", fault->at),
                                fmt::format("ASTROSPLAT_FAULT_ERROR={}", fault->error),
                                fmt::format("ASTROSPLAT_FAULT_ONWARD={}", fault->onward ? 1 : 0),
                                "ASTROSPLAT_FAULT_COUNT=" + (folder_ / "count").string()});
    return options;
}

std::vector<std::string> FaultRun::words(const std::vector<std::string>& more) const {
    std::vector<std::string> all = {
        ASTROSPLAT_PROGRAM, "--batch", "scene.toml", "-q", "-o",
        scene_.output,      "--stats", "stats.json", "-t", std::to_string(scene_.threads)};
    all.insert(all.end(), more.begin(), more.end());
    return all;
}

RunResult FaultRun::batch(const std::vector<std::string>& more, const std::optional<Fault>& fault) const {
    return ended_in_time(RunningProgram(words(more), options(fault)));
}

std::map<std::string, std::int64_t> FaultRun::counts() const {
    std::map<std::string, std::int64_t> counts;
    std::istringstream in(text_of(folder_ / "count"));
    std::string kind;
    for (std::int64_t number = 0; in >> kind >> number;) counts[kind] = number;
    return counts;
}

void FaultRun::check_result(const RunResult& result) {
    // OpenImageIO 2.4 ends the process by an assertion of its own where some of its memory cannot be had. No
    // exception reaches the program; what lies on the disk must be as good all the same.
    if (contains(result.err, "src/include/OpenImageIO/")) return;
    const std::set<int> documented = {0, 2, 3, 4};
    if (!documented.count(result.code)) complain(fmt::format("code {}", result.code));
    int errors = 0;
    for (const std::string& line : lines_of(result.err)) {
        errors += line.starts_with("astrosplat: error: ");
        if (!line.starts_with("astrosplat: ") || contains(line, "internal error")) complain("says: " + line);
    }
    // Every frame that failed has a line, and then they are counted.
    const bool frames = result.code == 3;
    if (result.code == 0 ? errors != 0 : frames ? errors < 2 || errors > 4 : errors != 1)
        complain(fmt::format("code {} with {} errors: {}", result.code, errors, result.err));
}

void FaultRun::check_files(const Tree& whole, bool leftovers_allowed) {
    for (const auto& [name, bytes] : tree()) {
        const auto known = whole.find(name);
        if (is_leftover(name)) {
            if (!leftovers_allowed) complain(name + " was left");
        } else if (known == whole.end()) {
            complain(name + " should not be there");
        } else if (!is_figures(name) && known->second != bytes) {
            complain(fmt::format("{}: {} bytes, of the whole one's {}, or others", name, bytes.size(),
                                 known->second.size()));
        }
    }
    for (const char* input : {"scene.toml", "picture.ppm", "dust.pda"})
        if (!fs::exists(work() / input)) complain(std::string(input) + " is gone");
    if (!tree_of(folder_ / "home").empty()) complain("something was written at home");
}

void FaultRun::resume(const Tree& whole, bool leftovers_allowed) {
    const RunResult result = batch({"--resume"});
    if (result.code != 0 || !result.err.empty())
        complain(fmt::format("--resume: code {}: {}", result.code, result.err));
    check_files(whole, leftovers_allowed);
    const Tree now = tree();
    for (const auto& [name, bytes] : whole)  // of which sets are not needed where all frames are done
        if (!name.starts_with("sets") && !now.count(name)) complain("--resume: without " + name);
}

std::string complaints_about(const Fault& fault, const FaultScene& scene, const Tree& whole,
                             const fs::path& folder) {
    FaultRun run(folder, scene);
    const RunResult result = run.batch({}, fault);
    const bool killed = fault.error == end_process;
    if (killed ? result.code != -SIGKILL : false)
        run.complain(fmt::format("was not killed: {}", result.code));
    if (!killed) run.check_result(result);
    const bool unremoved = fault.kind == "rename";  // which removing a file is, too
    run.check_files(whole, killed || unremoved);
    if (result.code == 0) {
        const Tree now = run.tree();
        for (const auto& [name, bytes] : whole)
            if (name.starts_with("frames") && !now.count(name)) run.complain("code 0 without " + name);
    }
    if (result.code != 0) run.resume(whole, unremoved);  // else all is there and right
    if (run.complaints().empty()) return "";
    return text_of(fault) + fmt::format(" ({}, {} threads)\n", scene.output, scene.threads) +
           run.complaints();
}

}  // namespace astrosplat::test
