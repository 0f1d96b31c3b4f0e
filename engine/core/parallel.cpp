// The thread pool: jobs in a list, chunks handed out by an atomic counter. Every thread that calls a loop
// works on its own job as worker 0, and the pool's threads (worker 1, 2, ...) help whoever has chunks left,
// so that loops called from several threads at once share the pool and none waits for another.
// Names for Highway's run-time targets. A choice enables that target and all lesser ones, so that a kernel
// compiled without it falls to the next below.
#include "core/parallel.h"

#include <fmt/format.h>
#include <hwy/targets.h>
#include <sched.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include <atomic>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>

#include "core/error.h"
#include "core/memory.h"
#include "core/text.h"

namespace astrosplat {
namespace {

using Body = std::function<void(std::int64_t, std::int64_t, int)>;

/// How this thread computes with floats: x86's MXCSR, Arm's FPCR.
std::uint64_t float_control() {
#if defined(__SSE2__)
    return _mm_getcsr();
#elif defined(__aarch64__)
    std::uint64_t control;
    asm volatile("mrs %0, fpcr" : "=r"(control));
    return control;
#else
    return 0;
#endif
}
void set_float_control([[maybe_unused]] std::uint64_t control) {
#if defined(__SSE2__)
    _mm_setcsr(unsigned(control));
#elif defined(__aarch64__)
    asm volatile("msr fpcr, %0" : : "r"(control));
#endif
}
#if defined(__SSE2__)
constexpr std::uint64_t zero_denormals = 0x8040;  // flush to zero, denormals are zeros
#else
constexpr std::uint64_t zero_denormals = 1u << 24;  // FZ
#endif

/// Of a thread, or of the loop that it works for; null: nothing asks it to stop.
thread_local const std::atomic<bool>* stop_loops = nullptr;

struct Job {
    std::int64_t count;
    std::int64_t chunk;
    const Body& body;
    std::uint64_t control = float_control();          // its caller's
    const std::atomic<bool>* cancelled = stop_loops;  // its caller's
    std::atomic<std::int64_t> next{0};                // first item not handed out
    int helpers = 0;                                  // pool threads inside; guarded by the pool's mutex
    std::exception_ptr error{};                       // guarded by the pool's mutex

    bool exhausted() const { return next.load(std::memory_order_relaxed) >= count; }
};

// The worker number of a thread that is inside a loop, -1 outside.
thread_local int current_worker = -1;

void check_loop() { Progress{{}, stop_loops}.check(); }

class Pool {
  public:
    ~Pool() { stop(); }

    int size() {
        const std::lock_guard lock(mutex_);
        if (size_ == 0) size_ = available_threads();
        return size_;
    }

    void resize(int threads) {
        stop();
        const std::lock_guard lock(mutex_);
        size_ = threads;
    }

    void run(Job& job) {
        start();
        {
            const std::lock_guard lock(mutex_);
            jobs_.push_back(&job);
        }
        wake_.notify_all();
        work(job, 0);
        std::unique_lock lock(mutex_);
        jobs_.erase(std::ranges::find(jobs_, &job));
        idle_.wait(lock, [&] { return job.helpers == 0; });
        if (job.error) std::rethrow_exception(job.error);
    }

  private:
    void start() {
        const std::lock_guard lock(mutex_);
        try {
            while (int(threads_.size()) + 1 < size_) {
                const int worker = int(threads_.size()) + 1;
                threads_.emplace_back([this, worker] { serve(worker); });
            }
        } catch (const std::system_error&) {  // the system has no more: those that are there do the work
        }
    }

    void stop() {
        {
            const std::lock_guard lock(mutex_);
            stopping_ = true;
        }
        wake_.notify_all();
        for (std::thread& thread : threads_) thread.join();
        threads_.clear();
        stopping_ = false;
    }

    // Called with the mutex held: the open job with the fewest helpers.
    Job* pick() {
        Job* best = nullptr;
        for (Job* job : jobs_)
            if (!job->exhausted() && (!best || job->helpers < best->helpers)) best = job;
        return best;
    }

    void serve(int worker) {
        std::unique_lock lock(mutex_);
        for (;;) {
            Job* job = nullptr;
            wake_.wait(lock, [&] { return stopping_ || (job = pick()) != nullptr; });
            if (stopping_) return;
            ++job->helpers;
            lock.unlock();
            work(*job, worker);
            lock.lock();
            if (--job->helpers == 0) idle_.notify_all();
        }
    }

    void work(Job& job, int worker) {
        const std::uint64_t control = float_control();
        const auto* const stop = std::exchange(stop_loops, job.cancelled);
        set_float_control(job.control);
        current_worker = worker;
        try {
            for (;;) {
                const std::int64_t begin = job.next.fetch_add(job.chunk, std::memory_order_relaxed);
                if (begin >= job.count) break;
                check_loop();
                job.body(begin, std::min(begin + job.chunk, job.count), worker);
            }
        } catch (...) {
            job.next.store(job.count, std::memory_order_relaxed);
            const std::lock_guard lock(mutex_);
            if (!job.error) job.error = std::current_exception();
        }
        current_worker = -1;
        stop_loops = stop;
        set_float_control(control);
    }

    std::mutex mutex_;
    std::condition_variable wake_;  // a job was added, or stop
    std::condition_variable idle_;  // a job lost its last helper
    std::vector<Job*> jobs_;
    std::vector<std::thread> threads_;
    int size_ = 0;  // callers included; 0: not yet asked for
    bool stopping_ = false;
};

Pool& pool() {
    static Pool the_pool;
    return the_pool;
}

int affinity_threads() {
    for (int cpus = 1024; cpus <= (1 << 20); cpus *= 2) {  // the kernel's mask may be wider than cpu_set_t
        cpu_set_t* set = CPU_ALLOC(cpus);
        if (!set) break;
        const std::size_t size = CPU_ALLOC_SIZE(cpus);
        const bool got = sched_getaffinity(0, size, set) == 0;
        const int count = got ? CPU_COUNT_S(size, set) : 0;
        CPU_FREE(set);
        if (got) return count;
    }
    return int(std::thread::hardware_concurrency());
}

// Cores granted by "QUOTA PERIOD" in microseconds, rounded up; `most` without a limit ("max", -1).
int quota_threads(std::string_view quota, std::string_view period, int most) {
    const auto granted = parse_int64(trim(quota));
    const auto per = parse_int64(trim(period));
    if (!granted || !per || *granted <= 0 || *per <= 0) return most;
    return int(std::clamp<std::int64_t>((*granted + *per - 1) / *per, 1, most));
}

int quota_of_groups(int most) {
    for (const std::string& value : cgroup_values("cpu", "cpu.max")) {
        const std::size_t blank = value.find(' ');
        if (blank != std::string::npos)
            most = quota_threads(value.substr(0, blank), value.substr(blank), most);
    }
    const std::vector<std::string> quotas = cgroup_values("cpu", "cpu.cfs_quota_us");
    const std::vector<std::string> periods = cgroup_values("cpu", "cpu.cfs_period_us");
    for (std::size_t i = 0; i < std::min(quotas.size(), periods.size()); ++i)
        most = quota_threads(quotas[i], periods[i], most);
    return most;
}

void run_alone(std::int64_t count, std::int64_t chunk, const Body& body, int worker) {
    for (std::int64_t begin = 0; begin < count; begin += chunk) {
        check_loop();
        body(begin, std::min(begin + chunk, count), worker);
    }
}

struct Target {
    const char* name;
    std::int64_t bits;  // Highway's; a lower bit is a better target
};

// Highway 1.0 has no SSE2 target of its own: its portable fallback, compiled for the baseline of
// x86-64, is that.
constexpr std::array<Target, 4> targets = {
    {{"avx512", HWY_AVX3}, {"avx2", HWY_AVX2}, {"sse4", HWY_SSE4}, {"sse2", HWY_EMU128 | HWY_SCALAR}}};

// The best that the processor can do, whatever was chosen before.
std::int64_t detected() {
    static const std::int64_t bits = hwy::SupportedTargets() | HWY_STATIC_TARGET;
    return bits;
}

bool compiled_and_supported(const Target& target) { return (target.bits & HWY_TARGETS & detected()) != 0; }

void enable(std::int64_t bits) {
    hwy::SetSupportedTargetsForTest(bits);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace

int available_threads() { return std::max(1, quota_of_groups(std::max(1, affinity_threads()))); }

DenormalsAreZero::DenormalsAreZero() : before_(float_control()) {
    set_float_control(before_ | zero_denormals);
}
DenormalsAreZero::~DenormalsAreZero() { set_float_control(before_); }

StoppableLoops::StoppableLoops(const Progress& progress)
    : before_(std::exchange(stop_loops, progress.cancelled)) {}
StoppableLoops::~StoppableLoops() { stop_loops = before_; }

void set_thread_count(int threads) { pool().resize(std::max(0, threads)); }

int thread_count() { return pool().size(); }

void parallel_chunks(std::int64_t count, std::int64_t chunk, const Body& body) {
    if (count <= 0) return;
    chunk = std::clamp<std::int64_t>(chunk, 1, count);
    if (current_worker >= 0) return run_alone(count, chunk, body, current_worker);
    if (count <= chunk || pool().size() == 1) return run_alone(count, chunk, body, 0);
    Job job{count, chunk, body};
    pool().run(job);
}

void parallel_for(std::int64_t count, const std::function<void(std::int64_t, int)>& body) {
    parallel_chunks(count, 1, [&](std::int64_t begin, std::int64_t, int worker) { body(begin, worker); });
}

void parallel_parts(std::size_t count, const Progress& progress,
                    const std::function<void(std::size_t part)>& body) {
    std::vector<std::string> errors(count);
    std::atomic<std::size_t> done{0};
    parallel_each(count, 1, [&](std::size_t part) {
        progress.check();
        try {
            body(part);
        } catch (const InputError& error) {
            errors[part] = error.what();
        }
        progress.at(double(++done) / double(count));
    });
    for (const std::string& error : errors)
        if (!error.empty()) throw InputError(error);
}

void set_vector_target(const std::string& name) {
    const std::int64_t supported = detected();
    if (name == "best") return enable(supported);
    std::int64_t not_above = 0;
    for (auto target = targets.rbegin(); target != targets.rend(); ++target) {
        not_above |= target->bits & supported;
        if (name == target->name && compiled_and_supported(*target)) return enable(not_above);
    }
    bad_input("vector target",
              fmt::format("one that this processor has (best, {})", fmt::join(vector_targets(), ", ")),
              "'" + name + "'");
}

void use_vector_target_of_environment() {
    const char* name = std::getenv("ASTROSPLAT_VECTOR_TARGET");
    if (!name || !*name) return;
    try {
        set_vector_target(name);
    } catch (const InputError& error) {
        throw InputError(fmt::format("ASTROSPLAT_VECTOR_TARGET: {}", error.what()));
    }
}

std::vector<std::string> vector_targets() {
    std::vector<std::string> names;
    for (const Target& target : targets)
        if (compiled_and_supported(target)) names.emplace_back(target.name);
    return names;
}

std::string vector_target() {
    detected();
    const std::int64_t enabled = hwy::SupportedTargets();
    for (const Target& target : targets)
        if (target.bits & HWY_TARGETS & enabled) return target.name;
    return targets.back().name;
}

}  // namespace astrosplat
