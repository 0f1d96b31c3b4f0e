// The program whose calls fail, and whose folders, pictures and disk go away.
#include <fmt/format.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <map>
#include <mutex>
#include <set>
#include <sstream>
#include <thread>

#include "cli/scene_fixture.h"
#include "support/run_program.h"

namespace astrosplat::test {
namespace {

// One run of --batch in which a call fails, and what is to be true afterwards: a code and a line that say so,
// only whole and right frames, nothing else touched, and a --resume that finishes the sequence. In: which
// call, counted by fault_shim/shim.cpp. Out: complaints, empty where all is well.

/// The calls of shim.cpp.
struct Fault {
    std::string kind;     // "write", ...
    std::int64_t at = 0;  // from 1
    int error = 0;        // errno; take_half, end_process
    bool onward = false;  // all later calls fail too
};
constexpr int take_half = 0, end_process = -1;

/// The program's input, and how it is run.
struct FaultScene {
    std::string output;  // pattern
    int threads = 1;
};

/// Names, relative to a folder, and bytes of all files below it.
using Tree = std::map<std::string, std::string>;

Tree tree_of(const fs::path& folder) {
    Tree tree;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (!entry.is_directory())
            tree[entry.path().lexically_relative(folder).string()] = text_of(entry.path());
    return tree;
}

class FaultRun {
  public:
    /// Writes the scene's files into a new folder, which the destructor removes unless complaints were made.
    FaultRun(const fs::path& folder, const FaultScene& scene);
    ~FaultRun();
    FaultRun(const FaultRun&) = delete;
    FaultRun& operator=(const FaultRun&) = delete;

    /// Runs --batch with more options; with the fault, where there is one. A run that takes longer than a
    /// minute is ended, code -SIGKILL.
    RunResult batch(const std::vector<std::string>& more, const std::optional<Fault>& fault = {}) const;
    RunOptions options(const std::optional<Fault>& fault = {}) const;
    std::vector<std::string> words(const std::vector<std::string>& more) const;
    /// How many calls of each kind the last run with a fault made; empty where it did not end by itself.
    std::map<std::string, std::int64_t> counts() const;
    Tree tree() const { return tree_of(folder_ / "work"); }
    fs::path work() const { return folder_ / "work"; }

    /// Complaints about a run that failed, and about what lies there now. `whole` is the tree of a run
    /// without faults.
    void check_result(const RunResult& result);
    void check_files(const Tree& whole, bool leftovers_allowed);
    /// --resume, which must finish.
    void resume(const Tree& whole, bool leftovers_allowed);
    void complain(const std::string& what) { complaints_ += "  " + what + "\n"; }
    const std::string& complaints() const { return complaints_; }

  private:
    fs::path folder_;
    FaultScene scene_;
    std::string complaints_;
};

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

std::string description_of(const Fault& fault) {
    const char* error = fault.error == take_half     ? "takes half"
                        : fault.error == end_process ? "ends the process"
                                                     : std::strerror(fault.error);
    return fmt::format("{} {}{}: {}", fault.kind, fault.at, fault.onward ? " and all later" : "", error);
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

/// The whole of it for one fault; the complaints.
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
    return description_of(fault) + fmt::format(" ({}, {} threads)\n", scene.output, scene.threads) +
           run.complaints();
}

// Every call of a batch run that can fail does so once: here a fixed choice of about 100 of them, and at
// night of more than a thousand.

struct Point {
    Fault fault;
    FaultScene scene;
};

/// From the number of a point to a number as good as chance, the same on every run.
std::uint64_t hashed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

struct KindOfFault {
    std::string kind;
    std::vector<int> errors;
    int points, nightly_points;
};
const std::vector<KindOfFault> kinds = {
    {"write", {EIO, ENOSPC, take_half}, 24, 300},
    {"open", {EIO, EMFILE, EACCES}, 16, 500},
    {"rename", {EIO, ENOSPC}, 12, 40},
    {"sync", {EIO}, 10, 20},
    {"map", {ENOMEM}, 4, 10},
    {"allocate", {ENOMEM}, 24, 400},
    {"thread", {EAGAIN}, 9, 20},
};

const FaultScene exr{"frames/shot.###.exr", 1}, png{"frames/shot.###.png", 1}, tif{"frames/shot.###.tif", 1};
const std::vector<FaultScene> scenes = {exr, png, tif};

class FaultTest : public FolderTest {
  protected:
    void SetUp() override {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
        GTEST_SKIP() << "a sanitizer takes the memory's functions itself";
#endif
        for (const FaultScene& scene : scenes) {
            FaultRun run(folder / "whole", scene);
            const RunResult result = expect_success(run.batch({}, Fault{"write", 0, EIO, false}));
            ASSERT_EQ(result.err, "");
            whole_[scene.output] = run.tree();
            counts_[scene.output] = run.counts();
            ASSERT_EQ(counts_[scene.output].size(), kinds.size());
            for (const KindOfFault& kind : kinds) EXPECT_GT(counts_[scene.output][kind.kind], 0) << kind.kind;
        }
    }

    /// Spread evenly over the calls of each kind, the place within its part by hash.
    std::vector<Point> points(bool nightly) {
        std::vector<Point> points;
        for (const KindOfFault& kind : kinds)
            for (const FaultScene& scene : scenes) {
                const std::int64_t calls = counts_[scene.output][kind.kind];
                const std::int64_t wanted =
                    (nightly ? kind.nightly_points : kind.points) / std::ssize(scenes);
                const std::int64_t count = std::min(wanted, calls);
                for (std::int64_t i = 0; i < count; ++i) {
                    const std::int64_t begin = i * calls / count, end = (i + 1) * calls / count;
                    const std::uint64_t h = hashed(points.size());
                    const auto at = begin + std::int64_t(h % std::uint64_t(end - begin));
                    Point point{{kind.kind, at + 1, kind.errors[h / 7 % kind.errors.size()], false}, scene};
                    point.fault.onward =
                        kind.kind == "write" && point.fault.error == ENOSPC && h / 64 % 2 == 0;
                    if (h / 256 % 4 == 0 || kind.kind == "thread") point.scene.threads = 3;
                    points.push_back(point);
                }
            }
        return points;
    }

    std::vector<Point> kills(int count) {
        std::vector<Point> points;
        for (int i = 0; i < count; ++i) {
            const FaultScene& scene = scenes[std::size_t(i) % scenes.size()];
            const std::int64_t calls = counts_[scene.output]["write"];
            const auto place = std::int64_t(hashed(1000 + i) % std::uint64_t(calls));
            points.push_back({{"write", place + 1, end_process, false}, scene});
        }
        return points;
    }

    void expect_no_complaints(const std::vector<Point>& points) {
        std::atomic<std::size_t> next{0};
        std::mutex mutex;
        std::string complaints;
        const auto work = [&] {
            for (std::size_t i; (i = next++) < points.size();) {
                const Point& point = points[i];
                const std::string about =
                    complaints_about(point.fault, point.scene, whole_.at(point.scene.output),
                                     folder / fmt::format("point{}", i));
                const std::lock_guard lock(mutex);
                if (!about.empty()) complaints += fmt::format("point{} ", i) + about;
            }
        };
        std::vector<std::thread> threads;
        for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
            threads.emplace_back(work);
        for (std::thread& thread : threads) thread.join();
        EXPECT_EQ(complaints, "");
    }

    std::map<std::string, Tree> whole_;  // by pattern of output
    std::map<std::string, std::map<std::string, std::int64_t>> counts_;
};

TEST_F(FaultTest, AnyCallMayFail) { expect_no_complaints(points(false)); }
TEST_F(FaultTest, AnyCallMayFailNightly) {
    const std::vector<Point> all = points(true);
    EXPECT_GE(all.size(), 1000u);
    expect_no_complaints(all);
}

// A flush that fails may have lost the file, though it looks right now. Folders and the cache may fail.
TEST_F(FaultTest, FramesAndFiguresThatCannotBeFlushedAreFailures) {
    std::map<int, int> codes;
    const std::int64_t calls = counts_[exr.output]["sync"];
    for (std::int64_t at = 1; at <= calls; ++at)
        ++codes[FaultRun(folder / "run", exr).batch({}, Fault{"sync", at, EIO, false}).code];
    EXPECT_EQ(codes[3], 2) << "each of two frames";
    EXPECT_EQ(codes[4], 1) << "the figures";
    EXPECT_EQ(codes[0], calls - 3);
}

TEST_F(FaultTest, KilledWithinAWrite) { expect_no_complaints(kills(20)); }
TEST_F(FaultTest, KilledWithinAWriteNightly) { expect_no_complaints(kills(50)); }

// A bad weekend on a farm: a full disk, a folder and a picture that go away, two programs on one
// sequence, Ctrl-C. Afterwards every frame that exists is right, and --resume finishes.

class Disaster : public FolderTest {
  protected:
    static inline const FaultScene scene{"frames/shot.###.exr", 2};
    static inline const std::vector<std::string> frames = {"-f",      "1-12",       "--resolution",
                                                           "320x240", "--progress", "plain"};
    static inline const std::vector<std::string> missing = {"-f",         "1-12",  "--resolution", "320x240",
                                                            "--progress", "plain", "--resume"};

    Tree undisturbed() const {
        const FaultRun run(folder / "whole", scene);
        expect_success(run.batch(frames));
        return run.tree();
    }
    /// Starts a run and returns once its first frame is there.
    static std::unique_ptr<RunningProgram> started(const FaultRun& run,
                                                   const std::vector<std::string>& more = frames) {
        auto program = std::make_unique<RunningProgram>(run.words(more), run.options());
        program->wait_until_said("saved ");
        return program;
    }
    static std::size_t frame_count(const Tree& tree) {
        return std::size_t(
            std::ranges::count_if(tree, [](const auto& file) { return file.first.starts_with("frames/"); }));
    }
    /// --resume gives all frames of the undisturbed run.
    static void expect_resumed(FaultRun& run, const Tree& whole) {
        expect_success(run.batch(missing));
        run.check_files(whole, false);
        EXPECT_EQ(frame_count(run.tree()), frame_count(whole));
        EXPECT_EQ(run.complaints(), "");
    }
};

TEST_F(Disaster, TheDiskIsFull) {
    const FaultRun whole_run(folder / "whole", scene);
    ASSERT_EQ(whole_run.batch({}).code, 0);
    const Tree whole = whole_run.tree();
    FaultRun run(folder / "full", scene);
    fs::create_directories(run.work() / "frames");
    fs::create_directories(run.work() / "kept");
    // A file system with room for one frame and a half, in a mount namespace of its own.
    const std::size_t room = whole.at("frames/shot.001.exr").size() * 3 / 2 / 4096 * 4096 + 4096;
    const std::string mount = fmt::format("mount -t tmpfs -o size={} none frames", room);
    if (run_program({"/usr/bin/unshare", "-rm", "/bin/sh", "-c", mount}, run.options()).code != 0)
        GTEST_SKIP() << "nothing can be mounted here";
    std::vector<std::string> words = {"/usr/bin/unshare",
                                      "-rm",
                                      "/bin/sh",
                                      "-c",
                                      mount + " || exit 99; \"$@\"; code=$?; cp -a frames/. kept; exit $code",
                                      "sh"};
    for (const std::string& word : run.words({})) words.push_back(word);
    const RunResult result = run_program(words, run.options());
    EXPECT_EQ(result.code, 3) << result.err;
    EXPECT_NE(result.err.find("shot.002.exr: cannot be written: No space left on device"), std::string::npos)
        << result.err;
    const Tree kept = tree_of(run.work() / "kept");
    ASSERT_EQ(kept.size(), 1u) << "nothing but the frame that is done";
    EXPECT_EQ(kept.begin()->first, "shot.001.exr");
    EXPECT_EQ(kept.begin()->second, whole.at("frames/shot.001.exr"));
    fs::remove_all(run.work() / "kept");
    run.resume(whole, false);
    EXPECT_EQ(run.complaints(), "");
}

TEST_F(Disaster, TheFolderGoesAway) {
    const Tree whole = undisturbed();
    FaultRun run(folder / "gone", scene);
    const auto program = started(run);
    std::error_code busy;
    do fs::remove_all(run.work() / "frames", busy);
    while (busy);  // the next frame came into the folder as it was emptied
    const RunResult result = program->wait();
    EXPECT_EQ(result.code, 3) << result.err;
    EXPECT_NE(result.err.find(" failed: 1"), std::string::npos) << result.err;
    run.check_files(whole, false);
    expect_resumed(run, whole);
}

TEST_F(Disaster, ThePictureGoesAway) {
    const Tree whole = undisturbed();
    FaultRun run(folder / "gone", scene);
    const auto program = started(run);
    const fs::path picture = run.work() / "picture.ppm";
    fs::rename(picture, folder / "picture.ppm");
    const RunResult result = program->wait();
    EXPECT_EQ(result.code, 0) << "it was read before the first frame: " << result.err;
    EXPECT_EQ(frame_count(run.tree()), frame_count(whole));
    const RunResult without = run.batch(missing);
    EXPECT_EQ(without.code, 2);
    EXPECT_NE(without.err.find("picture.ppm"), std::string::npos) << without.err;
    fs::rename(folder / "picture.ppm", picture);
    fs::remove(run.work() / "frames/shot.007.exr");
    expect_resumed(run, whole);
}

TEST_F(Disaster, TwoProgramsRenderOneSequence) {
    const Tree whole = undisturbed();
    FaultRun run(folder / "two", scene);
    const RunningProgram first(run.words(missing), run.options()), second(run.words(missing), run.options());
    for (const RunningProgram* program : {&first, &second}) expect_success(program->wait());
    run.check_files(whole, false);
    EXPECT_EQ(frame_count(run.tree()), frame_count(whole));
    expect_resumed(run, whole);
}

TEST_F(Disaster, InterruptsAreHeardSoon) {
    FaultRun run(folder / "stopped", scene);
    const auto program = started(run, {"-f", "1-2000", "--resolution", "1920x1440", "--progress", "plain"});
    program->signal(SIGINT);
    const std::size_t soon = frame_count(run.tree());
    EXPECT_EQ(ended_in_time(*program).code, 130);
    EXPECT_LE(frame_count(run.tree()), soon + 4) << "those that were being made";
    for (const auto& [name, bytes] : tree_of(run.work() / "frames")) EXPECT_NE(name.front(), '.') << name;
}

}  // namespace
}  // namespace astrosplat::test
