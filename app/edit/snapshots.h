// Snapshots: named looks to compare with and to go back to. Each is a scene file in the folder
// SCENE.snapshots, whose first line holds its name and facts, with a small picture beside it. In: the
// document, or the folder. Out: scenes with another look, and files that appear complete or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "edit/document.h"
#include "scene/scene.h"

namespace astrosplat {

/// Everything as it was when it was taken.
struct StoredLook {
    std::string name;
    std::shared_ptr<const Scene> scene;
    double frame = 1.0;
};

StoredLook store_look(const std::string& name, const Document& document, double frame);

/// `scene` with the look of `stored`: look, render and visibility of the layers that both have by name, the
/// output's exposure, and the animation of all these. Camera, sources, transforms and layers that `stored`
/// lacks stay.
Scene with_look_of(const Scene& scene, const Scene& stored);

/// with_look_of as one undo step. Throws InputError as Document::edit does.
void restore_look(Document& document, const StoredLook& stored);

/// Data of a snapshot besides its scene.
struct SnapshotFacts {
    std::string name;
    double frame = 1.0;
    std::int64_t splats = 0;
    double seconds = 0.0;  // render time; 0: from the preview
    bool operator==(const SnapshotFacts&) const = default;
};

struct KeptSnapshot {
    std::filesystem::path file;
    SnapshotFacts facts;
    Scene scene;
};

/// "galaxy.snapshots" beside galaxy.toml.
std::filesystem::path snapshot_folder(const std::filesystem::path& scene_file);
/// The picture beside a snapshot's file.
std::filesystem::path snapshot_picture(const std::filesystem::path& snapshot);

/// Oldest first; none where there is no folder. Each one that cannot be read is left out, and a line about it
/// added to `problems`.
std::vector<KeptSnapshot> read_snapshots(const std::filesystem::path& folder,
                                         std::vector<std::string>& problems);

/// Writes the scene with all its values, presets dissolved, and `png`, under the next free number; creates
/// the folder. Returns the file. Throws OutputError.
std::filesystem::path write_snapshot(const std::filesystem::path& folder, const SnapshotFacts& facts,
                                     const Scene& scene, const std::string& png);
/// Another name; all else stays. Throws InputError, OutputError.
void rename_snapshot(const std::filesystem::path& snapshot, const std::string& name);
/// Both files. Throws OutputError.
void remove_snapshot(const std::filesystem::path& snapshot);

}  // namespace astrosplat
