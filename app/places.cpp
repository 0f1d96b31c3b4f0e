#include "places.h"

#include "core/atomic_file.h"
#include "core/error.h"

namespace astrosplat {
namespace fs = std::filesystem;

void prove_writable(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw OutputError(folder.string() + ": cannot create this folder: " + error.message());
    const AtomicFile probe(folder / "astrosplat-probe");  // never committed: its destructor removes it
}

fs::path folder_of(const fs::path& file) { return fs::absolute(file).parent_path(); }

void refuse_to_overwrite(const fs::path& file, bool overwrite) {
    std::error_code ignored;
    if (overwrite || !fs::exists(fs::symlink_status(file, ignored))) return;
    throw InputError(file.string() + ": exists already; --overwrite replaces it");
}

}  // namespace astrosplat
