// Snapshots kept beside their scene, in the folder SCENE.snapshots: for each a scene of its own, whose first
// line says its name and facts, and a small picture. In: a stored scene, or the folder. Out: files that
// appear complete or not at all, or what they hold.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace astrosplat {

/// What a snapshot says of itself besides its scene.
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
