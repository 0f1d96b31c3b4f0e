#include "slurm/cluster.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <pwd.h>
#include <sys/socket.h>

#include <chrono>
#include <thread>

namespace astrosplat::test {
namespace fs = std::filesystem;
namespace {

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

/// Ports of loopback that nobody listens on, all different.
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

}  // namespace

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
    // More CPUs than the machine may have (config_overrides), so that several tasks run side by side
    // anywhere.
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

}  // namespace astrosplat::test
