#include "volumes/openvdb_file.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <system_error>

#include "core/hash.h"

namespace astrosplat {
namespace {

constexpr const char* module_name = "astrosplat-openvdb.so";

/// Next to the program where it was built, else where it is installed.
OpenvdbBytes* load_module() {
    std::error_code ignored;
    const fs::path program = fs::read_symlink("/proc/self/exe", ignored).parent_path();
    fs::path file = program / module_name;
    if (!fs::exists(file, ignored)) file = program.parent_path() / "lib/astrosplat" / module_name;
    void* const module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    void* const entry = module ? dlsym(module, openvdb_entry) : nullptr;
    if (!entry) throw InputError(fmt::format("OpenVDB cannot be loaded: {}", dlerror()));
    return reinterpret_cast<OpenvdbBytes*>(entry);
}

/// The file begins with a magic number of 8 bytes, three of 4 bytes and one of 1; then comes the tag, as
/// 8-4-4-4-12 hexadecimal digits.
void make_tag(std::string& bytes) {
    constexpr std::size_t begin = 21, size = 36;
    assert(bytes.size() > begin + size && bytes[begin + 8] == '-' && bytes[begin + 23] == '-');
    bytes.replace(begin, size, size, '-');
    const std::string hash = Sha256().add(bytes).hex();
    for (std::size_t i = 0, digit = 0; i < size; ++i)
        if (i != 8 && i != 13 && i != 18 && i != 23) bytes[begin + i] = hash[digit++];
}

}  // namespace

void write_openvdb(const WriteTarget& target, const VoxelGrid& grid, const VolumeWords& words,
                   const Progress& progress) {
    OpenvdbBytes* const bytes_of = load_module();
    progress.check();
    std::string bytes;
    if (!bytes_of(grid, words, bytes))
        throw OutputError(fmt::format("{}: OpenVDB says: {}", target.file.string(), bytes));
    make_tag(bytes);
    progress.check();
    AtomicFile file(target.file, target.existing);
    file.write(bytes);
    file.commit();
}

}  // namespace astrosplat
