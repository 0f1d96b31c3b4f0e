// Layers are matched by name, tracks by their key.
#include "edit/snapshots.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/file.h"
#include "core/text.h"
#include "edit/keyframes.h"
#include "edit/layers.h"
#include "scene/load.h"
#include "scene/save.h"

namespace astrosplat {
namespace fs = std::filesystem;

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SnapshotFacts, name, frame, splats, seconds)

namespace {

/// Whether a key is part of the look of a layer that both scenes have.
bool is_of_look(const ParameterKey& key, const Scene& scene, const Scene& stored) {
    if (key == "output.exposure") return true;
    const std::string name = key.layer();
    const ParameterKey layer = layer_key(name);
    const bool look =
        key.is_below(layer / "look") || key.is_below(layer / "render") || key == layer / "visible";
    return look && find_layer(scene, name) && find_layer(stored, name);
}

}  // namespace

StoredLook store_look(const std::string& name, const Document& document, double frame) {
    return {name, std::make_shared<const Scene>(document.scene()), frame};
}

Scene with_look_of(const Scene& scene, const Scene& stored) {
    Scene result = scene;
    result.output.exposure = stored.output.exposure;
    for (LayerParams& layer : result.layers) {
        const LayerParams* old = find_layer(stored, layer.name);
        if (!old) continue;
        layer.look = old->look;
        layer.render = old->render;
        layer.visible = old->visible;
    }
    // A track that both have keeps its place in the list, so that going back and forth changes nothing else.
    result.animation.clear();
    for (const Track& track : scene.animation) {
        const Track* const old = find_track(stored, track.key);
        if (!is_of_look(track.key, scene, stored))
            result.animation.push_back(track);
        else if (old)
            result.animation.push_back(*old);
    }
    for (const Track& track : stored.animation)
        if (is_of_look(track.key, scene, stored) && !find_track(scene, track.key))
            result.animation.push_back(track);
    return result;
}

void restore_look(Document& document, const StoredLook& stored) {
    document.edit("Restore " + stored.name,
                  [&](Scene& scene) { scene = with_look_of(scene, *stored.scene); });
}

namespace {

constexpr std::string_view head_of_facts = "# astrosplat snapshot ";

std::string facts_line(const SnapshotFacts& facts) {
    return std::string(head_of_facts) +
           nlohmann::json(facts).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

/// Throws InputError where the text begins with something else.
SnapshotFacts facts_of(const std::string& text, const fs::path& file) {
    const std::string_view line = std::string_view(text).substr(0, text.find('\n'));
    try {
        if (line.starts_with(head_of_facts)) return nlohmann::json::parse(line.substr(head_of_facts.size()));
    } catch (const nlohmann::json::exception&) {
        // The line below says it.
    }
    bad_input(file.string(), "1", "a snapshot", "another file");
}

KeptSnapshot read_snapshot(const fs::path& file) {
    const std::string text = read_file(file);
    return {file, facts_of(text, file), parse_scene(text, file)};
}

/// Of "0012.toml" 12; 0 for other names.
std::int64_t number_of_file(const fs::path& file) {
    if (file.extension() != ".toml") return 0;
    return parse_int64(file.stem().string()).value_or(0);
}

std::vector<fs::path> numbered_files(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const fs::path& entry : entries_of(folder))
        if (number_of_file(entry) > 0) files.push_back(entry);
    std::ranges::sort(files, {}, number_of_file);
    return files;
}

}  // namespace

fs::path snapshot_folder(const fs::path& scene_file) {
    return fs::path(scene_file).replace_extension(".snapshots");
}

fs::path snapshot_picture(const fs::path& snapshot) { return fs::path(snapshot).replace_extension(".png"); }

std::vector<KeptSnapshot> read_snapshots(const fs::path& folder, std::vector<std::string>& problems) {
    std::vector<KeptSnapshot> found;
    for (const fs::path& file : numbered_files(folder)) {
        try {
            found.push_back(read_snapshot(file));
        } catch (const InputError& error) {
            problems.push_back(error.what());
        }
    }
    return found;
}

fs::path write_snapshot(const fs::path& folder, const SnapshotFacts& facts, const Scene& scene,
                        const std::string& png) {
    make_folder(folder);
    const std::vector<fs::path> files = numbered_files(folder);
    Scene whole = scene;
    for (LayerParams& layer : whole.layers) layer.preset.clear();
    for (std::int64_t number = files.empty() ? 1 : number_of_file(files.back()) + 1;; ++number) {
        const fs::path file = folder / fmt::format("{:04}.toml", number);
        try {
            write_file_atomically(file, facts_line(facts) + save_text(whole, "", file), Existing::keep);
        } catch (const AlreadyExists&) {
            continue;  // another window took the number
        }
        write_file_atomically(snapshot_picture(file), png);
        return file;
    }
}

void rename_snapshot(const fs::path& snapshot, const std::string& name) {
    const std::string text = read_file(snapshot);
    SnapshotFacts facts = facts_of(text, snapshot);
    facts.name = name;
    write_file_atomically(snapshot,
                          facts_line(facts) + text.substr(std::min(text.find('\n'), text.size() - 1) + 1));
}

void remove_snapshot(const fs::path& snapshot) {
    for (const fs::path& file : {snapshot, snapshot_picture(snapshot)}) {
        std::error_code error;
        fs::remove(file, error);
        if (error)
            throw OutputError(fmt::format("{}: cannot be removed: {}", file.string(), error.message()));
    }
}

}  // namespace astrosplat
