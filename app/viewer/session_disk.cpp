// Session: what others wrote on the disk while the scene is open. Of the scene itself the window tells, and
// asks; the files it is made of are read again.
#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/memory.h"
#include "scene/input_files.h"
#include "viewer/session_impl.h"

namespace astrosplat {
namespace fs = std::filesystem;

/// Of a layer's source: what the scene names, and what was found in there.
std::vector<fs::path> Session::Impl::files_of(const LayerParams& layer) const {
    std::vector<fs::path> paths = named_files(layer.source);
    if (const auto loaded = loader.layer(layer.name))
        paths.insert(paths.end(), loaded->files.begin(), loaded->files.end());
    return paths;
}

void Session::Impl::watch_files() {
    std::vector<fs::path> paths = picture_files(document.scene());
    for (const LayerParams& layer : document.scene().layers) {
        const std::vector<fs::path> more = files_of(layer);
        paths.insert(paths.end(), more.begin(), more.end());
    }
    if (!reference_file.empty()) paths.push_back(reference_file);
    watched.watch(paths);
}

/// Textures, meshes, maps, skies, a reference: what was changed shows without being asked for.
void Session::Impl::read_again(const std::vector<fs::path>& paths) {
    const auto is_changed = [&](const fs::path& file) {
        return std::find(paths.begin(), paths.end(), file) != paths.end();
    };
    for (const LayerParams& layer : document.scene().layers) {
        const std::vector<fs::path> its = files_of(layer);
        if (std::any_of(its.begin(), its.end(), is_changed)) loader.outdate(layer.name);
    }
    loader.want(document.scene());
    forget(*files, paths);
    ++files_read_again;
    say(paths.size() == 1 ? "Read again: " + paths[0].filename().string()
                          : fmt::format("Read again: {} files", paths.size()));
    if (!is_changed(reference_file)) return;
    reference_file.clear();
    try {
        load_reference();
    } catch (const InputError& error) {
        say(error.what(), true);
    }
}

void Session::Impl::look_at_disk(double now) {
    constexpr double every_s = 1.0;
    if (now - checked_disk_at < every_s) return;
    checked_disk_at = now;
    status.changed_on_disk = document.changed_on_disk();
    status.memory_bytes = resident_memory_bytes();
    watch_files();
    const std::vector<fs::path> changed = watched.changed();
    if (!changed.empty()) read_again(changed);
}

}  // namespace astrosplat
