// Preloaded into a program: counts its calls of some kinds from the start of main() on, and lets one of them
// fail, fall short or end the process. In: the environment, see below. Out: lines "KIND NUMBER", written when
// the program ends by itself.
//   ASTROSPLAT_FAULT_KIND    write, open, rename, sync, map, allocate, thread
//   ASTROSPLAT_FAULT_AT      which call, from 1; 0: none
//   ASTROSPLAT_FAULT_ERROR   errno of the call; 0: a write takes half; -1: SIGKILL, after half a write
//   ASTROSPLAT_FAULT_ONWARD  1: all later calls fail too
//   ASTROSPLAT_FAULT_COUNT   a file for the numbers of calls
// Calls of the standard library and others on the program's behalf count as well; what the dynamic linker
// does, with the constructors of the libraries that it loads, and what goes to stdin, stdout and stderr, does
// not: no program could handle that. Nor does the memory that libcrypto takes for itself: version 3.0 crashes
// where its own set-up gets none.
#include <dlfcn.h>
#include <fcntl.h>
#include <link.h>
#include <pthread.h>
#include <signal.h>
#include <sys/auxv.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

// glibc's allocator behind malloc, whose own names are taken below.
extern "C" void* __libc_malloc(size_t);
extern "C" void* __libc_calloc(size_t, size_t);
extern "C" void* __libc_realloc(void*, size_t);
extern "C" void* __libc_memalign(size_t, size_t);

namespace {

enum class Kind { write, open, rename, sync, map, allocate, thread, none };
constexpr const char* kind_names[] = {"write", "open", "rename", "sync", "map", "allocate", "thread"};
constexpr int kinds = 7;
constexpr int take_half = 0, end_process = -1;

// Set before main() by one thread, read by all.
Kind failing = Kind::none;
long fail_at = 0;
int failure = EIO;
bool onward = false;
const char* count_file = nullptr;
std::atomic<bool> counting{false};
std::atomic<long> calls[kinds];
thread_local bool loading = false;  // a library
std::uintptr_t linker_begin = 0, linker_end = 0, crypto_begin = 0, crypto_end = 0;

long number_of(const char* name, long otherwise) {
    const char* text = getenv(name);
    return text ? strtol(text, nullptr, 10) : otherwise;
}

/// dl_iterate_phdr: the code of libcrypto.
int find_libcrypto(dl_phdr_info* info, size_t, void*) {
    if (!info->dlpi_name || !strstr(info->dlpi_name, "libcrypto.so")) return 0;
    for (int i = 0; i < info->dlpi_phnum; ++i) {
        const auto& part = info->dlpi_phdr[i];
        if (part.p_type != PT_LOAD || (part.p_flags & PF_X) == 0) continue;
        crypto_begin = info->dlpi_addr + part.p_vaddr;
        crypto_end = crypto_begin + part.p_memsz;
    }
    return 1;
}

void read_environment() {
    const char* kind = getenv("ASTROSPLAT_FAULT_KIND");
    for (int i = 0; kind && i < kinds; ++i)
        if (strcmp(kind, kind_names[i]) == 0) failing = static_cast<Kind>(i);
    fail_at = number_of("ASTROSPLAT_FAULT_AT", 0);
    failure = int(number_of("ASTROSPLAT_FAULT_ERROR", EIO));
    onward = number_of("ASTROSPLAT_FAULT_ONWARD", 0) != 0;
    count_file = getenv("ASTROSPLAT_FAULT_COUNT");
    linker_begin = getauxval(AT_BASE);
    dl_iterate_phdr(find_libcrypto, nullptr);
    linker_end =
        linker_begin + (std::uintptr_t{1} << 19);  // larger than it is, smaller than the gap behind it
}

/// Counts a call, and says whether it is to fail.
bool fails(Kind kind) {
    if (loading || !counting.load(std::memory_order_relaxed)) return false;
    const long call = ++calls[int(kind)];
    return kind == failing && fail_at > 0 && (call == fail_at || (onward && call > fail_at));
}

/// Ends the process or sets errno; the call then returns its error.
void fail() {
    if (failure == end_process) kill(getpid(), SIGKILL);
    errno = failure;
}

bool fails_with_errno(Kind kind) {
    if (!fails(kind)) return false;
    fail();
    return true;
}

bool is_excepted(const void* caller) {
    const auto at = reinterpret_cast<std::uintptr_t>(caller);
    return (at >= linker_begin && at < linker_end) || (at >= crypto_begin && at < crypto_end);
}

void write_count() {
    counting = false;
    if (!count_file) return;
    char text[400];
    int size = 0;
    for (int i = 0; i < kinds; ++i)
        size += snprintf(text + size, sizeof text - static_cast<size_t>(size), "%s %ld\n", kind_names[i],
                         calls[i].load());
    const auto file = syscall(SYS_openat, AT_FDCWD, count_file, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (file < 0) return;
    (void)!syscall(SYS_write, file, text, size);
    syscall(SYS_close, file);
}

/// A write of `size` bytes; `rest` does the system call with as many as it is told.
template <class Write>
ssize_t written(int file, size_t size, Write write) {
    if (file <= STDERR_FILENO || !fails(Kind::write)) return write(size);
    if (failure == take_half && size > 1) return write(size / 2);
    if (failure == end_process) (void)!write(size / 2);
    if (failure == take_half) return write(size);
    fail();
    return -1;
}

using Main = int (*)(int, char**, char**);
Main program_main = nullptr;

int counted_main(int argc, char** argv, char** environment) {
    atexit(write_count);
    counting = true;
    return program_main(argc, argv, environment);
}

template <class Function>
Function next(const char* name) {
    return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

void* allocated(size_t size, size_t alignment, const void* caller) {
    if (!is_excepted(caller) && fails_with_errno(Kind::allocate)) return nullptr;
    return alignment > 0 ? __libc_memalign(alignment, size) : __libc_malloc(size);
}

int opened(int folder, const char* path, int flags, mode_t mode) {
    if (fails_with_errno(Kind::open)) return -1;
    return int(syscall(SYS_openat, folder, path, flags, mode));
}

mode_t mode_of(int flags, va_list arguments) {
    const bool has_mode = (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE;
    return has_mode ? va_arg(arguments, mode_t) : 0;
}

}  // namespace

extern "C" {

int __libc_start_main(Main main, int argc, char** argv, void (*init)(), void (*fini)(), void (*rtld_fini)(),
                      void* stack_end) {
    read_environment();
    program_main = main;
    using Start = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
    return next<Start>("__libc_start_main")(counted_main, argc, argv, init, fini, rtld_fini, stack_end);
}

void* dlopen(const char* file, int mode) {
    static const auto real = next<void* (*)(const char*, int)>("dlopen");
    const bool before = loading;
    loading = true;
    void* const library = real(file, mode);
    loading = before;
    return library;
}

// --- write ---
ssize_t write(int file, const void* bytes, size_t size) {
    return written(file, size, [&](size_t part) { return syscall(SYS_write, file, bytes, part); });
}
ssize_t pwrite(int file, const void* bytes, size_t size, off_t offset) {
    return written(file, size, [&](size_t part) { return syscall(SYS_pwrite64, file, bytes, part, offset); });
}
ssize_t pwrite64(int file, const void* bytes, size_t size, off64_t offset) {
    return pwrite(file, bytes, size, offset);
}
ssize_t writev(int file, const iovec* parts, int count) {
    return written(file, 2, [&](size_t part) {
        return syscall(SYS_writev, file, parts, part == 2 ? count : (count + 1) / 2);
    });
}

// --- open ---
// With the mode among the arguments where the flags ask for one.
#define RETURN_OPENED(folder)                      \
    va_list arguments;                             \
    va_start(arguments, flags);                    \
    const mode_t mode = mode_of(flags, arguments); \
    va_end(arguments);                             \
    return opened(folder, path, flags, mode)
int open(const char* path, int flags, ...) { RETURN_OPENED(AT_FDCWD); }
int open64(const char* path, int flags, ...) { RETURN_OPENED(AT_FDCWD); }
int openat(int folder, const char* path, int flags, ...) { RETURN_OPENED(folder); }
int openat64(int folder, const char* path, int flags, ...) { RETURN_OPENED(folder); }
FILE* fopen(const char* path, const char* mode) {
    if (fails_with_errno(Kind::open)) return nullptr;
    static const auto real = next<FILE* (*)(const char*, const char*)>("fopen");
    return real(path, mode);
}
FILE* fopen64(const char* path, const char* mode) {
    if (fails_with_errno(Kind::open)) return nullptr;
    static const auto real = next<FILE* (*)(const char*, const char*)>("fopen64");
    return real(path, mode);
}

// --- rename, and whatever else changes names ---
int rename(const char* from, const char* to) {
    return fails_with_errno(Kind::rename) ? -1 : int(syscall(SYS_rename, from, to));
}
int renameat(int from_folder, const char* from, int to_folder, const char* to) {
    if (fails_with_errno(Kind::rename)) return -1;
    return int(syscall(SYS_renameat2, from_folder, from, to_folder, to, 0));
}
int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) {
    if (fails_with_errno(Kind::rename)) return -1;
    return int(syscall(SYS_renameat2, from_folder, from, to_folder, to, flags));
}
int link(const char* from, const char* to) {
    return fails_with_errno(Kind::rename) ? -1 : int(syscall(SYS_link, from, to));
}
int unlink(const char* path) { return fails_with_errno(Kind::rename) ? -1 : int(syscall(SYS_unlink, path)); }
int mkdir(const char* path, mode_t mode) {
    return fails_with_errno(Kind::rename) ? -1 : int(syscall(SYS_mkdir, path, mode));
}

// --- sync ---
int fsync(int file) { return fails_with_errno(Kind::sync) ? -1 : int(syscall(SYS_fsync, file)); }
int fdatasync(int file) { return fails_with_errno(Kind::sync) ? -1 : int(syscall(SYS_fdatasync, file)); }
int sync_file_range(int file, off64_t offset, off64_t size, unsigned flags) {
    if (fails_with_errno(Kind::sync)) return -1;
    return int(syscall(SYS_sync_file_range, file, offset, size, flags));
}

// --- map ---
void* mmap(void* start, size_t size, int protection, int flags, int file, off_t offset) {
    if (fails_with_errno(Kind::map)) return MAP_FAILED;
    return reinterpret_cast<void*>(syscall(SYS_mmap, start, size, protection, flags, file, offset));
}
void* mmap64(void* start, size_t size, int protection, int flags, int file, off64_t offset) {
    return mmap(start, size, protection, flags, file, offset);
}

// --- allocate; operator new comes here too ---
void* malloc(size_t size) { return allocated(size, 0, __builtin_return_address(0)); }
void* calloc(size_t count, size_t size) {
    if (!is_excepted(__builtin_return_address(0)) && fails_with_errno(Kind::allocate)) return nullptr;
    return __libc_calloc(count, size);
}
void* realloc(void* memory, size_t size) {
    if (!is_excepted(__builtin_return_address(0)) && fails_with_errno(Kind::allocate)) return nullptr;
    return __libc_realloc(memory, size);
}
void* memalign(size_t alignment, size_t size) {
    return allocated(size, alignment, __builtin_return_address(0));
}
void* aligned_alloc(size_t alignment, size_t size) {
    return allocated(size, alignment, __builtin_return_address(0));
}
int posix_memalign(void** memory, size_t alignment, size_t size) {
    *memory = allocated(size, alignment, __builtin_return_address(0));
    return *memory ? 0 : ENOMEM;
}

// --- thread ---
int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*body)(void*),
                   void* argument) {
    if (fails(Kind::thread)) return failure;
    static const auto real =
        next<int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*)>("pthread_create");
    return real(thread, attributes, body, argument);
}
}
