// POSIX calls, because the C and C++ streams would wait for a writer at the end of a pipe.
#include "core/file.h"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <set>
#include <system_error>

#include "core/error.h"
#include "core/memory.h"

namespace astrosplat {
namespace {

[[noreturn]] void cannot_read(const fs::path& file, std::string_view reason) {
    throw InputError(fmt::format("{}: cannot be read: {}", file.string(), reason));
}

// A relative folder in a variable does not count, as the XDG specification says.
fs::path folder_in(const char* variable, const char* below_home) {
    const char* base = std::getenv(variable);
    if (base && fs::path(base).is_absolute()) return fs::path(base) / "astrosplat";
    const char* home = std::getenv("HOME");
    if (!home || !fs::path(home).is_absolute()) return {};
    return fs::path(home) / below_home / "astrosplat";
}

}  // namespace

InputFile::InputFile(const fs::path& file) : file_(file) {
    // The status comes first, because opening a device may do something.
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) cannot_read(file, std::strerror(errno));
    if (S_ISDIR(status.st_mode)) cannot_read(file, "it is a folder");
    if (!S_ISREG(status.st_mode)) cannot_read(file, "it is not a regular file");
    descriptor_ = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor_ < 0) cannot_read(file, std::strerror(errno));
    if (::fstat(descriptor_, &status) == 0) size_ = status.st_size;
}

InputFile::~InputFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

std::size_t InputFile::read(char* out, std::size_t size) {
    for (;;) {
        const ssize_t got = ::read(descriptor_, out, size);
        if (got >= 0) return std::size_t(got);
        if (errno != EINTR) cannot_read(file_, std::strerror(errno));
    }
}

void require_readable(const fs::path& file) { const InputFile opened(file); }

std::string read_file(const fs::path& file, const Progress& progress) {
    InputFile in(file);
    claim_memory(in.size(), fmt::format("reading {}", file.string()));
    constexpr std::size_t block = std::size_t{1} << 22;
    std::string text;
    text.reserve(std::size_t(in.size()) + 1);  // the last read finds the end
    for (std::size_t got = 1; got > 0;) {
        progress.check();
        const std::size_t have = text.size();
        text.resize(have + std::max<std::size_t>(1, std::min(block, text.capacity() - have)));
        got = in.read(text.data() + have, text.size() - have);
        text.resize(have + got);
    }
    return text;
}

std::vector<fs::path> entries_of(const fs::path& folder) {
    std::vector<fs::path> entries;
    const std::unique_ptr<DIR, int (*)(DIR*)> open(::opendir(folder.c_str()), ::closedir);
    if (!open) return entries;
    while (const dirent* entry = ::readdir(open.get())) {
        const std::string_view name = entry->d_name;
        if (name != "." && name != "..") entries.push_back(folder / name);
    }
    std::ranges::sort(entries);
    return entries;
}

FileStamp stamp_of(const fs::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return {};
    return {status.st_mtim.tv_sec, status.st_mtim.tv_nsec, status.st_size, status.st_dev, status.st_ino};
}

std::string read_beginning(const fs::path& file, std::size_t size) {
    std::string text(size, '\0');
    std::size_t have = 0;
    try {
        InputFile in(file);
        for (std::size_t got = 1; got > 0; have += got) got = in.read(text.data() + have, size - have);
    } catch (const InputError&) {
        have = 0;
    }
    text.resize(have);
    return text;
}

fs::path state_folder() { return folder_in("XDG_STATE_HOME", ".local/state"); }
fs::path config_folder() { return folder_in("XDG_CONFIG_HOME", ".config"); }
fs::path data_folder() { return folder_in("XDG_DATA_HOME", ".local/share"); }
fs::path cache_folder() { return folder_in("XDG_CACHE_HOME", ".cache"); }

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw OutputError(folder.string() + ": cannot create this folder: " + error.message());
}

fs::path assets_folder(const std::string& name) {
    std::error_code ignored;
    const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
    for (const fs::path& assets :
         {program.parent_path().parent_path() / "share/astrosplat/assets", fs::path(ASTROSPLAT_ASSETS)})
        if (fs::is_directory(assets / name, ignored)) return assets / name;
    return {};
}

fs::path own_assets_folder(const std::string& name) {
    const fs::path folder = data_folder();
    return folder.empty() ? folder : folder / name;
}

fs::path find_by_name(const std::string& folder, const fs::path& wanted) {
    std::error_code ignored;
    if (wanted.filename().empty() || wanted.has_extension() || fs::exists(wanted, ignored)) return wanted;
    const fs::path file = wanted.filename().string() + ".toml";
    for (const fs::path& place : {wanted.parent_path(), own_assets_folder(folder), assets_folder(folder)})
        if (fs::is_regular_file(place / file, ignored)) return place / file;
    return wanted;
}

std::vector<std::string> names_in(const std::string& folder) {
    std::set<std::string> names;
    for (const fs::path& place : {own_assets_folder(folder), assets_folder(folder)})
        for (const fs::path& entry : entries_of(place))
            if (entry.extension() == ".toml") names.insert(entry.stem().string());
    return {names.begin(), names.end()};
}

fs::path make_temporary_folder() {
    std::error_code error;
    const fs::path place = fs::temp_directory_path(error);
    if (error) throw OutputError(fmt::format("no folder for temporary files: {}", error.message()));
    std::string pattern = (place / "astrosplat-XXXXXX").string();
    if (!mkdtemp(pattern.data()))
        throw OutputError(
            fmt::format("{}: no folder can be made there: {}", place.string(), std::strerror(errno)));
    return pattern;
}

TemporaryFolder::TemporaryFolder() : path_(make_temporary_folder()) {}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

}  // namespace astrosplat
