// The snapshots of the open scene: looks with a thumbnail each, kept beside the scene as soon as they are
// taken. In: looks, the scene's file. Out: cards for the widgets.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "edit/snapshot_files.h"
#include "edit/snapshots.h"
#include "edit/status.h"
#include "gl/image_texture.h"

namespace astrosplat {

class SnapshotList {
  public:
    /// Those kept beside this scene in place of all there are; none of a scene without a file. What cannot be
    /// read becomes a line of `problems`.
    void open(const std::filesystem::path& scene_file, std::vector<std::string>& problems);
    /// The scene lies there from now on, and so do its snapshots. Throws OutputError; they stay in the list.
    void move_to(const std::filesystem::path& scene_file);

    /// Adds a look with its picture, RGBA of display values, top row first. Throws OutputError where it
    /// cannot be kept; it stays in the list.
    void add(StoredLook look, Image picture, std::int64_t splats, double seconds);
    /// Throw InputError and OutputError; the list is then as before.
    void rename(std::size_t index, const std::string& name);
    void remove(std::size_t index);

    std::size_t size() const { return snapshots_.size(); }
    const StoredLook& look(std::size_t index) const { return snapshots_[index].look; }
    /// "Look 3", which none has yet.
    std::string next_name() const;
    std::vector<Snapshot> cards() const;

  private:
    struct StoredView {
        StoredLook look;
        Image picture;
        ImageTexture thumbnail;
        std::int64_t splats = 0;
        double seconds = 0.0;
        std::filesystem::path file;  // empty: not kept
    };
    void keep(StoredView& view) const;

    std::vector<StoredView> snapshots_;
    std::filesystem::path folder_;  // empty: the scene has no file yet
};

/// A texture as the widgets name it.
inline void* to_handle(unsigned texture) {
    return reinterpret_cast<void*>(static_cast<std::uintptr_t>(texture));
}

}  // namespace astrosplat
