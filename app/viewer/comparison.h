// What the frame, A, is compared with: the look of a snapshot seen by the same camera, or a reference
// picture. In: the looks to keep, the file to read, requests for B's frame. Out: what the display shows
// beside A.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "edit/status.h"
#include "gl/display.h"
#include "viewer/reference_picture.h"
#include "viewer/snapshot_list.h"
#include "viewer/view_frame.h"

namespace astrosplat {

/// An 8-bit picture (RGBA, top row first) as a float one of at most `most` px width, by averaging boxes.
Image thumbnail_of(const std::vector<unsigned char>& rgba, int width, int height, int most);

class Comparison {
  public:
    explicit Comparison(std::shared_ptr<PictureFiles> files) : b_(std::move(files)) {}

    SnapshotList& snapshots() { return snapshots_; }
    const SnapshotList& snapshots() const { return snapshots_; }
    /// Those of another scene; what cannot be read becomes a line of `problems`.
    void open_snapshots(const std::filesystem::path& scene_file, std::vector<std::string>& problems);
    /// Throws as SnapshotList::remove() does.
    void delete_snapshot(std::size_t index);
    /// Makes a snapshot B; numbers that there are not change nothing.
    void set_b(std::size_t index);

    /// Chooses the reference of the view, reads its picture in the background, and says in `status` which it
    /// is. Call it every frame.
    void find_reference(const Scene& scene, const ViewState& view, Status& status);
    ReferencePicture& reference() { return reference_; }
    const ReferencePicture& reference() const { return reference_; }

    /// How what is compared with is made: B's request for any scene as A's is made, how it is drawn; and the
    /// frame that the reference lies over, px of the display.
    struct ViewOfB {
        std::function<ViewRequest(const Scene&)> request_for;
        PreviewChoice choice;
        bool may_settle = false;
        double now = 0.0;  // seconds
        FrameOnScreen frame;
    };
    /// Puts B or the reference beside A in `shown`, as `view` compares them.
    void show(const Scene& scene, const ViewState& view, const ViewOfB& how, DisplaySettings& shown);
    /// Of blinking: the other is shown now, not A.
    bool blink_shows_other() const { return blink_shows_other_; }

    /// B's frame is on its way.
    bool waiting() const { return comparing_ && b_.waiting(); }
    /// B's status while it is refined; else null.
    const ViewFrameStatus* refining() const;
    /// Grows whenever the pixels of B or the reference change.
    std::uint64_t version() const { return b_.version() + reference_.version(); }
    void fill(Status& status) const;

  private:
    ViewFrame b_;
    SnapshotList snapshots_;
    int b_snapshot_ = -1;
    bool comparing_ = false;  // the last show() showed more than A
    bool blink_shows_other_ = false;
    ReferencePicture reference_;
};

}  // namespace astrosplat
