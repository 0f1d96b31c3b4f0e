// --submit slurm on a real Slurm: tasks that are killed half-way, submitted again, give the frames of
// one run here.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <pwd.h>
#include <signal.h>
#include <sys/socket.h>

#include <chrono>
#include <thread>

#include "cli/scene_fixture.h"
#include "support/run_program.h"

namespace astrosplat::test {
namespace {

// A cluster of the test's own: munge, Slurm's controller and one node on loopback, in a temporary folder,
// which end with the test.

using namespace std::chrono_literals;

/// Where Debian and others keep it, also where daemons are not on the PATH; empty without it.
std::string place_of(const std::string& program) {
    for (const char* folder : {"/usr/sbin/", "/usr/bin/", "/usr/local/sbin/", "/usr/local/bin/"})
        if (fs::exists(folder + program)) return folder + program;
    return "";
}

/// Calls done() until it says so; false when that takes longer than anything here may.
template <class Done>
bool wait_for(const Done& done) {
    const auto end = std::chrono::steady_clock::now() + 60s;
    while (!done()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(20ms);
    }
    return true;
}

/// Ports of loopback that nothing listens on, all different.
std::vector<int> free_ports(int count) {
    std::vector<int> sockets, ports;
    for (int i = 0; i < count; ++i) {
        sockets.push_back(socket(AF_INET, SOCK_STREAM, 0));
        sockaddr_in address = {};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof address;
        if (bind(sockets.back(), reinterpret_cast<sockaddr*>(&address), size) != 0 ||
            getsockname(sockets.back(), reinterpret_cast<sockaddr*>(&address), &size) != 0)
            throw std::runtime_error("no free port");
        ports.push_back(ntohs(address.sin_port));
    }
    for (const int one : sockets) close(one);
    return ports;
}

/// Slurm's daemons know themselves by the name up to its first dot.
std::string short_host_name() {
    std::string name(256, '\0');
    gethostname(name.data(), name.size() - 1);
    return name.substr(0, name.find_first_of(std::string(".\0", 2)));
}

class Cluster {
  public:
    /// Starts it; problem() says why that could not be.
    Cluster();
    ~Cluster();
    Cluster(const Cluster&) = delete;
    Cluster& operator=(const Cluster&) = delete;

    /// One line; empty where the cluster runs.
    const std::string& problem() const { return problem_; }

    /// With these variables Slurm's tools find it, NAME=VALUE.
    std::string environment() const { return "SLURM_CONF=" + (folder_ / "slurm.conf").string(); }

    /// One of Slurm's tools, found as daemons are.
    RunResult tool(std::vector<std::string> words) const;

    /// Returns when no job waits or runs; false where that takes longer than any job of a test may.
    bool wait_until_idle() const;

  private:
    class Daemon;
    void write_configuration() const;
    void start(const std::string& name, std::vector<std::string> arguments);
    bool node_is_ready() const;
    std::string last_words() const;

    fs::path folder_;
    std::vector<std::unique_ptr<Daemon>> daemons_;  // ended in reverse
    std::string problem_;
};

/// Ends when it is told to, or when the test's process has died.
class Cluster::Daemon {
  public:
    Daemon(const std::vector<std::string>& words, const RunOptions& options)
        : program_(guarded(words), options) {}
    ~Daemon() {
        program_.signal(SIGTERM);
        if (!wait_for([&] { return !program_.running(); })) program_.signal(SIGKILL);
        program_.wait();
    }
    bool running() const { return program_.running(); }

  private:
    static std::vector<std::string> guarded(std::vector<std::string> words) {
        const std::string setpriv = place_of("setpriv");
        if (!setpriv.empty()) words.insert(words.begin(), {setpriv, "--pdeathsig", "TERM"});
        return words;
    }
    RunningProgram program_;
};

Cluster::Cluster() {
    for (const char* program :
         {"munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "sinfo", "scontrol"})
        if (place_of(program).empty()) problem_ = std::string(program) + " is not installed";
    if (!problem_.empty()) return;
    // In a folder with a short name: those of sockets have at most 107 bytes.
    std::string pattern = "/tmp/astrosplat-slurm-XXXXXX";
    if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
    folder_ = pattern;
    fs::permissions(folder_, fs::perms(0755));
    write_configuration();
    const std::string munge = (folder_ / "munge.").string();
    start("munged",
          {"--foreground", "--force", "--key-file=" + munge + "key", "--socket=" + munge + "socket",
           "--pid-file=" + munge + "pid", "--log-file=" + munge + "log", "--seed-file=" + munge + "seed"});
    if (!wait_for([&] { return fs::exists(munge + "socket") || !daemons_.back()->running(); }) ||
        !daemons_.back()->running()) {
        problem_ = "munged does not start: " + last_words();
        return;
    }
    start("slurmctld", {"-D", "-c"});
    start("slurmd", {"-D", "-N", "node"});
    const auto ended = [&] { return !daemons_[1]->running() || !daemons_[2]->running(); };
    if (!wait_for([&] { return node_is_ready() || ended(); }) || ended())
        problem_ = "Slurm does not start: " + last_words();
}

Cluster::~Cluster() {
    if (daemons_.size() == 3 && problem_.empty()) {
        tool({"scancel", "--state=PENDING"});
        tool({"scancel", "--state=RUNNING"});
        wait_until_idle();
    }
    while (!daemons_.empty()) daemons_.pop_back();
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

void Cluster::write_configuration() const {
    const std::string host = short_host_name(), here = folder_.string();
    const passwd* const user = getpwuid(geteuid());
    const std::vector<int> ports = free_ports(2);
    for (const char* name : {"state", "spool"}) fs::create_directory(folder_ / name);
    write_text(folder_ / "munge.key", std::string(128, 'k'));
    fs::permissions(folder_ / "munge.key", fs::perms(0600));
    // More CPUs than the machine may have (config_overrides), so that several tasks run side
    // by side anywhere.
    write_text(folder_ / "slurm.conf",
               fmt::format(R"(ClusterName=test
SlurmctldHost={0}(127.0.0.1)
SlurmctldPort={1}
SlurmdPort={2}
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
SlurmUser={3}
SlurmdUser={3}
AuthType=auth/munge
AuthInfo=socket={4}/munge.socket
CredType=cred/munge
StateSaveLocation={4}/state
SlurmdSpoolDir={4}/spool
SlurmctldPidFile={4}/slurmctld.pid
SlurmdPidFile={4}/slurmd.pid
SlurmctldLogFile={4}/slurmctld.log
SlurmdLogFile={4}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
SchedulerType=sched/builtin
SchedulerParameters=sched_interval=1,batch_sched_delay=0,sched_min_interval=0
SlurmdParameters=config_overrides
ReturnToService=2
KillWait=1
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
JobCompType=jobcomp/none
NodeName=node NodeHostname={0} NodeAddr=127.0.0.1 Port={2} CPUs=4 RealMemory=16000 State=UNKNOWN
PartitionName=main Nodes=node Default=YES MaxTime=INFINITE State=UP
)",
                           host, ports[0], ports[1], user ? user->pw_name : "root", here));
}

void Cluster::start(const std::string& name, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), place_of(name));
    RunOptions options;
    options.folder = folder_;
    options.environment = {environment()};
    daemons_.push_back(std::make_unique<Daemon>(arguments, options));
}

bool Cluster::node_is_ready() const { return tool({"sinfo", "--noheader", "--format=%T"}).out == "idle\n"; }

std::string Cluster::last_words() const {
    std::string words;
    for (const char* name : {"munge.log", "slurmctld.log", "slurmd.log"}) {
        std::string text = text_of(folder_ / name);
        while (!text.empty() && text.back() == '\n') text.pop_back();
        if (!text.empty()) words += text.substr(text.rfind('\n') + 1) + "; ";
    }
    return words;
}

RunResult Cluster::tool(std::vector<std::string> words) const {
    words[0] = place_of(words[0]);
    RunOptions options;
    options.environment = {environment()};
    return run_program(words, options);
}

bool Cluster::wait_until_idle() const {
    return wait_for([&] { return tool({"squeue", "--noheader"}).out.empty(); });
}

using Words = std::vector<std::string>;

/// Command line of a process, its words separated by NUL; empty when there is none.
std::string command_line(const fs::path& process) { return text_of(process / "cmdline"); }

class Slurm : public SceneTest {
  protected:
    static void SetUpTestSuite() { cluster = std::make_unique<Cluster>(); }
    static void TearDownTestSuite() { cluster.reset(); }

    void SetUp() override {
        if (!cluster->problem().empty()) GTEST_SKIP() << cluster->problem();
    }

    /// In a folder with a name for which shells and Slurm have meanings.
    void move_to(const std::string& name) {
        place = folder / name;
        fs::create_directories(place);
        write_text(place / "picture.ppm", small_picture());
        fs::copy(folder / "stars.pda", place / "stars.pda");
        write_text(place / "scene.toml", R"(astrosplat = 1
[output]
resolution = [320, 240]
samples = 6
frames = "1-40"
path = "frames/shot.####.exr"
[camera]
position = [0.0, 0.0, 9.0]
shutter = 180.0
[[layer]]
name = "gas"
[layer.source]
meshes = [ { mesh = "plane", texture = "picture.ppm" } ]
voxel_size = 0.05
[[layer]]
name = "stars"
[layer.source]
kind = "splats"
file = "stars.pda"
[animation]
"camera.position" = { keys = [[1, [0.0, 0.0, 9.0]], [40, [2.0, 1.0, 8.0]]] }
)");
    }
    RunResult here(Words words) const {
        RunOptions options;
        options.folder = place;
        options.environment = {cluster->environment()};
        return run(std::move(words), options);
    }
    RunResult submit(Words more = {}) const {
        more.insert(more.begin(), {"--submit", "slurm", "scene.toml", "--threads", "1", "--chunk", "10"});
        return here(more);
    }
    std::size_t frames_there() const {
        std::size_t count = 0;
        std::error_code none_yet;
        for (const auto& entry : fs::directory_iterator(place / "frames", none_yet))
            count += entry.path().filename().string().starts_with("shot.");
        return count;
    }
    /// SIGKILL to the program that renders these frames, as when a machine runs out of memory.
    bool kill_program_with(const std::string& frames) const {
        for (const auto& process : fs::directory_iterator("/proc")) {
            const std::string words = command_line(process.path());
            if (words.find((place / "scene.toml").string()) == std::string::npos ||
                words.find('\0' + frames + '\0') == std::string::npos)
                continue;
            return kill(std::stoi(process.path().filename().string()), SIGKILL) == 0;
        }
        return false;
    }
    fs::path frame(int number) const { return place / fmt::format("frames/shot.{:04}.exr", number); }
    /// Throws once nothing waits or runs any more.
    void wait_a_little() const {
        if (cluster->tool({"squeue", "--noheader"}).out.empty())
            throw std::runtime_error("the tasks are over: " + log("0001/1.log") + log("0001/2_1.log"));
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    std::string log(const std::string& name) const { return text_of(place / "frames/slurm" / name); }

    static inline std::unique_ptr<Cluster> cluster;
    fs::path place;
};

TEST_F(Slurm, TasksKilledHalfWayAndSubmittedAgainGiveTheSameFrames) {
    move_to("a  'b' \"c\" $(touch d) `e`\nü");
    ASSERT_EQ(here({"--batch", "scene.toml", "-q", "-o", "local/shot.####.exr", "--no-cache"}).code, 0);

    const RunResult first = expect_success(submit());
    EXPECT_HAS(first.out, "40 frames in 4 tasks submitted as job 2, ");
    // Each when it has written a frame: not before it began, nor after its end.
    while (!fs::exists(frame(11)) || !kill_program_with("--frames=11-20")) wait_a_little();
    while (!fs::exists(frame(1))) wait_a_little();
    cluster->tool({"scancel", "--signal=KILL", "--full", "2_0"});
    cluster->tool({"scancel", "2_2"});
    ASSERT_TRUE(cluster->wait_until_idle());

    const std::size_t done = frames_there();
    EXPECT_GE(done, 2u);
    EXPECT_LT(done, 40u);
    const RunResult status = here({"status", "scene.toml"});
    EXPECT_EQ(status.code, 3);
    EXPECT_NE(status.out.find(fmt::format("\ndone {} of 40: ", done)), std::string::npos) << status.out;
    EXPECT_NE(status.out.find(fmt::format("\nmissing {}: ", 40 - done)), std::string::npos)
        << status.out << "killed programs leave no half frame";
    EXPECT_HAS(status.out, "\nqueue job 2, 4 tasks: ");
    EXPECT_HAS(log("0001/1.log"), "layer gas: ") << "the sets' job";

    const RunResult second = expect_success(submit());
    EXPECT_EQ(second.out.find(fmt::format("{} frames in ", 40 - done)), 0u) << second.out;
    const RunResult third = expect_success(submit());
    EXPECT_HAS(third.out, "in the queue already");
    ASSERT_TRUE(cluster->wait_until_idle());
    EXPECT_EQ(here({"status", "scene.toml"}).code, 0) << here({"status", "scene.toml"}).out;
    EXPECT_EQ(submit().out, "no frame is missing: nothing to submit\n");
    for (int frame = 1; frame <= 40; ++frame) {
        const std::string name = fmt::format("shot.{:04}.exr", frame);
        const std::string local = text_of(place / "local" / name);
        EXPECT_FALSE(local.empty());
        EXPECT_TRUE(text_of(place / "frames" / name) == local)
            << name << " differs from that of the local run";
    }
}

TEST_F(Slurm, TasksDoNotRunWithoutTheirSets) {
    move_to("100% a\\b %j");
    write_text(place / "file", "");
    expect_success(submit({"--cache", "file"}));
    ASSERT_TRUE(cluster->wait_until_idle());
    EXPECT_EQ(frames_there(), 0u);
    const RunResult status = here({"status", "scene.toml"});
    EXPECT_HAS(status.out, ", the sets: FAILED\n");
    EXPECT_HAS(status.out, "4 tasks: 4 CANCELLED\n");
    std::string logs;
    for (const auto& entry : fs::directory_iterator(place / "frames/slurm/0001"))
        if (entry.path().extension() == ".log") logs += text_of(entry.path());
    EXPECT_HAS(logs, "file: cannot create this folder");
}

TEST_F(Slurm, WhatItRefusesLeavesNothing) {
    move_to("plain");
    expect_one_line(submit({"--partition", "elsewhere", "-q"}), 2, "sbatch: error: ");
    EXPECT_FALSE(fs::exists(place / "frames/slurm"));
    EXPECT_EQ(cluster->tool({"squeue", "--noheader"}).out, "");
}

}  // namespace
}  // namespace astrosplat::test
