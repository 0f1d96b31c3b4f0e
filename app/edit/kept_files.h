// Files kept of a scene besides its own. Unsaved edits survive a crash: a copy of the scene in the
// person's state folder, NAME-PID-HASH.toml, that any astrosplat can load, and the way back from it.
// Snapshots are named looks to compare with and to go back to: each is a scene file in the folder
// SCENE.snapshots with a small image beside it. The first line of both says what they are of. Files appear
// complete or not at all.
#pragma once

#include <chrono>

#include "core/atomic_file.h"
#include "edit/document.h"
#include "edit/settings.h"
#include "scene/scene.h"

namespace astrosplat {

/// state_folder()/autosave; empty without a home.
fs::path autosave_folder();

/// As the settings say; $ASTROSPLAT_AUTOSAVE_SECONDS, 1 to 3600, where it says otherwise (for tests).
std::chrono::seconds autosave_interval(const Settings& settings = {});

/// Owns the autosave of one window. A folder that cannot be written costs one warning, nothing else.
class Autosave {
  public:
    using Clock = std::chrono::steady_clock;
    explicit Autosave(fs::path folder = autosave_folder(), Clock::duration every = autosave_interval());
    /// Removes the file: the window was closed in peace. While an exception ends the program it stays.
    ~Autosave();
    Autosave(const Autosave&) = delete;
    Autosave& operator=(const Autosave&) = delete;

    /// To be called often; cheap. Writes `every` (a minute) after the first edit that is not in the
    /// file, and removes the file when there is nothing left to save.
    void update(const Document& document, Clock::time_point now = Clock::now());
    /// Writes at once. False where it cannot.
    bool write(const Document& document);
    void remove();
    /// Empty while there is none.
    const fs::path& file() const { return file_; }

  private:
    fs::path folder_, file_;
    Clock::duration every_;
    std::unique_ptr<FileLock> lock_;  // says to others that this process lives
    std::uint64_t written_ = 0;       // revision in the file
    Clock::time_point changed_{};     // first update() that saw a newer one
    bool waiting_ = false;
};

/// An autosave whose process is gone.
struct Recovery {
    fs::path autosave;
    fs::path original;  // the scene's file, or where an untitled one was
    bool titled = true;
    std::string time;  // UTC, "2026-05-01 12:30:00"

    std::string name() const;  // "whirlpool.toml", "m51 (never saved)"
};

/// Newest first. Never throws: a folder that cannot be read holds none.
std::vector<Recovery> recoveries(const fs::path& folder = autosave_folder());
/// The document as it was; it is edited(), saving writes the original. The autosave stays until
/// discard_recovery(): write a new one (Autosave::write) first. Throws InputError.
Document recover(const fs::path& autosave);
void discard_recovery(const fs::path& autosave);

/// Data of a snapshot besides its scene.
struct SnapshotFacts {
    std::string name;
    double frame = 1.0;
    std::int64_t splats = 0;
    double seconds = 0.0;  // render time; 0: from the preview
    bool operator==(const SnapshotFacts&) const = default;
};

/// Everything as it was when it was taken.
struct StoredLook : SnapshotFacts {
    std::shared_ptr<const Scene> scene;
    fs::path file{};  // empty: not kept
};

StoredLook store_look(const SnapshotFacts& facts, const Document& document);

/// `scene` with the look of `stored`: look, render and visibility of the layers that both have by name, the
/// output's exposure, and the animation of all these. Camera, sources, transforms and layers that `stored`
/// lacks stay.
Scene with_look_of(const Scene& scene, const Scene& stored);

/// with_look_of as one undo step. Throws InputError as Document::edit does.
void restore_look(Document& document, const StoredLook& stored);

/// "galaxy.snapshots" beside galaxy.toml.
fs::path snapshot_folder(const fs::path& scene_file);
/// The image beside a snapshot's file.
fs::path snapshot_image(const fs::path& snapshot);

/// Oldest first; none where there is no folder. Each one that cannot be read is left out, and a line about it
/// added to `problems`.
std::vector<StoredLook> read_snapshots(const fs::path& folder, std::vector<std::string>& problems);

/// Writes the scene with all its values, presets dissolved, and `png`, under the next free number; creates
/// the folder. Returns the file. Throws OutputError.
fs::path write_snapshot(const fs::path& folder, const SnapshotFacts& facts, const Scene& scene,
                        const std::string& png);
/// Another name; all else stays. Throws InputError, OutputError.
void rename_snapshot(const fs::path& snapshot, const std::string& name);
/// Both files. Throws OutputError.
void remove_snapshot(const fs::path& snapshot);

}  // namespace astrosplat
